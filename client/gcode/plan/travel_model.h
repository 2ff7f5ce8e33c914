// The cost of travel in a file, learned from the file's own travel.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_

#include <cstdint>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/plan/joints.h"
#include "client/gcode/plan/travel_rules.h"

namespace traverse::gcode {

// What the retraction in a link adds to its travel: ahead of it, to pull back, wipe and lift, and
// behind it, to lower and prime. 0 if there is none, or it tells nothing of others.
struct AddedSeconds {
  float leaving = 0;
  float arriving = 0;

  float sum() const { return leaving + arriving; }
};

// The travel of one layer.
struct TravelModel {
  double speed_mm_s = 150;
  double accel_mm_s2 = 1250;
  double retraction_seconds = 0;       // retracting, lifting, wiping, lowering, priming
  double retraction_price = 0;         // the same with what the stops for it cost the travel
  double retraction_threshold_mm = 0;  // longer moves retract

  // Where the head rises on its way, the longer the higher: by so much per mm. It descends by moves
  // of Z at so much, and both are 0 where no move rises so.
  double slope = 0;
  double descent_seconds_per_mm = 0;

  // [block of the layer] of the link before it; retraction_seconds is the mean of their sums.
  std::vector<AddedSeconds> added = {};
};

// [layer]. Speed and acceleration are those of most of the layer's travel. The times are the means
// that the layer's retractions add to the travel, but for a few that last far longer; a layer
// without such moves has that of the layer before. Retractions at marks, where tools may change,
// count only until there are others. O(length of all links). Uses `threads` threads.
std::vector<TravelModel> LearnTravel(const GcodeFile& file, double threshold_mm, int threads = 1);

// The time of the travel in the link before block `block`, as it is in the file, from standstill to
// standstill at the speed and acceleration of `model`: with its bends, at each of which the machine
// slows down, but without retraction, lift and wipe. Unless `with_departure` also without a short
// inward move, with which other travel from that path begins too, except for CuraEngine, whose
// bends may be as near. With `joints` not from standstill to standstill but from path to path, with
// what printing loses at both, and with a stop wherever filament is moved alone. REQUIRES: there is
// a block before it.
double TravelSeconds(const GcodeFile& file, uint32_t block, const TravelModel& model,
                     bool with_departure = false, const TravelJoints* joints = nullptr);

// The same for a new travel move from the path `before`.
double NewTravelSeconds(const GcodeFile& file, uint32_t before, const PlannedTravel& travel,
                        const TravelModel& model, const TravelJoints* joints = nullptr);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_MODEL_H_
