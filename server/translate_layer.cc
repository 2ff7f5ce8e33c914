#include <algorithm>
#include <climits>
#include <utility>
#include <vector>

#include "server/translate.h"
#include "server/translate_check.h"

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

absl::Status CheckCoordinates(const Coordinates& coordinates, const Place& place) {
  if (coordinates.size() % 2 != 0) {
    return Fault(place.text() + ".points",
                 absl::StrCat(coordinates.size(), " coordinates, which are no pairs of x and y"));
  }
  for (int i = 0; i < coordinates.size(); ++i) {
    if (const char* fault = CoordinateFault(coordinates[i])) {
      return Fault(absl::StrCat(place.text(), ".points[", i / 2, "].", i % 2 == 0 ? "x" : "y"),
                   fault);
    }
  }
  return absl::OkStatus();
}

Point PointAt(const Coordinates& coordinates, int point) {
  return {coordinates[2 * point], coordinates[2 * point + 1]};
}

absl::StatusOr<Path> FromProto(const v1::Contour& contour, const Place& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(contour, place));
  TRAVERSE_RETURN_IF_ERROR(CheckCoordinates(contour.points(), place));
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
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(open, place));
  TRAVERSE_RETURN_IF_ERROR(CheckCoordinates(open.points(), place));
  const int points = open.points_size() / 2;
  if (points < 2) {
    return Fault(place.text() + ".points",
                 absl::StrCat("an open path needs at least two points, not ", points));
  }
  return MakeOpenPath(PointAt(open.points(), 0), PointAt(open.points(), points - 1),
                      open.one_way());
}

// Translates a list of contours or open paths and appends them to `paths`.
template <typename Message>
absl::Status AppendPaths(const google::protobuf::RepeatedPtrField<Message>& messages,
                         const char* field, const Place& parent, std::vector<Path>& paths) {
  paths.reserve(static_cast<size_t>(messages.size()));
  for (int i = 0; i < messages.size(); ++i) {
    absl::StatusOr<Path> path =
        FromProto(messages[i], Place(&parent, field, static_cast<uint64_t>(i)));
    if (!path.ok()) return path.status();
    paths.push_back(*std::move(path));
  }
  return absl::OkStatus();
}

absl::StatusOr<Plan> FromIslands(const v1::Layer& layer, const Place& place, bool interleaved) {
  std::vector<IslandPaths> islands(static_cast<size_t>(layer.islands_size()));
  for (int i = 0; i < layer.islands_size(); ++i) {
    const v1::Island& island = layer.islands(i);
    const Place at(&place, "islands", static_cast<uint64_t>(i));
    IslandPaths& paths = islands[static_cast<size_t>(i)];
    TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(island, at));
    TRAVERSE_RETURN_IF_ERROR(AppendPaths(island.contours(), "contours", at, paths.contours));
    TRAVERSE_RETURN_IF_ERROR(AppendPaths(island.rasters(), "rasters", at, paths.rasters));
  }
  return interleaved ? InterleavedPlan(std::move(islands)) : SequentialPlan(std::move(islands));
}

// An index as sent to one of the engine. Values beyond int are no index of anything.
absl::StatusOr<int> Index(uint32_t value, const std::string& place) {
  if (value > INT_MAX) return Fault(place, absl::StrCat(value, " is too large for an index"));
  return static_cast<int>(value);
}

absl::Status SetChildren(const google::protobuf::RepeatedField<uint32_t>& children,
                         const char* field, const Place& place, PlanNode& node) {
  node.children.reserve(static_cast<size_t>(children.size()));
  for (int c = 0; c < children.size(); ++c) {
    if (children[c] > INT_MAX) {
      return Index(children[c], absl::StrCat(place.text(), field, ".children[", c, "]")).status();
    }
    node.children.push_back(static_cast<int>(children[c]));
  }
  return absl::OkStatus();
}

absl::Status SetBefore(const v1::AnyOrder& any_order, const Place& place, PlanNode& node) {
  node.before.reserve(static_cast<size_t>(any_order.before_size()));
  for (int i = 0; i < any_order.before_size(); ++i) {
    const std::string at = absl::StrCat(place.text(), ".any_order.before[", i, "]");
    const v1::Precedence& pair = any_order.before(i);
    TRAVERSE_RETURN_IF_ERROR(CheckKnown(pair, at));
    absl::StatusOr<int> first = Index(pair.first(), at + ".first");
    if (!first.ok()) return first.status();
    absl::StatusOr<int> second = Index(pair.second(), at + ".second");
    if (!second.ok()) return second.status();
    node.before.emplace_back(*first, *second);
  }
  return absl::OkStatus();
}

