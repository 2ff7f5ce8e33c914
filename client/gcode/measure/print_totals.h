// What a print, or a layer of one, amounts to.

#ifndef TRAVERSE_CLIENT_GCODE_MEASURE_PRINT_TOTALS_H_
#define TRAVERSE_CLIENT_GCODE_MEASURE_PRINT_TOTALS_H_

#include <algorithm>
#include <cstdint>

namespace traverse::gcode {

struct PrintTotals {
  double extruded_mm = 0;      // way in XY while depositing
  double travel_mm = 0;        // way in XY without depositing, wipes included
  int64_t retractions = 0;     // times filament is pulled back, wipes with it counted once
  int64_t crossings = 0;       // ways from path to path that lead across a visible wall
  int64_t open_crossings = 0;  // of them, those with filament not pulled back
  double longest_open_mm = 0;  // of the ways that these count
  double extra_mm = 0;         // filament pushed at a standstill beyond what was pulled back
  double seconds = 0;          // see motion_planner.h for the model

  PrintTotals& operator+=(const PrintTotals& other) {
    extruded_mm += other.extruded_mm;
    travel_mm += other.travel_mm;
    retractions += other.retractions;
    crossings += other.crossings;
    open_crossings += other.open_crossings;
    longest_open_mm = std::max(longest_open_mm, other.longest_open_mm);
    extra_mm += other.extra_mm;
    seconds += other.seconds;
    return *this;
  }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MEASURE_PRINT_TOTALS_H_
