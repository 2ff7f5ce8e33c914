// What a travel move costs: the parameters. engine/cost/travel_cost.h computes it.

#ifndef TRAVERSE_ENGINE_MODEL_COST_SPEC_H_
#define TRAVERSE_ENGINE_MODEL_COST_SPEC_H_

namespace traverse {

struct CostSpec {
  enum class Kind {
    kLength,  // mm
    kTime,    // s
  };

  Kind kind = Kind::kLength;

  // The rest is for kTime alone.
  double speed_mm_s = 1;               // > 0
  double accel_mm_s2 = 0;              // 0: the speed is reached at once
  double retraction_seconds = 0;       // of one retraction and its unretraction
  double retraction_threshold_mm = 0;  // moves longer than this are retracted

  // Of layers with walls (model/walls.h) alone.
  double wall_retraction_threshold_mm = 0;     // the same for moves across walls, if it is less
  double exposed_retraction_threshold_mm = 0;  // the same for moves to and from exposed paths
  double lift_seconds = 0;                     // of the lift for a retracted move across walls
  double crossing_seconds = 0;                 // price of a move across walls, beyond what it takes
  double wall_slack_mm = 0.25;   // at either end of a move, in which it touches walls freely
  double wall_clearance_mm = 0;  // distance of ways led around walls; 0: none are

  friend bool operator==(const CostSpec&, const CostSpec&) = default;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_COST_SPEC_H_
