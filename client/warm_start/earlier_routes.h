// Reads what `traverse optimize --json` wrote (report/json.h), to begin a search with.

#ifndef TRAVERSE_CLIENT_WARM_START_EARLIER_ROUTES_H_
#define TRAVERSE_CLIENT_WARM_START_EARLIER_ROUTES_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace traverse {

struct PlacedPoint {
  double x = 0;
  double y = 0;
};

// One path of an earlier route. It names the path by the labels of a file that may have been edited
// since, and by its place.
struct EarlierVisit {
  bool contour = false;
  uint64_t island = 0;  // 0 where the file has none
  uint64_t id = 0;
  uint32_t entry = 0;  // a contour's vertex; 1 for an open path that is reversed

  // Where it begins and ends, in mm. Unset: written by a version that did not state it.
  std::optional<PlacedPoint> from;
  std::optional<PlacedPoint> to;
};

struct EarlierLayer {
  uint64_t id = 0;
  std::vector<EarlierVisit> route;
};

// The layers of the document `text`. `name` is the file's. InvalidArgument `name: ...` if
// `optimize` did not write it, with what is missing and where.
absl::StatusOr<std::vector<EarlierLayer>> ReadEarlierRoutes(const std::string& text,
                                                            const std::string& name);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_WARM_START_EARLIER_ROUTES_H_
