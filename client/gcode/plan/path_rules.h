// How each path of a layer may be printed, and which pairs of paths keep their order.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_PATH_RULES_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_PATH_RULES_H_

#include <cstddef>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/plan/layer_freedom.h"
#include "client/gcode/plan/policy.h"

namespace traverse::gcode {

// The paths of one layer, by their index in the layer.
class PathRules {
 public:
  // `file` and `outlines`, which belong to the paths of `layer`, outlive the rules.
  PathRules(const GcodeFile& file, const Layer& layer, Policy policy, const Allowance& allow,
            const std::vector<Outline>& outlines);

  PathRule RuleOf(size_t path) const;

  // True if paths `i` and `j`, which touch, keep their sliced order.
  bool KeepsOrder(size_t i, size_t j) const;

 private:
  Feature FeatureOf(size_t path) const { return outlines_[path].feature; }
  const Block& BlockOf(size_t path) const { return file_.blocks[first_block_ + path]; }
  bool IsPinned(size_t path) const;
  bool MayBeginAnywhere(size_t path) const;
  bool MayTurnRound(size_t path) const;
  bool OrderIsQuality(Feature feature) const;
  bool HasFullCircle(size_t path) const;
  bool Rises(size_t path) const;

  const GcodeFile& file_;
  const size_t first_block_;
  const Policy policy_;
  const Allowance allow_;
  const std::vector<Outline>& outlines_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_PATH_RULES_H_
