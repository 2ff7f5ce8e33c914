// The cost of travel in a file, learned from the file's own travel.

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
  double retraction_seconds = 0;  // retracting, lifting, wiping, lowering, priming
  double retraction_price = 0;    // the same with what the stops for it cost the travel
};

// [layer]. Speed and acceleration are those of most of the layer's travel. The times are the means
// that the layer's retractions add to the travel, but for a few that last far longer; a layer
// without such moves has that of the layer before. Retractions at marks, where tools may change,
// count only until there are others. O(length of all links). Uses `threads` threads.
std::vector<TravelModel> LearnTravel(const GcodeFile& file, int threads = 1);

// The time of the travel in the link before block `block`, as it is in the file, from standstill to
// standstill at the speed and acceleration of `model`: with its bends, at each of which the machine
// slows down, but without retraction, lift and wipe; and without a short inward move, with which
// other travel from that path begins too, except for CuraEngine, whose bends may be as near.
// REQUIRES: there is a block before it.
double TravelSeconds(const GcodeFile& file, uint32_t block, const TravelModel& model);

// The same for a new travel move from the path `before`.
double NewTravelSeconds(const GcodeFile& file, uint32_t before, const PlannedTravel& travel,
                        const TravelModel& model);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_
