// The walls of a layer and what the API says about its moves.

#ifndef TRAVERSE_SERVER_TRANSLATE_TRANSLATE_WALLS_H_
#define TRAVERSE_SERVER_TRANSLATE_TRANSLATE_WALLS_H_

#include "absl/status/status.h"
#include "engine/base/budget.h"
#include "engine/engine.h"
#include "server/translate/field_path.h"
#include "traverse/v1/plan.pb.h"

namespace traverse {

// Sets `layer.walls`; `layer.plan` is set. InvalidArgument says where.
absl::Status SetWalls(const v1::Layer& message, const FieldPath& place, Budget* budget,
                      JobLayer& layer);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_TRANSLATE_TRANSLATE_WALLS_H_
