#include "tests/support/problems/random_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace traverse::testing {
namespace {

constexpr double kSizeMm = 100;

bool OneIn(Rng& rng, uint32_t n) { return rng.Below(n) == 0; }

Point RandomPoint(Rng& rng, bool on_grid) {
  const Point p{rng.Unit() * kSizeMm, rng.Unit() * kSizeMm};
  return on_grid ? Point{std::round(p.x / 10) * 10, std::round(p.y / 10) * 10} : p;
}

std::vector<int> Shuffled(Rng& rng, int n) {
  std::vector<int> order(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) order[static_cast<size_t>(i)] = i;
  for (int i = n - 1; i > 0; --i) {
    std::swap(order[static_cast<size_t>(i)], order[static_cast<size_t>(rng.Between(0, i))]);
  }
  return order;
}

std::vector<int> RandomEntries(Rng& rng, int vertices) {
  std::vector<int> entries = Shuffled(rng, vertices);
  entries.resize(static_cast<size_t>(rng.Between(1, vertices)));
  return entries;
}

// Pairs that agree with one random order of the children, so there is no cycle; that order need not
// be the one of the children.
std::vector<std::pair<int, int>> RandomBefore(Rng& rng, int children) {
  std::vector<std::pair<int, int>> before;
  if (children < 2) return before;
  const std::vector<int> order = Shuffled(rng, children);
  const int pairs = rng.Between(1, children);
  for (int k = 0; k < pairs; ++k) {
    const int i = rng.Between(0, children - 2);
    const int j = rng.Between(i + 1, children - 1);
    before.emplace_back(order[static_cast<size_t>(i)], order[static_cast<size_t>(j)]);
  }
  return before;
}

std::vector<IslandPaths> RandomIslands(Rng& rng, int paths, const RandomPlanOptions& options) {
  std::vector<IslandPaths> islands;
  while (paths > 0) {
    IslandPaths& island = islands.emplace_back();
    const int size = rng.Between(1, std::min(paths, 5));
    for (int i = 0; i < size; ++i) {
      if (OneIn(rng, 2)) {
        island.contours.push_back(RandomContour(rng, options));
      } else {
        island.rasters.push_back(RandomOpenPath(rng, options));
      }
    }
    paths -= size;
  }
  return islands;
}

// Grows a tree downwards, so that children come after their parents.
class TreeGrower {
 public:
  TreeGrower(Rng& rng, const RandomPlanOptions& options) : rng_(rng), options_(options) {}

  Plan Grow(int paths) {
    if (paths > 0 || OneIn(rng_, 2)) AddComposite(-1, paths, 0);
    return std::move(plan_);
  }

 private:
  int AddNode(PlanNode::Kind kind, int parent) {
    const int index = static_cast<int>(plan_.nodes.size());
    plan_.nodes.push_back(PlanNode{kind, 0, {}, {}});
    if (parent >= 0) plan_.nodes[static_cast<size_t>(parent)].children.push_back(index);
    return index;
  }

  void AddLeaf(int parent) {
    const int node = AddNode(PlanNode::Kind::kPath, parent);
    plan_.nodes[static_cast<size_t>(node)].path = static_cast<int>(plan_.paths.size());
    plan_.paths.push_back(OneIn(rng_, 2) ? RandomContour(rng_, options_)
                                         : RandomOpenPath(rng_, options_));
  }

  void AddComposite(int parent, int paths, int depth) {
    const bool in_order = OneIn(rng_, 3);
    const int node =
        AddNode(in_order ? PlanNode::Kind::kInOrder : PlanNode::Kind::kAnyOrder, parent);
    if (paths > 0 && options_.special && OneIn(rng_, 6)) AddComposite(node, 0, depth + 1);
    while (paths > 0) {
      const int size = depth > 6 || OneIn(rng_, 2) ? 1 : rng_.Between(1, paths);
      if (size > 1 || (depth < 6 && OneIn(rng_, 8))) {
        AddComposite(node, size, depth + 1);
      } else {
        AddLeaf(node);
      }
      paths -= size;
    }
    PlanNode& added = plan_.nodes[static_cast<size_t>(node)];
    if (!in_order && OneIn(rng_, 2)) {
      added.before = RandomBefore(rng_, static_cast<int>(added.children.size()));
    }
  }

