#include <algorithm>
#include <climits>
#include <utility>
#include <vector>

#include "engine/base/resting_sort.h"
#include "server/translate/fault_list.h"
#include "server/translate/field_ranges.h"
#include "server/translate/translate.h"
#include "server/translate/translate_check.h"

namespace traverse {
namespace {

// Where in the request we are, as text that is only put together when there is a fault.
class Place {
 public:
  Place(const Place* parent, const char* field, uint64_t index)
      : parent_(parent), field_(field), index_(index) {}

  std::string text() const {
    return absl::StrCat(parent_ == nullptr ? "" : absl::StrCat(parent_->text(), "."), field_, "[",
                        index_, "]");
  }

 private:
  const Place* parent_;
  const char* field_;
  uint64_t index_;
};

// As CheckKnown, but without building the place's text; for the messages of which there are many.
template <typename Message>
absl::Status CheckKnownAt(const Message& message, const Place& place) {
  if (message.GetReflection()->GetUnknownFields(message).empty()) return absl::OkStatus();
  return CheckKnown(message, place.text());
}

using Coordinates = google::protobuf::RepeatedField<double>;

absl::Status CheckCoordinates(const Coordinates& coordinates, const FieldRange& range,
                              const Place& place) {
  if (coordinates.size() % 2 != 0) {
    return Fault(place.text() + ".points",
                 absl::StrCat(coordinates.size(), " coordinates, which are no pairs of x and y"));
  }
  for (int i = 0; i < coordinates.size(); ++i) {
    // What is not a number is in no range.
    if (coordinates[i] >= range.least && coordinates[i] <= range.greatest) continue;
    return CheckRange(range, coordinates[i],
                      absl::StrCat(place.text(), ".points[", i / 2, "].", i % 2 == 0 ? "x" : "y"));
  }
  return absl::OkStatus();
}

Point PointAt(const Coordinates& coordinates, int point) {
  return {coordinates[2 * point], coordinates[2 * point + 1]};
}

absl::StatusOr<Path> FromProto(const v1::Contour& contour, const Place& place) {
  static const FieldRange& range = RangeOf("Contour.points");
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(contour, place));
  TRAVERSE_RETURN_IF_ERROR(CheckCoordinates(contour.points(), range, place));
  const int points = contour.points_size() / 2;
  if (points == 0) return Fault(place.text() + ".points", "a contour needs at least one point");
  Path path;
  path.kind = Path::Kind::kContour;
  path.points.reserve(static_cast<size_t>(points));
  for (int i = 0; i < points; ++i) path.points.push_back(PointAt(contour.points(), i));
  if (contour.entries().empty()) return path;
  std::vector<bool> seen(static_cast<size_t>(points));
  for (int i = 0; i < contour.entries_size(); ++i) {
    const uint32_t entry = contour.entries(i);
    if (entry >= static_cast<uint32_t>(points)) {
      return Fault(absl::StrCat(place.text(), ".entries[", i, "]"),
                   absl::StrCat(entry, " is not a vertex of a contour of ", points));
    }
    if (seen[entry]) {
      return Fault(absl::StrCat(place.text(), ".entries[", i, "]"),
                   absl::StrCat(entry, " is repeated"));
    }
    seen[entry] = true;
    path.allowed.push_back(static_cast<int>(entry));
  }
  return path;
}

absl::StatusOr<Path> FromProto(const v1::OpenPath& open, const Place& place) {
  static const FieldRange& range = RangeOf("OpenPath.points");
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(open, place));
  TRAVERSE_RETURN_IF_ERROR(CheckCoordinates(open.points(), range, place));
  const int points = open.points_size() / 2;
  if (points < 2) {
    return Fault(place.text() + ".points",
                 absl::StrCat("an open path needs at least two points, not ", points));
  }
  return MakeOpenPath(PointAt(open.points(), 0), PointAt(open.points(), points - 1),
                      open.one_way());
}

// What Rest counts for a message that is translated, and for its points.
constexpr size_t kStepsOfMessage = 64;
size_t StepsOf(const v1::Contour& contour) {
  return static_cast<size_t>(contour.points_size() + contour.entries_size());
}
size_t StepsOf(const v1::OpenPath& open) { return static_cast<size_t>(open.points_size()); }

// Translates a list of contours or open paths and appends them to `paths`.
template <typename Message>
absl::Status AppendPaths(const google::protobuf::RepeatedPtrField<Message>& messages,
                         const char* field, const Place& parent, Rest& rest,
                         std::vector<Path>& paths) {
  FaultList faults;
  paths.reserve(static_cast<size_t>(messages.size()));
  for (int i = 0; i < messages.size() && !faults.full(); ++i) {
    rest(kStepsOfMessage + StepsOf(messages[i]));
    absl::StatusOr<Path> path =
        FromProto(messages[i], Place(&parent, field, static_cast<uint64_t>(i)));
    faults.Add(path.status());
    if (path.ok()) paths.push_back(*std::move(path));
  }
  return faults.status();
}

