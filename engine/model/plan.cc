#include "engine/model/plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "engine/base/rest.h"
#include "engine/base/tolerances.h"

namespace traverse {
namespace {

absl::Status Fault(const std::string& place, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(place, ": ", what));
}

// The text of a position is built only for a fault: there may be millions of positions.
std::string PathPlace(size_t index) { return absl::StrCat("paths[", index, "]"); }
std::string NodePlace(int index, const PlanNode& node) {
  const char* kind = "";
  if (node.kind == PlanNode::Kind::kInOrder) kind = ".in_order";
  if (node.kind == PlanNode::Kind::kAnyOrder) kind = ".any_order";
  return absl::StrCat("nodes[", index, "]", kind);
}

absl::Status CheckAllowed(const Path& path, size_t index, Rest& rest) {
  std::vector<bool> seen(path.allowed.empty() ? 0 : path.points.size());
  for (size_t i = 0; i < path.allowed.size(); ++i) {
    rest();
    const int vertex = path.allowed[i];
    if (vertex < 0 || vertex >= static_cast<int>(path.points.size())) {
      return Fault(absl::StrCat(PathPlace(index), ".entries[", i, "]"),
                   absl::StrCat(vertex, " is not a vertex of a contour of ", path.points.size()));
    }
    if (seen[static_cast<size_t>(vertex)]) {
      return Fault(absl::StrCat(PathPlace(index), ".entries[", i, "]"),
                   absl::StrCat(vertex, " is repeated"));
    }
    seen[static_cast<size_t>(vertex)] = true;
  }
  return absl::OkStatus();
}

absl::Status CheckPath(const Path& path, size_t index, Rest& rest) {
  if (path.kind == Path::Kind::kContour && path.points.empty()) {
    return Fault(absl::StrCat(PathPlace(index), ".points"), "a contour needs at least one point");
  }
  if (path.kind == Path::Kind::kOpen && path.points.size() != 2) {
    return Fault(absl::StrCat(PathPlace(index), ".points"), "an open path has two ends");
  }
  for (size_t i = 0; i < path.points.size(); ++i) {
    rest();
    if (const char* fault = CoordinateFault(path.points[i].x)) {
      return Fault(absl::StrCat(PathPlace(index), ".points[", i, "].x"), fault);
    }
    if (const char* fault = CoordinateFault(path.points[i].y)) {
      return Fault(absl::StrCat(PathPlace(index), ".points[", i, "].y"), fault);
    }
  }
  return CheckAllowed(path, index, rest);
}

// Kahn's algorithm over the pairs of one node.
bool HasCycle(const PlanNode& node, Rest& rest) {
  const size_t n = node.children.size();
  std::vector<size_t> first_later(n + 2);
  std::vector<int> later(node.before.size());
  std::vector<int> waiting_for(n);
  for (const auto& [first, second] : node.before) {
    rest(2);
    ++first_later[static_cast<size_t>(first) + 2];
    ++waiting_for[static_cast<size_t>(second)];
  }
  for (size_t i = 2; i < first_later.size(); ++i) first_later[i] += first_later[i - 1];
  for (const auto& [first, second] : node.before) {
    rest(4);
    later[first_later[static_cast<size_t>(first) + 1]++] = second;
  }
  std::vector<size_t> ready;
  for (size_t i = 0; i < n; ++i) {
    if (waiting_for[i] == 0) ready.push_back(i);
  }
  for (size_t next = 0; next < ready.size(); ++next) {
    rest();
    for (size_t i = first_later[ready[next]]; i < first_later[ready[next] + 1]; ++i) {
      rest(4);
      const auto second = static_cast<size_t>(later[i]);
      if (--waiting_for[second] == 0) ready.push_back(second);
    }
  }
  return ready.size() < n;
}

absl::Status CheckBefore(const PlanNode& node, int index, Rest& rest) {
  const int n = static_cast<int>(node.children.size());
  const auto place = [&](size_t i) {
    return absl::StrCat(NodePlace(index, node), ".before[", i, "]");
  };
  for (size_t i = 0; i < node.before.size(); ++i) {
    rest();
    const auto [first, second] = node.before[i];
    if (first < 0 || first >= n) {
      return Fault(place(i) + ".first", absl::StrCat(first, " is not the position of a child"));
    }
    if (second < 0 || second >= n) {
      return Fault(place(i) + ".second", absl::StrCat(second, " is not the position of a child"));
    }
    if (first == second) {
      return Fault(place(i), absl::StrCat("child ", first, " cannot come before itself"));
    }
  }
  if (!node.before.empty() && HasCycle(node, rest)) {
    return Fault(NodePlace(index, node) + ".before", "the pairs form a cycle");
  }
  return absl::OkStatus();
}

// Collects what the nodes say of each other, one node after the other.
class TreeCheck {
 public:
  TreeCheck(const Plan& plan, Rest& rest)
      : plan_(plan), depth_(plan.nodes.size()), leaf_of_(plan.paths.size(), -1), rest_(rest) {}

