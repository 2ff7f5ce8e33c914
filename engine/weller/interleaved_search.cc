#include "engine/weller/interleaved_search.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "engine/cost/route_cost.h"
#include "engine/model/sub_plan.h"
#include "engine/weller/step_problem.h"
#include "engine/weller/steps/neighborhood.h"
#include "engine/weller/steps/point_reduction.h"
#include "engine/weller/tabu/tabu_method.h"

namespace traverse {
namespace {

void AddTo(FrameworkResult& sum, const FrameworkResult& part) {
  sum.points.entries += part.points.entries;
  sum.points.island_analysis += part.points.island_analysis;
  sum.points.spaced += part.points.spaced;
  sum.points.near_raster += part.points.near_raster;
  sum.points.box_center += part.points.box_center;
  sum.points.visible += part.points.visible;
  sum.penalized_contour_links += part.penalized_contour_links;
  sum.penalized_raster_links += part.penalized_raster_links;
  for (int step = 0; step < 3; ++step) sum.step_seconds[step] += part.step_seconds[step];
}

// What stands for an island among others: its outer contour, or its first; the ends of its rasters
// where it has none.
Path Representative(const SubPlan& island) {
  std::vector<Point> ends;
  for (const Path& path : island.plan.paths) {
    if (path.kind == Path::Kind::kContour) return path;
    ends.insert(ends.end(), path.points.begin(), path.points.end());
  }
  return MakeContour(std::move(ends));
}

// The contours of an island, then its rasters, each in any order.
SubPlan AsSequentialIsland(const SubPlan& island) {
  SubPlan sequential;
  sequential.plan.nodes.push_back(PlanNode{PlanNode::Kind::kInOrder, 0, {}, {}});
  for (const Path::Kind kind : {Path::Kind::kContour, Path::Kind::kOpen}) {
    const size_t parent = sequential.plan.nodes.size();
    sequential.plan.nodes.front().children.push_back(static_cast<int>(parent));
    sequential.plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
    for (size_t p = 0; p < island.plan.paths.size(); ++p) {
      if (island.plan.paths[p].kind != kind) continue;
      sequential.plan.nodes[parent].children.push_back(
          static_cast<int>(sequential.plan.nodes.size()));
      sequential.plan.nodes.push_back(
          PlanNode{PlanNode::Kind::kPath, static_cast<int>(sequential.path_of.size()), {}, {}});
      sequential.path_of.push_back(island.path_of[p]);
      sequential.plan.paths.push_back(island.plan.paths[p]);
      sequential.plan.paths.back().island = 0;  // one island, whatever the plan knew
    }
  }
  return sequential;
}

class InterleavedSearch {
 public:
  InterleavedSearch(const LayerProblem& problem, const InterleavedLayer& layer,
                    const FrameworkOptions& options, SequenceMethod& method, Budget& budget)
      : problem_(problem), options_(options), method_(method), budget_(budget) {
    for (const int node : layer.islands) islands_.push_back(PlanBelow(*problem.plan, node));
  }

  FrameworkResult Run() {
    const std::vector<size_t> order = ArrangeIslands();
    for (size_t k = 0; k < order.size(); ++k) Append(islands_[order[k]], k + 1 == order.size());
    return std::move(result_);
  }

 private:
  std::vector<size_t> ArrangeIslands() {
    const Stopwatch watch;
    Plan reduced;
    std::vector<CircledContour> circles;
    for (const SubPlan& island : islands_) {
      const Path outer = Representative(island);
      circles.push_back(CircleOf(outer, options_.spacing_mm));
      Plan alone;
      alone.paths = island.plan.paths;
      alone.paths.push_back(outer);
      for (Path& path : alone.paths) path.island = 0;
      reduced.paths.push_back(MakeContour(
          RepresentativePoints(alone, IslandsOf(alone), static_cast<int>(island.plan.paths.size()),
                               options_.representation, options_.spacing_mm)));
    }
    ArrangeFreely(reduced);
    Neighborhood neighborhood =
        GrowCircles(circles, problem_.start, options_.neighborhood, budget_);
    LinkClusters(circles, problem_.start, neighborhood, budget_);
    LinkRules rules;
    for (int node = 0; node < static_cast<int>(circles.size()); ++node) {
      rules.node_of.push_back(node);
    }
    rules.start_node = static_cast<int>(circles.size());
    rules.linked = &neighborhood;
    rules.penalty_mm = options_.neighbor_penalty_mm;
    const LayerProblem sub = StepProblem(problem_, reduced, 2);
    const TabuElite best =
        std::move(method_.ArrangeContours(sub, rules, GivenRoute(reduced), budget_).front());
    result_.penalized_contour_links = best.penalized;
    result_.step_seconds[0] = watch.Seconds();
    std::vector<size_t> order;
    for (const Visit& visit : best.route) order.push_back(static_cast<size_t>(visit.path));
    return order;
  }

