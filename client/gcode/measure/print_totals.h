// The totals of a print, or of one of its layers.

#ifndef TRAVERSE_CLIENT_GCODE_MEASURE_PRINT_TOTALS_H_
#define TRAVERSE_CLIENT_GCODE_MEASURE_PRINT_TOTALS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace traverse::gcode {

struct PrintTotals {
  double extruded_mm = 0;      // length in XY with deposition
  double travel_mm = 0;        // length in XY without deposition, wipes included
  int64_t retractions = 0;     // retractions; those by wipes count once
  int64_t crossings = 0;       // travel moves between paths that cross a visible wall
  int64_t open_crossings = 0;  // of them, those without a retraction
  double longest_open_mm =
      0;                // the longest of these, with all moves of the travel from path to path
  int64_t blocked = 0;  // moves where something that stands is in the way
  double extra_mm = 0;  // filament pushed at a standstill beyond what was retracted, or short of it
  double seconds = 0;   // see motion_planner.h for the model
  double nominal_seconds = 0;  // if every move is as fast as it states; dwells included

  // Primes push more, or less, than was retracted, beyond what rounding does: then the number of
  // retractions is a part of what is printed.
  bool PushesExtra() const { return std::abs(extra_mm) > kLeastExtraMm; }
  static constexpr double kLeastExtraMm = 1e-6;

  PrintTotals& operator+=(const PrintTotals& other) {
    extruded_mm += other.extruded_mm;
    travel_mm += other.travel_mm;
    retractions += other.retractions;
    crossings += other.crossings;
    open_crossings += other.open_crossings;
    longest_open_mm = std::max(longest_open_mm, other.longest_open_mm);
    blocked += other.blocked;
    extra_mm += other.extra_mm;
    seconds += other.seconds;
    nominal_seconds += other.nominal_seconds;
    return *this;
  }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MEASURE_PRINT_TOTALS_H_