absl::StatusOr<PlanNode> FromProto(const v1::PlanNode& message, const Place& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message, place));
  PlanNode node;
  switch (message.kind_case()) {
    case v1::PlanNode::kPath: {
      absl::StatusOr<int> path = Index(message.path(), place.text() + ".path");
      if (!path.ok()) return path.status();
      node.path = *path;
      return node;
    }
    case v1::PlanNode::kInOrder: {
      node.kind = PlanNode::Kind::kInOrder;
      TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message.in_order(), place));
      TRAVERSE_RETURN_IF_ERROR(
          SetChildren(message.in_order().children(), ".in_order", place, node));
      return node;
    }
    case v1::PlanNode::kAnyOrder: {
      node.kind = PlanNode::Kind::kAnyOrder;
      TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message.any_order(), place));
      TRAVERSE_RETURN_IF_ERROR(
          SetChildren(message.any_order().children(), ".any_order", place, node));
      TRAVERSE_RETURN_IF_ERROR(SetBefore(message.any_order(), place, node));
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

absl::StatusOr<Plan> FromProto(const v1::Plan& message, const std::string& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(message, place));
  const std::string paths_field = place + ".paths";
  const std::string nodes_field = place + ".nodes";
  Plan plan;
  plan.paths.reserve(static_cast<size_t>(message.paths_size()));
  for (int p = 0; p < message.paths_size(); ++p) {
    absl::StatusOr<Path> path =
        FromProto(message.paths(p), Place(nullptr, paths_field.c_str(), static_cast<uint64_t>(p)));
    if (!path.ok()) return path.status();
    plan.paths.push_back(*std::move(path));
  }
  plan.nodes.reserve(static_cast<size_t>(message.nodes_size()));
  for (int n = 0; n < message.nodes_size(); ++n) {
    absl::StatusOr<PlanNode> node =
        FromProto(message.nodes(n), Place(nullptr, nodes_field.c_str(), static_cast<uint64_t>(n)));
    if (!node.ok()) return node.status();
    plan.nodes.push_back(*std::move(node));
  }
  if (absl::Status status = CheckPlan(plan); !status.ok()) {
    return absl::Status(status.code(), absl::StrCat(place, ".", status.message()));
  }
  return plan;
}

}  // namespace

int64_t CountPoints(const v1::Layer& layer) {
  int64_t coordinates = 0;
  for (const v1::Island& island : layer.islands()) {
    for (const v1::Contour& contour : island.contours()) coordinates += contour.points_size();
    for (const v1::OpenPath& raster : island.rasters()) coordinates += raster.points_size();
  }
  for (const v1::PlanPath& path : layer.plan().paths()) {
    coordinates += path.contour().points_size() + path.open_path().points_size();
  }
  return coordinates / 2;
}

absl::StatusOr<LabelledLayer> LayerFromProto(const v1::Layer& layer, uint64_t index,
                                             bool interleaved) {
  const Place place(nullptr, "layers", index);
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(layer, place));
  if (layer.has_plan() && !layer.islands().empty()) {
    return Fault(place.text(), "has both islands and a plan, of which it may have one");
  }
  if (!std::isfinite(layer.z_mm())) return Fault(place.text() + ".z_mm", "not finite");
  LabelledLayer result;
  result.id = layer.id();
  result.points = CountPoints(layer);
  absl::StatusOr<Plan> plan = layer.has_plan() ? FromProto(layer.plan(), place.text() + ".plan")
                                               : FromIslands(layer, place, interleaved);
  if (!plan.ok()) return plan.status();
  result.layer.plan = *std::move(plan);
  if (layer.has_start()) {
    absl::StatusOr<Point> start = PointFromProto(layer.start(), place.text() + ".start");
    if (!start.ok()) return start.status();
    result.layer.start = *start;
  }
  if (layer.has_cost()) {
    absl::StatusOr<CostSpec> cost = CostFromProto(layer.cost(), place.text() + ".cost");
    if (!cost.ok()) return cost.status();
    result.layer.cost = *cost;
  }
  return result;
}

}  // namespace traverse
