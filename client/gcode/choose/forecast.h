// What the travel of chosen orders costs, as the search for orders counts it.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_FORECAST_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_FORECAST_H_

namespace traverse::gcode {

// The sum of the estimates by which orders are searched for and chosen, in the file's own orders
// and in those chosen: ways one by one, each with its retraction. Nothing is written for it and no
// text is measured, so beside the time of what is written it shows how true these estimates are.
struct Forecast {
  double given_seconds = 0;
  double seconds = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_FORECAST_H_
