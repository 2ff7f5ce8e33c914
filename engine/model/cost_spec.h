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

  friend bool operator==(const CostSpec&, const CostSpec&) = default;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_COST_SPEC_H_