  Rng& rng_;
  const RandomPlanOptions& options_;
  Plan plan_;
};

Plan FlatPlan(Rng& rng, int paths, bool contours_only, const RandomPlanOptions& options) {
  Plan plan;
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
  for (int p = 0; p < paths; ++p) {
    plan.paths.push_back(contours_only || OneIn(rng, 2) ? RandomContour(rng, options)
                                                        : RandomOpenPath(rng, options));
    plan.nodes[0].children.push_back(p + 1);
    plan.nodes.push_back(PlanNode{PlanNode::Kind::kPath, p, {}, {}});
  }
  if (!contours_only) plan.nodes[0].before = RandomBefore(rng, paths);
  return plan;
}

Plan RandomPlan(Rng& rng, const RandomPlanOptions& options) {
  const auto any_shape = static_cast<PlanShape>(rng.Below(5));
  const int paths = rng.Between(options.min_paths, options.max_paths);
  switch (options.shape.value_or(any_shape)) {
    case PlanShape::kFlatContours:
      return FlatPlan(rng, paths, true, options);
    case PlanShape::kSequential:
      return SequentialPlan(RandomIslands(rng, paths, options));
    case PlanShape::kInterleaved:
      return InterleavedPlan(RandomIslands(rng, paths, options));
    case PlanShape::kFlatBefore:
      return FlatPlan(rng, paths, false, options);
    case PlanShape::kTree:
      break;
  }
  return TreeGrower(rng, options).Grow(paths);
}

}  // namespace

Path RandomContour(Rng& rng, const RandomPlanOptions& options) {
  const bool on_grid = options.special && OneIn(rng, 4);
  const Point center = RandomPoint(rng, on_grid);
  const double radius = on_grid ? 10 : 0.5 + rng.Unit() * 12;
  const int vertices = options.special && OneIn(rng, 8) ? 1 : rng.Between(1, options.max_vertices);
  std::vector<Point> points;
  for (int v = 0; v < vertices; ++v) {
    const double angle = 2 * std::numbers::pi * (v + rng.Unit() * 0.5) / vertices;
    Point point{center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)};
    if (on_grid) point = {std::round(point.x / 10) * 10, std::round(point.y / 10) * 10};
    if (options.special && !points.empty() && OneIn(rng, 10)) point = points.front();
    points.push_back(point);
  }
  Path path = MakeContour(std::move(points));
  if (options.special && OneIn(rng, 5)) path.allowed = RandomEntries(rng, vertices);
  return path;
}

Path RandomOpenPath(Rng& rng, const RandomPlanOptions& options) {
  const bool on_grid = options.special && OneIn(rng, 4);
  const Point first = RandomPoint(rng, on_grid);
  const bool zero_length = options.special && OneIn(rng, 10);
  const Point last = zero_length ? first : RandomPoint(rng, on_grid);
  return MakeOpenPath(first, last, options.special && OneIn(rng, 4));
}

CostSpec RandomCost(Rng& rng) {
  CostSpec cost;
  if (OneIn(rng, 2)) return cost;
  cost.kind = CostSpec::Kind::kTime;
  cost.speed_mm_s = 20 + rng.Unit() * 180;
  if (OneIn(rng, 2)) cost.accel_mm_s2 = 500 + rng.Unit() * 3000;
  if (OneIn(rng, 2)) {
    cost.retraction_seconds = rng.Unit();
    cost.retraction_threshold_mm = rng.Unit() * 20;
  }
  return cost;
}

Plan RandomPlan(uint64_t seed, const RandomPlanOptions& options) {
  Rng rng(seed);
  return RandomPlan(rng, options);
}

OwnedProblem RandomProblem(uint64_t seed, const RandomPlanOptions& options) {
  Rng rng(seed);
  Plan plan = RandomPlan(rng, options);
  OwnedProblem owned(std::move(plan), RandomPoint(rng, false));
  if (OneIn(rng, 3)) owned.problem.finish = RandomPoint(rng, false);
  owned.problem.cost = RandomCost(rng);
  owned.problem.seed = seed;
  return owned;
}

OwnedProblem Degenerate(const OwnedProblem& owned, Degeneracy degeneracy) {
  const auto moved = [degeneracy](Point point) -> Point {
    if (degeneracy == Degeneracy::kCoincident) return {7.3, -2.1};
    if (degeneracy == Degeneracy::kCollinear) return {point.x, 0.1 * point.x};
    if (degeneracy == Degeneracy::kCoarseGrid) {
      return {50 * std::round(point.x / 50), 50 * std::round(point.y / 50)};
    }
    return point;
  };
  Plan plan = owned.plan();
  std::optional<size_t> first_of_kind[2];
  for (size_t p = 0; p < plan.paths.size(); ++p) {
    Path& path = plan.paths[p];
    for (Point& point : path.points) point = moved(point);
    const bool open = path.kind == Path::Kind::kOpen;
    if (degeneracy == Degeneracy::kZeroLength && open) path.points[1] = path.points[0];
    std::optional<size_t>& first = first_of_kind[open ? 1 : 0];
    if (!first) first = p;
    if (degeneracy == Degeneracy::kDuplicates) path = plan.paths[*first];
  }
  OwnedProblem result(std::move(plan), moved(owned.problem.start));
  result.problem.finish = owned.problem.finish;
  if (result.problem.finish) result.problem.finish = moved(*owned.problem.finish);
  result.problem.cost = owned.problem.cost;
  result.problem.seed = owned.problem.seed;
  return result;
}

}  // namespace traverse::testing