absl::StatusOr<Plan> FromIslands(const v1::Layer& layer, const Place& place, bool interleaved,
                                 Budget* budget) {
  Rest rest(budget);
  std::vector<IslandPaths> islands;
  islands.reserve(static_cast<size_t>(layer.islands_size()));
  FaultList faults;
  for (int i = 0; i < layer.islands_size() && !faults.full(); ++i) {
    const v1::Island& island = layer.islands(i);
    rest(kStepsOfMessage);
    const Place at(&place, "islands", static_cast<uint64_t>(i));
    IslandPaths& paths = islands.emplace_back();
    faults.Add(CheckKnownAt(island, at));
    faults.Add(AppendPaths(island.contours(), "contours", at, rest, paths.contours));
    faults.Add(AppendPaths(island.rasters(), "rasters", at, rest, paths.rasters));
  }
  if (!faults.empty()) return faults.status();
  return interleaved ? InterleavedPlan(std::move(islands), budget)
                     : SequentialPlan(std::move(islands), budget);
}

// An index as sent to one of the engine. Values beyond int are no index of anything.
absl::StatusOr<int> Index(uint32_t value, const std::string& place) {
  if (value > INT_MAX) return Fault(place, absl::StrCat(value, " is too large for an index"));
  return static_cast<int>(value);
}

absl::Status SetChildren(const google::protobuf::RepeatedField<uint32_t>& children,
                         const char* field, const Place& place, Rest& rest, PlanNode& node) {
  node.children.reserve(static_cast<size_t>(children.size()));
  for (int c = 0; c < children.size(); ++c) {
    rest();
    if (children[c] > INT_MAX) {
      return Index(children[c], absl::StrCat(place.text(), field, ".children[", c, "]")).status();
    }
    node.children.push_back(static_cast<int>(children[c]));
  }
  return absl::OkStatus();
}

absl::Status SetBefore(const v1::AnyOrder& any_order, const Place& place, Rest& rest,
                       PlanNode& node) {
  node.before.reserve(static_cast<size_t>(any_order.before_size()));
  const std::string field = place.text() + ".any_order.before";
  for (int i = 0; i < any_order.before_size(); ++i) {
    rest(kStepsOfMessage);
    const v1::Precedence& pair = any_order.before(i);
    const Place at(nullptr, field.c_str(), static_cast<uint64_t>(i));
    TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(pair, at));
    for (const bool is_first : {true, false}) {
      const uint32_t value = is_first ? pair.first() : pair.second();
      if (value <= INT_MAX) continue;
      return Index(value, at.text() + (is_first ? ".first" : ".second")).status();
    }
    node.before.emplace_back(static_cast<int>(pair.first()), static_cast<int>(pair.second()));
  }
  return absl::OkStatus();
}

absl::StatusOr<PlanNode> FromProto(const v1::PlanNode& message, const Place& place, Rest& rest) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message, place));
  PlanNode node;
  switch (message.kind_case()) {
    case v1::PlanNode::kPath: {
      if (message.path() > INT_MAX) {
        return Index(message.path(), place.text() + ".path").status();
      }
      node.path = static_cast<int>(message.path());
      return node;
    }
    case v1::PlanNode::kInOrder: {
      node.kind = PlanNode::Kind::kInOrder;
      TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message.in_order(), place));
      TRAVERSE_RETURN_IF_ERROR(
          SetChildren(message.in_order().children(), ".in_order", place, rest, node));
      return node;
    }
    case v1::PlanNode::kAnyOrder: {
      node.kind = PlanNode::Kind::kAnyOrder;
      TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message.any_order(), place));
      TRAVERSE_RETURN_IF_ERROR(
          SetChildren(message.any_order().children(), ".any_order", place, rest, node));
      TRAVERSE_RETURN_IF_ERROR(SetBefore(message.any_order(), place, rest, node));
      return node;
    }
    case v1::PlanNode::KIND_NOT_SET:
      break;
  }
  return Fault(place.text(), "none of path, in_order and any_order is set");
}

absl::StatusOr<Path> FromProto(const v1::PlanPath& message, const Place& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message, place));
  switch (message.path_case()) {
    case v1::PlanPath::kContour:
      return FromProto(message.contour(), place);
    case v1::PlanPath::kOpenPath:
      return FromProto(message.open_path(), place);
    case v1::PlanPath::PATH_NOT_SET:
      break;
  }
  return Fault(place.text(), "neither contour nor open_path is set");
}

