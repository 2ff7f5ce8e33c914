// Which paths of a layer may change places.
//
//   in_order                          groups: nothing crosses a fence, a label, a skirt's end, or
//    |                                (unless it is allowed, as it is under `free`, or the fan is
//    |                                stated for each path) a change of the fan
//    +- any_order(paths, before)      the paths of a group; `before` keeps the sliced order of
//    +- path                          paths that touch; pinned paths stand alone

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_LAYER_PLAN_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_LAYER_PLAN_H_

#include <cstdint>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/plan/layer_freedom.h"
#include "client/gcode/plan/policy.h"
#include "traverse/v1/plan.pb.h"

namespace traverse::gcode {

// A layer as a plan. Plan.paths[i] is the block `first_block + i`; vertex k of a contour is point k
// of its outline.
struct LayerPlan {
  v1::Plan plan;
  std::vector<Outline> outlines;  // [path]
  int64_t movable = 0;            // paths that may change places with another one
  LayerFreedom freedom;           // what the plan allows
};

// Whether the fan turns otherwise at `block` than at the block before it. REQUIRES: block > 0.
bool FanChanges(const GcodeFile& file, uint32_t block);

LayerPlan MakeLayerPlan(const GcodeFile& file, const Layer& layer, Policy policy,
                        const Allowance& allow = {});

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_LAYER_PLAN_H_
