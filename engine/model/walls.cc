#include "engine/model/walls.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "engine/base/rest.h"

namespace traverse {
namespace {

absl::Status CheckWall(const Wall& wall, int paths, size_t index, Rest& rest) {
  const auto place = [index] { return absl::StrCat("walls[", index, "]"); };
  if (wall.path < -1 || wall.path >= paths) {
    return absl::InvalidArgumentError(absl::StrCat(place(), ".path: there is no path ", wall.path));
  }
  if (wall.points.size() < 2) {
    return absl::InvalidArgumentError(absl::StrCat(
        place(), ".points: a wall needs at least two points, not ", wall.points.size()));
  }
  for (size_t i = 0; i < wall.points.size(); ++i) {
    rest();
    for (const bool y : {false, true}) {
      const char* fault = CoordinateFault(y ? wall.points[i].y : wall.points[i].x);
      if (fault == nullptr) continue;
      return absl::InvalidArgumentError(
          absl::StrCat(place(), ".points[", i, "].", y ? "y" : "x", ": ", fault));
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckWalls(const LayerWalls& walls, const Plan& plan, Budget* budget) {
  Rest rest(budget);
  const int paths = static_cast<int>(plan.paths.size());
  for (size_t w = 0; w < walls.walls.size(); ++w) {
    rest(8);
    const absl::Status status = CheckWall(walls.walls[w], paths, w, rest);
    if (!status.ok()) return status;
  }
  for (size_t i = 0; i < walls.exposed.size(); ++i) {
    rest();
    if (walls.exposed[i] >= 0 && walls.exposed[i] < paths) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("exposed_paths[", i, "]: there is no path ", walls.exposed[i]));
  }
  return absl::OkStatus();
}

}  // namespace traverse