  absl::Status Run() {
    if (plan_.nodes.empty() && !plan_.paths.empty()) {
      return Fault("nodes", "empty, but there are paths");
    }
    if (!plan_.nodes.empty()) depth_[0] = 1;
    for (size_t i = 0; i < plan_.nodes.size(); ++i) {
      rest_(8);
      if (depth_[i] == 0) {
        return Fault(absl::StrCat("nodes[", i, "]"), "is not the child of any node");
      }
      if (absl::Status status = CheckNode(static_cast<int>(i)); !status.ok()) return status;
    }
    for (size_t p = 0; p < leaf_of_.size(); ++p) {
      if (leaf_of_[p] < 0) {
        return Fault(absl::StrCat("paths[", p, "]"), "is not the path of any node");
      }
    }
    return absl::OkStatus();
  }

 private:
  absl::Status CheckNode(int index) {
    const PlanNode& node = plan_.nodes[static_cast<size_t>(index)];
    if (node.kind == PlanNode::Kind::kPath) return CheckLeaf(node, index);
    if (absl::Status status = CheckChildren(node, index); !status.ok()) return status;
    return CheckBefore(node, index, rest_);
  }

  absl::Status CheckLeaf(const PlanNode& node, int index) {
    const auto place = [&] { return NodePlace(index, node) + ".path"; };
    if (node.path < 0 || node.path >= static_cast<int>(plan_.paths.size())) {
      return Fault(place(), absl::StrCat(node.path, " is not the index of a path"));
    }
    int& leaf = leaf_of_[static_cast<size_t>(node.path)];
    if (leaf >= 0) {
      return Fault(place(),
                   absl::StrCat("path ", node.path, " is already that of nodes[", leaf, "]"));
    }
    leaf = index;
    return absl::OkStatus();
  }

  absl::Status CheckChildren(const PlanNode& node, int index) {
    const auto place = [&](size_t c) {
      return absl::StrCat(NodePlace(index, node), ".children[", c, "]");
    };
    for (size_t c = 0; c < node.children.size(); ++c) {
      rest_(2);
      const int child = node.children[c];
      if (child <= index || child >= static_cast<int>(plan_.nodes.size())) {
        return Fault(place(c), absl::StrCat(child, " is not the index of a later node"));
      }
      int& depth = depth_[static_cast<size_t>(child)];
      if (depth != 0)
        return Fault(place(c), absl::StrCat("nodes[", child, "] already has a parent"));
      depth = depth_[static_cast<size_t>(index)] + 1;
      if (depth > kMaxPlanDepth) {
        return Fault(place(c), absl::StrCat("nested deeper than ", kMaxPlanDepth, " levels"));
      }
    }
    return absl::OkStatus();
  }

  const Plan& plan_;
  std::vector<int> depth_;    // [node] level from 1; 0: not yet a child
  std::vector<int> leaf_of_;  // [path] its node; -1: none yet
  Rest& rest_;
};

// Appends nodes of a plan under construction.
class PlanBuilder {
 public:
  // Asks `budget` regularly, if it is not null. `islands` will be added: then long arrays are not
  // moved while they grow.
  PlanBuilder(const std::vector<IslandPaths>& islands, Budget* budget) : rest_(budget) {
    size_t paths = 0;
    for (const IslandPaths& island : islands) {
      rest_();
      paths += island.contours.size() + island.rasters.size();
    }
    plan_.paths.reserve(paths);
    plan_.nodes.reserve(paths + 3);
  }