absl::StatusOr<Plan> FromProto(const v1::Plan& message, const std::string& place, Budget* budget) {
  Rest rest(budget);
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(message, place));
  const std::string paths_field = place + ".paths";
  const std::string nodes_field = place + ".nodes";
  Plan plan;
  plan.paths.reserve(static_cast<size_t>(message.paths_size()));
  FaultList faults;
  for (int p = 0; p < message.paths_size() && !faults.full(); ++p) {
    rest(kStepsOfMessage + StepsOf(message.paths(p).contour()) +
         StepsOf(message.paths(p).open_path()));
    absl::StatusOr<Path> path =
        FromProto(message.paths(p), Place(nullptr, paths_field.c_str(), static_cast<uint64_t>(p)));
    faults.Add(path.status());
    if (path.ok()) plan.paths.push_back(*std::move(path));
  }
  plan.nodes.reserve(static_cast<size_t>(message.nodes_size()));
  for (int n = 0; n < message.nodes_size() && !faults.full(); ++n) {
    rest(kStepsOfMessage);
    absl::StatusOr<PlanNode> node = FromProto(
        message.nodes(n), Place(nullptr, nodes_field.c_str(), static_cast<uint64_t>(n)), rest);
    faults.Add(node.status());
    if (node.ok()) plan.nodes.push_back(*std::move(node));
  }
  if (!faults.empty()) return faults.status();
  if (absl::Status status = CheckPlan(plan, budget); !status.ok()) {
    return absl::Status(status.code(), absl::StrCat(place, ".", status.message()));
  }
  return plan;
}

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
  walls.exposed.reserve(static_cast<size_t>(message.exposed_paths_size()));
  for (int i = 0; i < message.exposed_paths_size(); ++i) {
    rest();
    const uint32_t path = message.exposed_paths(i);
    // The place is written for a fault alone: there may be millions of these.
    if (path > INT_MAX) {
      return Index(path, absl::StrCat(place.text(), ".exposed_paths[", i, "]")).status();
    }
    walls.exposed.push_back(static_cast<int>(path));
  }
  const absl::Status status = CheckWalls(walls, layer.plan, budget);
  // A path takes a byte to be named, and its points are looked up each time.
  RestingSort(walls.exposed, rest);
  walls.exposed.erase(std::unique(walls.exposed.begin(), walls.exposed.end()), walls.exposed.end());
  if (status.ok()) return status;
  return absl::Status(status.code(), absl::StrCat(place.text(), ".", status.message()));
}

}  // namespace

int64_t CountPoints(const v1::Layer& layer, Budget* budget) {
  Rest rest(budget);
  int64_t coordinates = 0;
  for (const v1::Island& island : layer.islands()) {
    rest(8 + 8 * static_cast<size_t>(island.contours_size() + island.rasters_size()));
    for (const v1::Contour& contour : island.contours()) coordinates += contour.points_size();
    for (const v1::OpenPath& raster : island.rasters()) coordinates += raster.points_size();
  }
  for (const v1::PlanPath& path : layer.plan().paths()) {
    rest(8);
    coordinates += path.contour().points_size() + path.open_path().points_size();
  }
  for (const v1::Wall& wall : layer.walls()) {
    rest(8);
    coordinates += wall.points_size();
  }
  return coordinates / 2;
}

absl::StatusOr<LabelledLayer> LayerFromProto(const v1::Layer& layer, uint64_t index,
                                             bool interleaved, Budget* budget) {
  const Place place(nullptr, "layers", index);
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(layer, place));
  if (layer.has_plan() && !layer.islands().empty()) {
    return Fault(place.text(), "has both islands and a plan, of which it may have one");
  }
  FaultList faults;
  faults.Add(CheckRange(RangeOf("Layer.z_mm"), layer.z_mm(), place.text() + ".z_mm"));
  LabelledLayer result;
  result.label.id = layer.id();
  result.label.points = CountPoints(layer, budget);
  absl::StatusOr<Plan> plan = layer.has_plan()
                                  ? FromProto(layer.plan(), place.text() + ".plan", budget)
                                  : FromIslands(layer, place, interleaved, budget);
  faults.Add(plan.status());
  if (plan.ok()) {
    result.layer.plan = *std::move(plan);
    faults.Add(SetWalls(layer, place, budget, result.layer));
  }
  if (layer.has_start()) {
    absl::StatusOr<Point> start = PointFromProto(layer.start(), place.text() + ".start");
    faults.Add(start.status());
    if (start.ok()) result.layer.start = *start;
  }
  if (layer.has_cost()) {
    absl::StatusOr<CostSpec> cost = CostFromProto(layer.cost(), place.text() + ".cost");
    faults.Add(cost.status());
    if (cost.ok()) result.layer.cost = *cost;
  }
  if (!faults.empty()) return faults.status();
  return result;
}

}  // namespace traverse
