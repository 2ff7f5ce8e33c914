// What a print, or a layer of one, amounts to.

#ifndef TRAVERSE_CLIENT_GCODE_PRINT_TOTALS_H_
#define TRAVERSE_CLIENT_GCODE_PRINT_TOTALS_H_

#include <cstdint>

namespace traverse::gcode {

struct PrintTotals {
  double extruded_mm = 0;   // way in XY while depositing
  double travel_mm = 0;     // way in XY without depositing, wipes included
  int64_t retractions = 0;  // times filament is pulled back, wipes with it counted once
  double seconds = 0;       // see motion_planner.h for the model

  PrintTotals& operator+=(const PrintTotals& other) {
    extruded_mm += other.extruded_mm;
    travel_mm += other.travel_mm;
    retractions += other.retractions;
    seconds += other.seconds;
    return *this;
  }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PRINT_TOTALS_H_
