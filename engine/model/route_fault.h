// Why a route that a caller states is none of its plan.
//
// The validator says that a route is illegal, and which node of the tree it breaks. A caller must
// know which of the visits to change: this is the first one after which no route of the plan can go
// on.

#ifndef TRAVERSE_ENGINE_MODEL_ROUTE_FAULT_H_
#define TRAVERSE_ENGINE_MODEL_ROUTE_FAULT_H_

#include <cstddef>
#include <optional>

#include "engine/base/budget.h"
#include "engine/model/plan.h"
#include "engine/model/route.h"

namespace traverse {

// The first visit at fault.
struct RouteFault {
  enum class Kind {
    kNoPath,    // the plan has no such path
    kRepeated,  // the path was visited before
    kEntry,     // the path may not be entered there
    kTooEarly,  // path `other`, which is not yet visited, must come before it
    kMissing,   // the route ends here, but path `other` is not visited
  };
  Kind kind = Kind::kNoPath;

  // Position in the route; its size for kMissing.
  size_t visit = 0;

  // kTooEarly: one of the paths that must come before. kMissing: the first one that is missing.
  int other = 0;
};

// Nothing if `route` is a route of `plan`, that is, if ValidateRoute returns OK. Asks `budget`
// regularly, if it is not null; always finishes. O(visits + nodes + entries + pairs). REQUIRES:
// `plan` passes CheckPlan.
std::optional<RouteFault> FindRouteFault(const Plan& plan, const Route& route,
                                         Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_ROUTE_FAULT_H_
