// What travel costs in a file, learnt from the travel that is in it.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_

#include <vector>

#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

// The travel of one layer.
struct TravelModel {
  double speed_mm_s = 150;
  double accel_mm_s2 = 1250;
  double retraction_seconds = 0;       // pulling back, lifting, wiping, coming down, priming
  double retraction_threshold_mm = 0;  // moves longer than this are retracted
};

// [layer]. Speed and acceleration are those at which most of the layer's travel is done, the time
// is the mean over its retractions; a layer without such moves has what the one before has.
// O(length of all links).
std::vector<TravelModel> LearnTravel(const GcodeFile& file, double threshold_mm);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_
