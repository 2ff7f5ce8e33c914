#include "client/warm_start/layer_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>

namespace traverse {
namespace {

// As the API has it.
constexpr int kMostLevels = 100;

using Points = google::protobuf::RepeatedField<double>;

bool ArePoints(const Points& points, int least) {
  return points.size() % 2 == 0 && points.size() >= 2 * least &&
         std::all_of(points.begin(), points.end(),
                     [](double value) { return std::isfinite(value); });
}

class ShapeMaker {
 public:
  std::optional<LayerShape> FromIslands(const v1::Layer& layer, bool interleaved) {
    std::vector<std::vector<int>> contours;
    std::vector<std::vector<int>> rasters;
    for (int i = 0; i < layer.islands_size(); ++i) {
      const v1::Island& island = layer.islands(i);
      v1::Visit name;
      name.set_island(static_cast<uint32_t>(i));
      contours.emplace_back();
      rasters.emplace_back();
      for (int c = 0; c < island.contours_size(); ++c) {
        name.set_contour(static_cast<uint32_t>(c));
        contours.back().push_back(AddContour(island.contours(c), island.id(), name));
      }
      for (int r = 0; r < island.rasters_size(); ++r) {
        name.set_raster(static_cast<uint32_t>(r));
        rasters.back().push_back(AddOpenPath(island.rasters(r), island.id(), name));
      }
    }
    if (!is_valid_) return std::nullopt;
    const int root = AddNode(0, !interleaved);
    if (interleaved) {
      for (size_t i = 0; i < contours.size(); ++i) AddIsland(root, contours[i], rasters[i]);
    } else {
      for (const auto& kind : {contours, rasters}) {
        const int all = AddNode(root, false);
        for (const auto& paths : kind) AddLeaves(all, paths);
      }
    }
    return std::move(shape_);
  }

  std::optional<LayerShape> FromPlan(const v1::Plan& plan, const PathNotes* notes) {
    for (int p = 0; p < plan.paths_size(); ++p) {
      v1::Visit name;
      name.set_plan_path(static_cast<uint32_t>(p));
      const auto at = static_cast<size_t>(p);
      const uint64_t island = notes != nullptr && at < notes->island.size() ? notes->island[at] : 0;
      const v1::PlanPath& path = plan.paths(p);
      if (path.has_contour()) {
        AddContour(path.contour(), island, name);
      } else {
        AddOpenPath(path.open_path(), island, name);
      }
    }
    for (const v1::PlanNode& node : plan.nodes()) AddPlanNode(node);
    if (!is_valid_ || !IsTree()) return std::nullopt;
    return std::move(shape_);
  }

 private:
  int AddContour(const v1::Contour& contour, uint64_t island, const v1::Visit& name) {
    is_valid_ = is_valid_ && ArePoints(contour.points(), 1);
    ShapePath& path = shape_.paths.emplace_back();
    path.contour = true;
    path.island = island;
    path.id = contour.id();
    path.points = contour.points();
    path.name = name;
    const auto vertices = static_cast<uint32_t>(contour.points_size() / 2);
    path.entries.assign(contour.entries().begin(), contour.entries().end());
    for (const uint32_t entry : path.entries) is_valid_ = is_valid_ && entry < vertices;
    if (path.entries.empty()) {
      for (uint32_t v = 0; v < vertices; ++v) path.entries.push_back(v);
    }
    return static_cast<int>(shape_.paths.size()) - 1;
  }

  int AddOpenPath(const v1::OpenPath& open, uint64_t island, const v1::Visit& name) {
    is_valid_ = is_valid_ && ArePoints(open.points(), 2);
    ShapePath& path = shape_.paths.emplace_back();
    path.one_way = open.one_way();
    path.island = island;
    path.id = open.id();
    path.points = open.points();
    path.name = name;
    path.entries = path.one_way ? std::vector<uint32_t>{0} : std::vector<uint32_t>{0, 1};
    return static_cast<int>(shape_.paths.size()) - 1;
  }

  int AddNode(int parent, bool in_order) {
    const int node = static_cast<int>(shape_.nodes.size());
    shape_.nodes.push_back({.in_order = in_order});
    if (node > 0) shape_.nodes[static_cast<size_t>(parent)].children.push_back(node);
    return node;
  }

  void AddLeaves(int parent, absl::Span<const int> paths) {
    for (const int path : paths) {
      const int leaf = AddNode(parent, false);
      shape_.nodes[static_cast<size_t>(leaf)].path = path;
      shape_.paths[static_cast<size_t>(path)].parent = parent;
    }
  }

  void AddIsland(int root, absl::Span<const int> contours, absl::Span<const int> rasters) {
    const int island = AddNode(root, true);
    AddLeaves(island, contours.subspan(0, contours.empty() ? 0 : 1));
    if (contours.size() > 1) AddLeaves(AddNode(island, false), contours.subspan(1));
    AddLeaves(AddNode(island, false), rasters);
  }

