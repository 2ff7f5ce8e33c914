// The route of a layer that its caller knows, from traverse.v1 to the engine.

#ifndef TRAVERSE_SERVER_TRANSLATE_TRANSLATE_ROUTE_H_
#define TRAVERSE_SERVER_TRANSLATE_TRANSLATE_ROUTE_H_

#include "absl/status/status.h"
#include "engine/base/budget.h"
#include "engine/engine.h"
#include "server/translate/field_path.h"
#include "traverse/v1/plan.pb.h"

namespace traverse {

// Sets JobLayer::initial_route. InvalidArgument names the first visit after which the layer cannot
// be completed, and why, such as `layers[3].initial_route[4].vertex: 7 is not a vertex of a contour
// of 4`; Unimplemented, as translate.h. Asks `budget` regularly, if it is not null.
// REQUIRES: `layer` has the plan of `message`.
absl::Status SetInitialRoute(const v1::Layer& message, const FieldPath& place, Budget* budget,
                             JobLayer& layer);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_TRANSLATE_TRANSLATE_ROUTE_H_
