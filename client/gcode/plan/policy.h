// What of a layer may change places.
//
//   in_order                          groups: nothing crosses a fence, a label, a skirt's end, or
//    |                                (unless it is allowed, as it is under `free`) a change of the
//    |                                fan
//    +- any_order(paths, before)      the paths of a group; `before` keeps the sliced order of
//    +- path                          paths that touch; pinned paths stand alone
//    +- any_order(islands of any_order(paths, before))      under `balanced`

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_POLICY_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_POLICY_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/gcode/model/outline.h"
#include "client/gcode/plan/layer_freedom.h"
#include "traverse/v1/plan.pb.h"

namespace traverse::gcode {

enum class Policy : uint8_t {
  kSafe,      // nothing that a slicer chose for quality changes
  kBalanced,  // also walls begin at sharp corners of their own, and islands are done one by one
  kFree,      // any start and direction; only what touches keeps the order of its features
};

// "safe", "balanced" or "free"; nothing for other text.
std::optional<Policy> PolicyOfName(std::string_view name);
std::string_view PolicyName(Policy policy);

// What a user allows beyond any policy, each by its name.
struct Allowance {
  bool infill_order = false;  // walls and the infill that touches them may change places
  bool wall_order = false;    // walls that touch one another may
  bool fan_order = false;     // paths may across a change of the fan, of pressure advance or flow

  bool operator==(const Allowance&) const = default;
};

// From names with commas between them, such as "infill_order,wall_order"; nothing for other text.
std::optional<Allowance> AllowanceOfNames(std::string_view names);

// "infill_order+wall_order"; empty if nothing is allowed.
std::string AllowanceNames(const Allowance& allow);

// What is done about visible walls in the way of travel.
enum class Crossings : uint8_t {
  kKeep,   // the file crosses them no more often than it did
  kFewer,  // and each crossing saved is worth kFewerCrossingSeconds
  kAny,    // as time says
};

// Prices of a crossing in a search. The small one is for orders that are as quick with fewer, the
// large one for a second search of what was found to cross more, so that there are orders with
// hardly any to choose from.
inline constexpr double kKeepCrossingSeconds = 0.03;
inline constexpr double kFewerCrossingSeconds = 0.5;
inline constexpr double kDearCrossingSeconds = 1;

// "keep", "fewer" or "any"; nothing for other text.
std::optional<Crossings> CrossingsOfName(std::string_view name);
std::string_view CrossingsName(Crossings crossings);

// A layer as a plan. Plan.paths[i] is the block `first_block + i`; vertex k of a contour is point k
// of its outline.
struct LayerPlan {
  v1::Plan plan;
  std::vector<Outline> outlines;  // [path]
  std::vector<uint32_t> island;   // [path] which connected region of the layer it lies in
  int64_t movable = 0;            // paths that may change places with another one
  LayerFreedom freedom;           // what the plan says
};

// Ways to look for an order among those that a policy allows. The narrower the choice, the further
// a search comes in it.
enum class Latitude : uint8_t {
  kFull,
  // The layer begins and ends with the path that it does in the file, so that nothing changes for
  // the layers around it; walls that touch and follow one another in the file stay together.
  kNarrow,
  // Begins and ends as kNarrow does, and islands are done one by one under any policy: so walls are
  // crossed no more often than need be.
  kIslands,
};

LayerPlan MakeLayerPlan(const GcodeFile& file, const Layer& layer, Policy policy,
                        Latitude latitude = Latitude::kFull, const Allowance& allow = {});

// What the plan of a layer says, without the plan.
LayerFreedom FreedomOf(const GcodeFile& file, const Layer& layer, Policy policy,
                       const Allowance& allow);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_POLICY_H_
