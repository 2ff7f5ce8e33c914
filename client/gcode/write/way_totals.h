// Estimated totals of travel between paths, before it is written.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_WAY_TOTALS_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_WAY_TOTALS_H_

#include <cstdint>

namespace traverse::gcode {

// For the travel between two paths, or for all travel of an order.
struct WayTotals {
  double seconds = 0;
  double mm = 0;
  int64_t crossings = 0;  // of visible walls
  int64_t open = 0;       // of these, those without a retraction
  int64_t too_long = 0;   // of these, those longer than allowed
  int64_t retractions = 0;

  // Of one way alone: how long it is if it counts as open, without what goes on along a path.
  double open_mm = 0;

  WayTotals& operator+=(const WayTotals& other) {
    seconds += other.seconds;
    mm += other.mm;
    crossings += other.crossings;
    open += other.open;
    too_long += other.too_long;
    retractions += other.retractions;
    return *this;
  }

  WayTotals& operator-=(const WayTotals& other) {
    seconds -= other.seconds;
    mm -= other.mm;
    crossings -= other.crossings;
    open -= other.open;
    too_long -= other.too_long;
    retractions -= other.retractions;
    return *this;
  }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_WAY_TOTALS_H_
