#include <climits>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "engine/base/rest.h"
#include "server/translate/fault_list.h"
#include "server/translate/field_path.h"
#include "server/translate/field_ranges.h"
#include "server/translate/translate.h"
#include "server/translate/translate_check.h"
#include "server/translate/translate_links.h"
#include "server/translate/translate_route.h"
#include "server/translate/translate_walls.h"

namespace traverse {
namespace {

absl::StatusOr<Path> FromProto(const v1::Contour& contour, const FieldPath& place) {
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

absl::StatusOr<Path> FromProto(const v1::OpenPath& open, const FieldPath& place) {
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

// What Rest counts for the points of a message.
size_t StepsOf(const v1::Contour& contour) {
  return static_cast<size_t>(contour.points_size() + contour.entries_size());
}
size_t StepsOf(const v1::OpenPath& open) { return static_cast<size_t>(open.points_size()); }

// Translates a list of contours or open paths and appends them to `paths`.
template <typename Message>
absl::Status AppendPaths(const google::protobuf::RepeatedPtrField<Message>& messages,
                         const char* field, const FieldPath& parent, Rest& rest,
                         std::vector<Path>& paths) {
  FaultList faults;
  paths.reserve(static_cast<size_t>(messages.size()));
  for (int i = 0; i < messages.size() && !faults.full(); ++i) {
    rest(kStepsOfMessage + StepsOf(messages[i]));
    absl::StatusOr<Path> path =
        FromProto(messages[i], FieldPath(&parent, field, static_cast<uint64_t>(i)));
    faults.Add(path.status());
    if (path.ok()) paths.push_back(*std::move(path));
  }
  return faults.status();
}

absl::StatusOr<Plan> FromIslands(const v1::Layer& layer, const FieldPath& place, bool interleaved,
                                 Budget* budget) {
  Rest rest(budget);
  std::vector<IslandPaths> islands;
  islands.reserve(static_cast<size_t>(layer.islands_size()));
  FaultList faults;
  for (int i = 0; i < layer.islands_size() && !faults.full(); ++i) {
    const v1::Island& island = layer.islands(i);
    rest(kStepsOfMessage);
    const FieldPath at(&place, "islands", static_cast<uint64_t>(i));
    IslandPaths& paths = islands.emplace_back();
    faults.Add(CheckKnownAt(island, at));
    faults.Add(AppendPaths(island.contours(), "contours", at, rest, paths.contours));
    faults.Add(AppendPaths(island.rasters(), "rasters", at, rest, paths.rasters));
  }
  if (!faults.empty()) return faults.status();
  return interleaved ? InterleavedPlan(std::move(islands), budget)
                     : SequentialPlan(std::move(islands), budget);
}

absl::Status SetChildren(const google::protobuf::RepeatedField<uint32_t>& children,
                         const char* field, const FieldPath& place, Rest& rest, PlanNode& node) {
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

absl::Status SetBefore(const v1::AnyOrder& any_order, const FieldPath& place, Rest& rest,
                       PlanNode& node) {
  node.before.reserve(static_cast<size_t>(any_order.before_size()));
  const std::string field = place.text() + ".any_order.before";
  for (int i = 0; i < any_order.before_size(); ++i) {
    rest(kStepsOfMessage);
    const v1::Precedence& pair = any_order.before(i);
    const FieldPath at(nullptr, field.c_str(), static_cast<uint64_t>(i));
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

absl::StatusOr<PlanNode> FromProto(const v1::PlanNode& message, const FieldPath& place,
                                   Rest& rest) {
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
  return Fault(place.text(), "set one of path, in_order and any_order");
}

absl::StatusOr<Path> FromProto(const v1::PlanPath& message, const FieldPath& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message, place));
  switch (message.path_case()) {
    case v1::PlanPath::kContour:
      return FromProto(message.contour(), place);
    case v1::PlanPath::kOpenPath:
      return FromProto(message.open_path(), place);
    case v1::PlanPath::PATH_NOT_SET:
      break;
  }
  return Fault(place.text(), "set contour or open_path");
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
    absl::StatusOr<Path> path = FromProto(
        message.paths(p), FieldPath(nullptr, paths_field.c_str(), static_cast<uint64_t>(p)));
    faults.Add(path.status());
    if (path.ok()) plan.paths.push_back(*std::move(path));
  }
  plan.nodes.reserve(static_cast<size_t>(message.nodes_size()));
  for (int n = 0; n < message.nodes_size() && !faults.full(); ++n) {
    rest(kStepsOfMessage);
    absl::StatusOr<PlanNode> node = FromProto(
        message.nodes(n), FieldPath(nullptr, nodes_field.c_str(), static_cast<uint64_t>(n)), rest);
    faults.Add(node.status());
    if (node.ok()) plan.nodes.push_back(*std::move(node));
  }
  if (!faults.empty()) return faults.status();
  if (absl::Status status = CheckPlan(plan, budget); !status.ok()) {
    return absl::Status(status.code(), absl::StrCat(place, ".", status.message()));
  }
  return plan;
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
  const FieldPath place(nullptr, "layers", index);
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(layer, place));
  if (layer.has_plan() && !layer.islands().empty()) {
    return Fault(place.text(), "has both islands and a plan, but may have only one of them");
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
    faults.Add(SetLinks(layer, place, budget, result.layer));
    faults.Add(SetWalls(layer, place, budget, result.layer));
    faults.Add(SetInitialRoute(layer, place, budget, result.layer));
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