  void AddPlanNode(const v1::PlanNode& message) {
    ShapeNode& node = shape_.nodes.emplace_back();
    const auto add = [&](const auto& children) {
      for (const uint32_t child : children) node.children.push_back(static_cast<int>(child));
    };
    if (message.has_path()) node.path = static_cast<int>(message.path());
    if (message.has_in_order()) {
      node.in_order = true;
      add(message.in_order().children());
    } else if (message.has_any_order()) {
      add(message.any_order().children());
      for (const v1::Precedence& pair : message.any_order().before()) {
        node.before.emplace_back(static_cast<int>(pair.first()), static_cast<int>(pair.second()));
      }
    }
  }

  // Whether each node but the first is the child of one of smaller number, and each path one leaf;
  // sets the parents of paths.
  bool IsTree() {
    const int count = static_cast<int>(shape_.nodes.size());
    std::vector<int> level(shape_.nodes.size());
    std::vector<int> parent(shape_.nodes.size(), -1);
    size_t leaves = 0;
    for (int n = 0; n < count; ++n) {
      const auto at = static_cast<size_t>(n);
      const ShapeNode& node = shape_.nodes[at];
      if ((n > 0 && parent[at] < 0) || level[at] > kMostLevels) return false;
      for (const int child : node.children) {
        if (child <= n || child >= count || parent[static_cast<size_t>(child)] >= 0) return false;
        parent[static_cast<size_t>(child)] = n;
        level[static_cast<size_t>(child)] = level[at] + 1;
      }
      const int children = static_cast<int>(node.children.size());
      for (const auto& [first, second] : node.before) {
        if (first < 0 || first >= children || second < 0 || second >= children) return false;
      }
      if (node.path < 0) continue;
      if (node.path >= static_cast<int>(shape_.paths.size())) return false;
      shape_.paths[static_cast<size_t>(node.path)].parent = parent[at];
      ++leaves;
    }
    return leaves == shape_.paths.size();
  }

  LayerShape shape_;
  bool is_valid_ = true;
};

}  // namespace

std::pair<double, double> ShapePath::Enter(uint32_t entry) const {
  const size_t at = contour ? 2 * size_t{entry} : entry == 0 ? 0 : points.size() - 2;
  return {points[at], points[at + 1]};
}

std::pair<double, double> ShapePath::Exit(uint32_t entry) const {
  return Enter(contour ? entry : 1 - entry);
}

v1::Visit ShapePath::VisitAt(uint32_t entry) const {
  v1::Visit visit = name;
  if (contour) {
    visit.set_vertex(entry);
  } else {
    visit.set_reversed(entry == 1);
  }
  return visit;
}

std::optional<LayerShape> ShapeOf(const v1::Layer& layer, bool interleaved,
                                  const PathNotes* notes) {
  return layer.has_plan() ? ShapeMaker().FromPlan(layer.plan(), notes)
                          : ShapeMaker().FromIslands(layer, interleaved);
}

namespace {

class Ordering {
 public:
  Ordering(const LayerShape& shape, absl::Span<const double> ranks)
      : shape_(shape), least_(shape.nodes.size(), -std::numeric_limits<double>::infinity()) {
    // From the leaves up, as children have greater numbers than their parents. Nodes without paths
    // come as soon as they may.
    for (size_t n = shape.nodes.size(); n-- > 0;) {
      const ShapeNode& node = shape.nodes[n];
      if (node.path >= 0) least_[n] = ranks[static_cast<size_t>(node.path)];
      for (const int child : node.children) {
        const double of_child = least_[static_cast<size_t>(child)];
        if (std::isinf(of_child)) continue;
        least_[n] = std::isinf(least_[n]) ? of_child : std::min(least_[n], of_child);
      }
    }
    if (!shape.nodes.empty()) Append(0);
  }

  std::vector<int> order() { return std::move(order_); }

 private:
  void Append(int index) {
    const ShapeNode& node = shape_.nodes[static_cast<size_t>(index)];
    if (node.path >= 0) order_.push_back(node.path);
    if (node.in_order) {
      for (const int child : node.children) Append(child);
    } else {
      AppendByRanks(node);
    }
  }

  void AppendByRanks(const ShapeNode& node) {
    std::vector<std::vector<int>> later(node.before.empty() ? 0 : node.children.size());
    std::vector<int> waits_for(node.children.size());
    for (const auto& [first, second] : node.before) {
      later[static_cast<size_t>(first)].push_back(second);
      ++waits_for[static_cast<size_t>(second)];
    }
    using Ready = std::pair<double, int>;  // rank, position
    std::priority_queue<Ready, std::vector<Ready>, std::greater<>> ready;
    const auto add = [&](int position) {
      const int child = node.children[static_cast<size_t>(position)];
      ready.push({least_[static_cast<size_t>(child)], position});
    };
    for (size_t c = 0; c < node.children.size(); ++c) {
      if (waits_for[c] == 0) add(static_cast<int>(c));
    }
    while (!ready.empty()) {
      const int position = ready.top().second;
      ready.pop();
      Append(node.children[static_cast<size_t>(position)]);
      if (later.empty()) continue;
      for (const int next : later[static_cast<size_t>(position)]) {
        if (--waits_for[static_cast<size_t>(next)] == 0) add(next);
      }
    }
  }

  const LayerShape& shape_;
  std::vector<double> least_;  // [node] of its paths
  std::vector<int> order_;
};

}  // namespace

std::vector<int> OrderByRanks(const LayerShape& shape, absl::Span<const double> ranks) {
  return Ordering(shape, ranks).order();
}

}  // namespace traverse
