#include "server/translate/translate_walls.h"

#include <algorithm>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "engine/base/rest.h"
#include "engine/base/resting_sort.h"
#include "engine/model/path.h"
#include "engine/model/plan.h"
#include "engine/model/walls.h"
#include "google/protobuf/repeated_field.h"
#include "server/translate/field_ranges.h"
#include "server/translate/translate_check.h"

namespace traverse {
namespace {

absl::StatusOr<Wall> FromProto(const v1::Wall& message, const Plan& plan, const FieldPath& place) {
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
    return Fault(place.text() + ".points", "none, and the named path is not a contour");
  }
  wall.points = path.points;
  wall.closed = true;
  // A contour may be a point, which nothing crosses.
  if (wall.points.size() == 1) wall.points.push_back(wall.points[0]);
  return wall;
}

absl::Status SetPaths(const google::protobuf::RepeatedField<uint32_t>& named,
                      const FieldPath& place, const char* field, Rest& rest,
                      std::vector<int>& paths) {
  paths.reserve(static_cast<size_t>(named.size()));
  for (int i = 0; i < named.size(); ++i) {
    rest();
    // The position is only written for a fault: there may be millions of these.
    if (named[i] > INT_MAX) {
      return Index(named[i], absl::StrCat(place.text(), ".", field, "[", i, "]")).status();
    }
    paths.push_back(static_cast<int>(named[i]));
  }
  return absl::OkStatus();
}

absl::StatusOr<KnownMove> FromProto(const v1::KnownMove& message, const FieldPath& place) {
  static const FieldRange& range = RangeOf("KnownMove.seconds");
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message, place));
  if (message.from() > INT_MAX) return Index(message.from(), place.text() + ".from").status();
  if (message.to() > INT_MAX) return Index(message.to(), place.text() + ".to").status();
  // NaN is in no range.
  if (!(message.seconds() >= range.least && message.seconds() <= range.greatest)) {
    return CheckRange(range, message.seconds(), place.text() + ".seconds");
  }
  KnownMove move;
  move.from = static_cast<int>(message.from());
  move.to = static_cast<int>(message.to());
  move.seconds = message.seconds();
  move.crosses = message.crosses();
  move.retracts = message.retracts();
  return move;
}

absl::Status SetKnownMoves(const v1::Layer& message, const FieldPath& place, Rest& rest,
                           JobLayer& layer) {
  if (static_cast<size_t>(message.known_moves_size()) > layer.plan.paths.size()) {
    return Fault(place.text() + ".known_moves",
                 absl::StrCat(message.known_moves_size(), " are more than the plan has paths"));
  }
  layer.walls.known.reserve(static_cast<size_t>(message.known_moves_size()));
  for (int i = 0; i < message.known_moves_size(); ++i) {
    rest(kStepsOfMessage);
    absl::StatusOr<KnownMove> move = FromProto(
        message.known_moves(i), FieldPath(&place, "known_moves", static_cast<uint64_t>(i)));
    if (!move.ok()) return move.status();
    layer.walls.known.push_back(*move);
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status SetWalls(const v1::Layer& message, const FieldPath& place, Budget* budget,
                      JobLayer& layer) {
  Rest rest(budget);
  LayerWalls& walls = layer.walls;
  walls.walls.reserve(static_cast<size_t>(message.walls_size()));
  // A few bytes name a contour of any size. Each may be named once; more often only while all that
  // is copied so is no more than the layer has.
  size_t may_copy = 0;
  for (const Path& path : layer.plan.paths) {
    rest();
    may_copy += path.points.size() + 1;
  }
  for (int w = 0; w < message.walls_size(); ++w) {
    rest(kStepsOfMessage + static_cast<size_t>(message.walls(w).points_size()));
    absl::StatusOr<Wall> wall = FromProto(message.walls(w), layer.plan,
                                          FieldPath(&place, "walls", static_cast<uint64_t>(w)));
    if (!wall.ok()) return wall.status();
    if (message.walls(w).points().empty()) {
      if (wall->points.size() > may_copy) {
        return Fault(absl::StrCat(place.text(), ".walls[", w, "].path"),
                     "the walls up to here name contours repeatedly");
      }
      may_copy -= wall->points.size();
    }
    walls.walls.push_back(*std::move(wall));
  }
  TRAVERSE_RETURN_IF_ERROR(
      SetPaths(message.exposed_paths(), place, "exposed_paths", rest, walls.exposed));
  TRAVERSE_RETURN_IF_ERROR(
      SetPaths(message.retracted_paths(), place, "retracted_paths", rest, walls.retracted));
  TRAVERSE_RETURN_IF_ERROR(SetKnownMoves(message, place, rest, layer));
  const absl::Status status = CheckWalls(walls, layer.plan, budget);
  // A path takes a byte to be named, and its points are looked up each time.
  for (std::vector<int>* paths : {&walls.exposed, &walls.retracted}) {
    RestingSort(*paths, rest);
    paths->erase(std::unique(paths->begin(), paths->end()), paths->end());
  }
  if (status.ok()) return status;
  return absl::Status(status.code(), absl::StrCat(place.text(), ".", status.message()));
}

}  // namespace traverse
