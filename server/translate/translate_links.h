// The departures and arrivals of a layer's paths, from traverse.v1 to the engine.

#ifndef TRAVERSE_SERVER_TRANSLATE_TRANSLATE_LINKS_H_
#define TRAVERSE_SERVER_TRANSLATE_TRANSLATE_LINKS_H_

#include "absl/status/status.h"
#include "engine/base/budget.h"
#include "engine/engine.h"
#include "server/translate/field_path.h"
#include "traverse/v1/plan.pb.h"

namespace traverse {

// Sets JobLayer::links, which stays empty if no path of `message` has any. InvalidArgument says
// where, as in `layers[0].islands[1].contours[2].links.departures: 3 for a path of 4 points`;
// Unimplemented, as translate.h. Asks `budget` regularly, if it is not null.
// REQUIRES: `layer` has the plan of `message`.
absl::Status SetLinks(const v1::Layer& message, const FieldPath& place, Budget* budget,
                      JobLayer& layer);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_TRANSLATE_TRANSLATE_LINKS_H_
