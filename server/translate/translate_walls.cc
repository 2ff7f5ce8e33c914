#include "server/translate/translate_walls.h"

#include <algorithm>
#include <climits>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/rest.h"
#include "engine/base/resting_sort.h"
#include "server/translate/translate.h"

namespace traverse {
namespace {

absl::StatusOr<Wall> FromProto(const v1::Wall& message, const Plan& plan, const Place& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message, place));
  TRAVERSE_RETURN_IF_ERROR(CheckCoordinates(message.points(), RangeOf("Wall.points"), place));
  Wall wall;
  wall.closed = message.closed();
  if (message.has_path()) {
    absl::StatusOr<int> path = Index(message.path(), place.text() + ".path");
    if (!path.ok()) return path.status();
    wall.path = *path;
  }
  const int points = message.points_size() / 2;
  wall.points.reserve(static_cast<size_t>(points));
  for (int i = 0; i < points; ++i) wall.points.push_back(PointAt(message.points(), i));
  if (points > 0 || wall.path < 0 || wall.path >= static_cast<int>(plan.paths.size())) return wall;
  const Path& path = plan.paths[static_cast<size_t>(wall.path)];
  if (path.kind != Path::Kind::kContour) {
    return Fault(place.text() + ".points", "none, and the path named is no contour");
  }
  wall.points = path.points;
  wall.closed = true;
  // A contour may be a point, which nothing crosses.
  if (wall.points.size() == 1) wall.points.push_back(wall.points[0]);
  return wall;
}

absl::Status SetPaths(const google::protobuf::RepeatedField<uint32_t>& named, const Place& place,
                      const char* field, Rest& rest, std::vector<int>& paths) {
  paths.reserve(static_cast<size_t>(named.size()));
  for (int i = 0; i < named.size(); ++i) {
    rest();
    // The place is written for a fault alone: there may be millions of these.
    if (named[i] > INT_MAX) {
      return Index(named[i], absl::StrCat(place.text(), ".", field, "[", i, "]")).status();
    }
    paths.push_back(static_cast<int>(named[i]));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status SetWalls(const v1::Layer& message, const Place& place, Budget* budget,
                      JobLayer& layer) {
  Rest rest(budget);
  LayerWalls& walls = layer.walls;
  walls.walls.reserve(static_cast<size_t>(message.walls_size()));
  // A few bytes name a contour of any size. Each may be named once; more often only as long as all
  // that is copied so is no more than the layer has.
  size_t may_copy = 0;
  for (const Path& path : layer.plan.paths) {
    rest();
    may_copy += path.points.size() + 1;
  }
  for (int w = 0; w < message.walls_size(); ++w) {
    rest(kStepsOfMessage + static_cast<size_t>(message.walls(w).points_size()));
    absl::StatusOr<Wall> wall =
        FromProto(message.walls(w), layer.plan, Place(&place, "walls", static_cast<uint64_t>(w)));
    if (!wall.ok()) return wall.status();
    if (message.walls(w).points().empty()) {
      if (wall->points.size() > may_copy) {
        return Fault(absl::StrCat(place.text(), ".walls[", w, "].path"),
                     "the walls up to here name contours that were named before");
      }
      may_copy -= wall->points.size();
    }
    walls.walls.push_back(*std::move(wall));
  }
  TRAVERSE_RETURN_IF_ERROR(
      SetPaths(message.exposed_paths(), place, "exposed_paths", rest, walls.exposed));
  const absl::Status status = CheckWalls(walls, layer.plan, budget);
  // A path takes a byte to be named, and its points are looked up each time.
  RestingSort(walls.exposed, rest);
  walls.exposed.erase(std::unique(walls.exposed.begin(), walls.exposed.end()), walls.exposed.end());
  if (status.ok()) return status;
  return absl::Status(status.code(), absl::StrCat(place.text(), ".", status.message()));
}

}  // namespace traverse
