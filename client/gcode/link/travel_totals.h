// Estimated totals of travel between paths, before it is written.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_TRAVEL_TOTALS_H_
#define TRAVERSE_CLIENT_GCODE_LINK_TRAVEL_TOTALS_H_

#include <cstdint>

namespace traverse::gcode {

// For the travel between two paths, or for all travel of an order.
struct TravelTotals {
  double seconds = 0;
  double mm = 0;
  int32_t crossings = 0;  // across visible walls
  int32_t open = 0;       // crossings without a retraction
  int32_t too_long = 0;   // open ones that are longer than allowed
  int32_t retractions = 0;
  int32_t blocked = 0;  // where something that stands is in the way

  // For a single move: its length if it counts as open, without what continues along a path.
  double open_mm = 0;

  TravelTotals& operator+=(const TravelTotals& other) { return Add(other, 1); }
  TravelTotals& operator-=(const TravelTotals& other) { return Add(other, -1); }

 private:
  TravelTotals& Add(const TravelTotals& other, int sign) {
    seconds += sign * other.seconds;
    mm += sign * other.mm;
    crossings += sign * other.crossings;
    open += sign * other.open;
    too_long += sign * other.too_long;
    retractions += sign * other.retractions;
    blocked += sign * other.blocked;
    return *this;
  }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_TRAVEL_TOTALS_H_
