// What travel costs in a file, learnt from the travel that is in it.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_

#include <cstdint>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/plan/travel_rules.h"

namespace traverse::gcode {

// The travel of one layer.
struct TravelModel {
  double speed_mm_s = 150;
  double accel_mm_s2 = 1250;
  double retraction_seconds = 0;       // pulling back, lifting, wiping, coming down, priming
  double retraction_threshold_mm = 0;  // moves longer than this are retracted
};

// [layer]. Speed and acceleration are those at which most of the layer's travel is done, the time
// is the mean over its retractions of what they add to the travel; a layer without such moves has
// what the one before has. Retractions at marks, where tools may be changed, count only until there
// are others. O(length of all links).
std::vector<TravelModel> LearnTravel(const GcodeFile& file, double threshold_mm);

// What the travel in the link before block `block` takes as it is in the file, from standstill to
// standstill at the speed and the acceleration of `model`: with its bends, at each of which the
// machine slows down, and without retraction, lift and wipe; nor with a short move inwards, with
// which other ways from that path begin too, but under CuraEngine, whose bends may lie as near.
// REQUIRES: there is a block before it.
double WaySeconds(const GcodeFile& file, uint32_t block, const TravelModel& model);

// The same of a new way from the path `before`.
double NewWaySeconds(const GcodeFile& file, uint32_t before, const TravelWay& way,
                     const TravelModel& model);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_
