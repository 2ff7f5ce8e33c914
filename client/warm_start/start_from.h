// Lets a job begin with the routes that an earlier one found, also if its file was edited since.

#ifndef TRAVERSE_CLIENT_WARM_START_START_FROM_H_
#define TRAVERSE_CLIENT_WARM_START_START_FROM_H_

#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "client/input/input_job.h"
#include "client/warm_start/earlier_routes.h"

namespace traverse {

// What of a job is known.
struct WarmStart {
  size_t layers = 0;  // that begin with a route
  size_t paths = 0;   // of these layers
  size_t known = 0;   // those of them that the earlier route had
};

// Sets Layer.initial_route of the layers of `job` that an earlier layer fits: the one of the same
// id or, without ids, position; or another one if most of that one's paths are elsewhere. Paths are
// matched as match_paths.h says, and keep their order as far as the layer allows it. New ones come
// where they are near. The routes are legal. O(n log n).
WarmStart StartFrom(absl::Span<const EarlierLayer> earlier, InputJob& job);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_WARM_START_START_FROM_H_
