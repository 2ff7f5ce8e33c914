#include "engine/model/walls.h"

#include <cmath>
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
  const auto is_path = [paths](int path) { return path >= 0 && path < paths; };
  const auto check_paths = [&](const std::vector<int>& named, const char* field) {
    for (size_t i = 0; i < named.size(); ++i) {
      rest();
      if (is_path(named[i])) continue;
      return absl::InvalidArgumentError(
          absl::StrCat(field, "[", i, "]: there is no path ", named[i]));
    }
    return absl::OkStatus();
  };
  if (absl::Status status = check_paths(walls.exposed, "exposed_paths"); !status.ok())
    return status;
  if (absl::Status status = check_paths(walls.retracted, "retracted_paths"); !status.ok())
    return status;
  if (walls.known.size() > plan.paths.size()) {
    return absl::InvalidArgumentError(absl::StrCat("known_moves: ", walls.known.size(),
                                                   " are more than the plan has paths, ", paths));
  }
  for (size_t i = 0; i < walls.known.size(); ++i) {
    rest();
    const KnownMove& move = walls.known[i];
    for (const bool to : {false, true}) {
      const int path = to ? move.to : move.from;
      if (is_path(path)) continue;
      return absl::InvalidArgumentError(
          absl::StrCat("known_moves[", i, "].", to ? "to" : "from", ": there is no path ", path));
    }
    if (std::isfinite(move.seconds) && move.seconds >= 0) continue;
    return absl::InvalidArgumentError(absl::StrCat("known_moves[", i, "].seconds: not a time"));
  }
  return absl::OkStatus();
}

}  // namespace traverse
