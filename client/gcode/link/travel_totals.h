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

  TravelTotals& operator+=(const TravelTotals& other) {
    seconds += other.seconds;
    mm += other.mm;
    crossings += other.crossings;
    open += other.open;
    too_long += other.too_long;
    retractions += other.retractions;
    blocked += other.blocked;
    return *this;
  }

  TravelTotals& operator-=(const TravelTotals& other) {
    seconds -= other.seconds;
    mm -= other.mm;
    crossings -= other.crossings;
    open -= other.open;
    too_long -= other.too_long;
    retractions -= other.retractions;
    blocked -= other.blocked;
    return *this;
  }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_TRAVEL_TOTALS_H_