  void Append(const SubPlan& island, bool is_last) {
    const SubPlan part = AsSequentialIsland(island);
    LayerProblem sub = StepProblem(problem_, part.plan, 16 + islands_done_++);
    sub.start = RouteEnd(*problem_.plan, result_.route, problem_.start);
    if (is_last) sub.finish = problem_.finish;
    const FrameworkResult found = SearchFramework(
        sub, *AsClassicalLayer(part.plan), GivenRoute(part.plan), options_, method_, budget_);
    AppendRoute(part, found.route, result_.route);
    AddTo(result_, found);
  }

  const LayerProblem& problem_;
  const FrameworkOptions& options_;
  SequenceMethod& method_;
  Budget& budget_;
  std::vector<SubPlan> islands_;
  uint64_t islands_done_ = 0;
  FrameworkResult result_;
};

bool IsIsland(const Plan& plan, int index) {
  const PlanNode& node = plan.nodes[static_cast<size_t>(index)];
  if (node.kind != PlanNode::Kind::kInOrder || node.children.empty()) return false;
  const auto kind_of = [&](int leaf) {
    return plan.paths[static_cast<size_t>(plan.nodes[static_cast<size_t>(leaf)].path)].kind;
  };
  const auto is_leaf = [&](int child) {
    return plan.nodes[static_cast<size_t>(child)].kind == PlanNode::Kind::kPath;
  };
  int outer = 0;
  bool rasters = false;
  for (const int child : node.children) {
    const PlanNode& below = plan.nodes[static_cast<size_t>(child)];
    if (is_leaf(child)) {
      if (child != node.children.front() || kind_of(child) != Path::Kind::kContour) return false;
      if (!plan.paths[static_cast<size_t>(below.path)].outer) return false;
      ++outer;
      continue;
    }
    if (below.kind != PlanNode::Kind::kAnyOrder || !below.before.empty()) return false;
    for (const int leaf : below.children) {
      if (!is_leaf(leaf)) return false;
      const bool is_raster = kind_of(leaf) == Path::Kind::kOpen;
      // Inner contours without an outer one, or contours behind rasters.
      if (!is_raster && (outer == 0 || rasters)) return false;
      rasters = rasters || is_raster;
    }
  }
  return true;
}

}  // namespace

std::optional<InterleavedLayer> AsInterleavedLayer(const Plan& plan) {
  if (plan.paths.empty()) return std::nullopt;
  const PlanNode& root = plan.nodes.front();
  if (root.kind != PlanNode::Kind::kAnyOrder || !root.before.empty()) return std::nullopt;
  InterleavedLayer layer;
  for (const int child : root.children) {
    const PlanNode& node = plan.nodes[static_cast<size_t>(child)];
    if (node.kind != PlanNode::Kind::kPath && node.children.empty()) continue;
    if (!IsIsland(plan, child)) return std::nullopt;
    layer.islands.push_back(child);
  }
  return layer;
}

FrameworkResult SearchInterleaved(const LayerProblem& problem, const InterleavedLayer& layer,
                                  const FrameworkOptions& options, SequenceMethod& method,
                                  Budget& budget) {
  return InterleavedSearch(problem, layer, options, method, budget).Run();
}

FrameworkResult SearchInterleaved(const LayerProblem& problem, const InterleavedLayer& layer,
                                  const FrameworkOptions& options, Budget& budget) {
  TabuMethod method(options.tabu);
  FrameworkResult result = SearchInterleaved(problem, layer, options, method, budget);
  result.diversifications = method.diversifications();
  result.evaluations = method.evaluations();
  return result;
}

}  // namespace traverse
