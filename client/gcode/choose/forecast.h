// What the travel of chosen orders costs, as the search for orders counts it.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_FORECAST_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_FORECAST_H_

namespace traverse::gcode {

// What orders are searched for and chosen by, summed up for the file's own orders and for those
// chosen: within a layer the estimates of its travel moves, one by one, each with its retraction;
// the travel moves between layers as they were measured to choose among orders, with what scripts
// do there. No layer is measured for it, so beside the time of what is written it shows how true
// the estimates are.
struct Forecast {
  double given_seconds = 0;
  double seconds = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_FORECAST_H_