  int AddNode(PlanNode::Kind kind, int parent) {
    rest_(16);
    const int index = static_cast<int>(plan_.nodes.size());
    plan_.nodes.push_back(PlanNode{kind, 0, {}, {}});
    if (parent >= 0) plan_.nodes[static_cast<size_t>(parent)].children.push_back(index);
    return index;
  }

  void AddLeaf(int path, int parent) {
    plan_.nodes[static_cast<size_t>(AddNode(PlanNode::Kind::kPath, parent))].path = path;
  }

  // Returns the index of the path.
  int AddPath(Path path) {
    plan_.paths.push_back(std::move(path));
    return static_cast<int>(plan_.paths.size()) - 1;
  }

  Plan Build() { return std::move(plan_); }

 private:
  Plan plan_;
  Rest rest_;
};

bool NoPaths(const std::vector<IslandPaths>& islands) {
  return std::all_of(islands.begin(), islands.end(), [](const IslandPaths& island) {
    return island.contours.empty() && island.rasters.empty();
  });
}

// Writes into every path which island it belongs to.
void MarkIslands(std::vector<IslandPaths>& islands, Budget* budget) {
  Rest rest(budget);
  for (size_t i = 0; i < islands.size(); ++i) {
    rest(4 + 4 * (islands[i].contours.size() + islands[i].rasters.size()));
    for (Path& path : islands[i].contours) path.island = static_cast<int>(i);
    for (Path& path : islands[i].rasters) path.island = static_cast<int>(i);
    if (!islands[i].contours.empty()) islands[i].contours.front().outer = true;
  }
}

}  // namespace

const char* CoordinateFault(double coordinate) {
  if (!std::isfinite(coordinate)) return "not finite";
  static_assert(kMaxCoordinateMm == 1e6);
  if (std::abs(coordinate) > kMaxCoordinateMm) return "beyond +-1e6 mm";
  return nullptr;
}

absl::Status CheckPlan(const Plan& plan, Budget* budget) {
  Rest rest(budget);
  for (size_t p = 0; p < plan.paths.size(); ++p) {
    rest(4);
    if (absl::Status status = CheckPath(plan.paths[p], p, rest); !status.ok()) return status;
  }
  return TreeCheck(plan, rest).Run();
}

Plan SequentialPlan(std::vector<IslandPaths> islands, Budget* budget) {
  if (NoPaths(islands)) return Plan{};
  MarkIslands(islands, budget);
  PlanBuilder builder(islands, budget);
  const int root = builder.AddNode(PlanNode::Kind::kInOrder, -1);
  const int contours = builder.AddNode(PlanNode::Kind::kAnyOrder, root);
  const int rasters = builder.AddNode(PlanNode::Kind::kAnyOrder, root);
  for (IslandPaths& island : islands) {
    for (Path& path : island.contours) builder.AddLeaf(builder.AddPath(std::move(path)), contours);
    for (Path& path : island.rasters) builder.AddLeaf(builder.AddPath(std::move(path)), rasters);
  }
  return builder.Build();
}

Plan InterleavedPlan(std::vector<IslandPaths> islands, Budget* budget) {
  if (NoPaths(islands)) return Plan{};
  MarkIslands(islands, budget);
  PlanBuilder builder(islands, budget);
  const int root = builder.AddNode(PlanNode::Kind::kAnyOrder, -1);
  for (IslandPaths& island : islands) {
    if (island.contours.empty() && island.rasters.empty()) continue;
    const int node = builder.AddNode(PlanNode::Kind::kInOrder, root);
    int inner = -1;
    for (size_t c = 0; c < island.contours.size(); ++c) {
      if (c == 1) inner = builder.AddNode(PlanNode::Kind::kAnyOrder, node);
      builder.AddLeaf(builder.AddPath(std::move(island.contours[c])), c == 0 ? node : inner);
    }
    if (island.rasters.empty()) continue;
    const int rasters = builder.AddNode(PlanNode::Kind::kAnyOrder, node);
    for (Path& path : island.rasters) builder.AddLeaf(builder.AddPath(std::move(path)), rasters);
  }
  return builder.Build();
}

}  // namespace traverse
