#include "engine/weller/framework_search.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/rest.h"
#include "engine/base/rng.h"
#include "engine/cost/entry_choice.h"
#include "engine/cost/entry_table.h"
#include "engine/cost/route_cost.h"
#include "engine/weller/step_problem.h"
#include "engine/weller/steps/raster_route.h"
#include "engine/weller/tabu/path_relinking.h"
#include "engine/weller/tabu/point_relinking.h"
#include "engine/weller/tabu/tabu_method.h"

namespace traverse {
namespace {

// `paths` in the order in which `route` has them.
std::vector<int> InOrderOf(const Route& route, const std::vector<int>& paths) {
  std::vector<bool> wanted(route.size());
  for (const int path : paths) wanted[static_cast<size_t>(path)] = true;
  std::vector<int> sorted;
  for (const Visit& visit : route) {
    if (wanted[static_cast<size_t>(visit.path)]) sorted.push_back(visit.path);
  }
  return sorted;
}

// Whether what is left of the framework would take too long: once it was cancelled, or its time is
// over and the steps to a feasible route are many.
bool GivesUp(const Plan& plan, Budget& budget) {
  constexpr size_t kFewPaths = 2000;
  return budget.ExhaustedNow() && (budget.cancelled() || plan.paths.size() > kFewPaths);
}

// What the steps share.
class FrameworkSearch {
 public:
  FrameworkSearch(const LayerProblem& problem, const ClassicalLayer& layer,
                  const FrameworkOptions& options, SequenceMethod& method, Budget& budget)
      : problem_(problem),
        plan_(*problem.plan),
        options_(options),
        method_(method),
        budget_(budget),
        layout_(IslandsOf(plan_, &budget)),
        analysis_(AnalyzeIslands(layout_, layer.contours)) {
    CountPoints(layer);
  }

  FrameworkResult Run(const ClassicalLayer& layer, const Route& start) {
    analysis_.kept = InOrderOf(start, analysis_.kept);
    if (!analysis_.kept.empty() && !ArrangeContours()) {
      result_.route = start;
      return std::move(result_);
    }
    const Stopwatch watch;
    ArrangeRasters(InOrderOf(start, layer.rasters));
    result_.step_seconds[2] = watch.Seconds();
    return std::move(result_);
  }

 private:
  // Step 1, as far as it is cheap; the rest is counted where it is used.
  void CountPoints(const ClassicalLayer& layer) {
    ReductionCounts& points = result_.points;
    Rest rest(&budget_);
    for (const int contour : layer.contours) {
      const Path& path = plan_.paths[static_cast<size_t>(contour)];
      rest(16 + 4 * path.points.size());
      points.entries += static_cast<int>(EntryVertices(path).size());
      points.spaced += static_cast<int>(SpacedPoints(path, options_.spacing_mm).size());
    }
    for (const int contour : analysis_.kept) {
      const Path& path = plan_.paths[static_cast<size_t>(contour)];
      points.island_analysis += static_cast<int>(EntryVertices(path).size());
    }
    points.box_center = static_cast<int>(analysis_.kept.size());
  }

  // Steps 2 and 3: appends the contours to the route. False if the time for that is over.
  bool ArrangeContours() {
    const Stopwatch watch;
    Plan reduced;
    std::vector<CircledContour> circles;
    Rest rest(&budget_);
    for (const int contour : analysis_.kept) {
      rest(16 + 8 * plan_.paths[static_cast<size_t>(contour)].points.size());
      reduced.paths.push_back(MakeContour(RepresentativePoints(
          plan_, layout_, contour, options_.representation, options_.spacing_mm)));
      if (options_.representation == Representation::kNearRasterPoints) {
        result_.points.near_raster += static_cast<int>(reduced.paths.back().points.size());
      }
      circles.push_back(CircleOf(plan_.paths[static_cast<size_t>(contour)], options_.spacing_mm));
    }
    ArrangeFreely(reduced);
    neighborhood_ = GrowCircles(circles, problem_.start, options_.neighborhood, budget_);
    LinkClusters(circles, problem_.start, neighborhood_, budget_);
    if (GivesUp(plan_, budget_)) return false;

    LinkRules rules;
    for (int node = 0; node < static_cast<int>(circles.size()); ++node) {
      rules.node_of.push_back(node);
    }
    rules.start_node = static_cast<int>(circles.size());
    rules.linked = &neighborhood_;
    rules.penalty_mm = options_.neighbor_penalty_mm;
    const LayerProblem sub = StepProblem(problem_, reduced, 2);
    const std::vector<TabuElite> found =
        method_.ArrangeContours(sub, rules, GivenRoute(reduced), budget_);
    if (GivesUp(plan_, budget_)) return false;
    result_.penalized_contour_links = found.front().penalized;
    if (options_.trace) TraceSequence(found.front().route);
    result_.step_seconds[0] = watch.Seconds();
    MakeFeasible(sub, rules, found);
    result_.step_seconds[1] = watch.Seconds() - result_.step_seconds[0];
    return true;
  }

  // Step 3 for the elite of step 2 and for sequences on the way from the others to the best one,
  // which guides: keeps the shortest feasible route.
  void MakeFeasible(const LayerProblem& sub, const LinkRules& rules,
                    const std::vector<TabuElite>& elite) {
    double least = std::numeric_limits<double>::infinity();
    TryFeasible(*sub.plan, elite.front().route, least);
    for (size_t i = 1; i < elite.size() && !budget_.ExhaustedNow(); ++i) {
      TryFeasible(*sub.plan, elite[i].route, least);
      for (const Route& between : RelinkPaths(sub, rules, elite[i].route, elite.front().route,
                                              options_.relinked, budget_)) {
        if (budget_.ExhaustedNow()) return;
        TryFeasible(*sub.plan, between, least);
      }
    }
  }

  void TryFeasible(const Plan& reduced, const Route& preliminary, double& least) {
    std::vector<SequencedContour> sequence;
    for (const Visit& visit : preliminary) {
      const Path& path = reduced.paths[static_cast<size_t>(visit.path)];
      sequence.push_back(
          {analysis_.kept[static_cast<size_t>(visit.path)], EnterPoint(path, visit.entry)});
    }
    const TravelCost travel(problem_);
    const std::vector<int> order =
        ReinsertOuterContours(plan_, layout_, analysis_.suppressed, sequence, problem_.start,
                              travel, options_.spacing_mm);
    const auto visible = VisiblePointsAlong(plan_, order, problem_.start, options_.spacing_mm,
                                            options_.visible_in, &budget_);
    Route route =
        options_.point_relinkings > 0
            ? RelinkedPoints({&plan_, order, visible, problem_.start}, sequence, travel)
            : ChooseContourPoints(plan_, order, visible, problem_.start, travel, &budget_);
    LayerProblem contours = problem_;
    contours.finish.reset();
    const double cost = RouteCost(contours, route);
    if (cost >= least) return;
    least = cost;
    result_.route = std::move(route);
    if (options_.trace) TraceVisible(order, visible);
    result_.points.visible = 0;
    for (const auto& vertices : visible) {
      result_.points.visible += static_cast<int>(vertices.size());
    }
  }

  void TraceSequence(const Route& preliminary) {
    FrameworkTrace& trace = result_.trace;
    const int contours = static_cast<int>(analysis_.kept.size());
    const auto path_of = [&](int node) {
      return node < contours ? analysis_.kept[static_cast<size_t>(node)]
                             : static_cast<int>(plan_.paths.size());
    };
    for (int node = 0; node <= contours; ++node) {
      for (const int next : neighborhood_.of(node)) {
        if (next > node) trace.neighbors.emplace_back(path_of(node), path_of(next));
      }
    }
    for (const Visit& visit : preliminary) trace.sequence.push_back(path_of(visit.path));
  }

  void TraceVisible(const std::vector<int>& order, const std::vector<std::vector<int>>& visible) {
    result_.trace.visible.clear();
    for (size_t k = 0; k < order.size(); ++k) {
      for (const int vertex : visible[k]) result_.trace.visible.emplace_back(order[k], vertex);
    }
  }

  // Beginning with the points nearest to those of the preliminary sequence; a contour brought back
  // has none there, and takes that of the contour it stands before.
  Route RelinkedPoints(const SequencedPoints& points, const std::vector<SequencedContour>& sequence,
                       const TravelCost& travel) {
    std::vector<Point> near(points.order.size());
    size_t at = sequence.size();
    for (size_t k = points.order.size(); k-- > 0;) {
      if (at > 0 && sequence[at - 1].path == points.order[k]) --at;
      near[k] = sequence[std::min(at, sequence.size() - 1)].point;
    }
    Rng rng(StreamSeed(problem_.seed, 3));
    return RelinkPoints(points, near, travel, options_.point_relinkings, rng, budget_);
  }

  // Step 4: appends the rasters to the route.
  void ArrangeRasters(const std::vector<int>& rasters) {
    if (rasters.empty()) return;
    Plan grouped;
    LinkRules rules;
    std::vector<int> path_of;
    const std::vector<RasterGroup> groups = GroupRasters(layout_, rasters);
    grouped.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
    for (const RasterGroup& group : groups) AddGroup(group, grouped, rules, path_of);

    Neighborhood islands;
    if (!analysis_.kept.empty()) {
      islands = IslandNeighborhood(layout_, analysis_.kept, neighborhood_);
      rules.linked = &islands;
      rules.start_node = layout_.island_of[static_cast<size_t>(result_.route.back().path)];
    }
    rules.penalty_mm = options_.neighbor_penalty_mm;
    LayerProblem sub = StepProblem(problem_, grouped, 4);
    sub.start = RouteEnd(plan_, result_.route, problem_.start);
    sub.finish = problem_.finish;
    const std::vector<TabuElite> found =
        method_.ArrangeRasters(sub, rules, GivenRoute(grouped), budget_);
    result_.penalized_raster_links = found.front().penalized;
    for (const Visit& visit : found.front().route) {
      result_.route.push_back(Visit{path_of[static_cast<size_t>(visit.path)], visit.entry});
    }
  }

  void AddGroup(const RasterGroup& group, Plan& grouped, LinkRules& rules,
                std::vector<int>& path_of) const {
    size_t parent = 0;
    if (group.rasters.size() > 1) {
      parent = grouped.nodes.size();
      grouped.nodes[0].children.push_back(static_cast<int>(parent));
      grouped.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
    }
    for (const int raster : group.rasters) {
      grouped.nodes[parent].children.push_back(static_cast<int>(grouped.nodes.size()));
      grouped.nodes.push_back(
          PlanNode{PlanNode::Kind::kPath, static_cast<int>(path_of.size()), {}, {}});
      grouped.paths.push_back(plan_.paths[static_cast<size_t>(raster)]);
      path_of.push_back(raster);
      rules.node_of.push_back(group.island);
    }
  }

  const LayerProblem& problem_;
  const Plan& plan_;
  const FrameworkOptions& options_;
  SequenceMethod& method_;
  Budget& budget_;
  IslandLayout layout_;
  IslandAnalysis analysis_;
  Neighborhood neighborhood_;  // node i is analysis_.kept[i], the last one the origin
  FrameworkResult result_;
};

}  // namespace

Representation RepresentationNamed(const std::string& name) {
  if (name == "sp") return Representation::kSpacedPoints;
  return name == "nrp" ? Representation::kNearRasterPoints : Representation::kBoxCenter;
}

FrameworkResult SearchFramework(const LayerProblem& problem, const ClassicalLayer& layer,
                                const Route& start, const FrameworkOptions& options,
                                SequenceMethod& method, Budget& budget) {
  return FrameworkSearch(problem, layer, options, method, budget).Run(layer, start);
}

FrameworkResult SearchFramework(const LayerProblem& problem, const ClassicalLayer& layer,
                                const Route& start, const FrameworkOptions& options,
                                Budget& budget) {
  TabuMethod method(options.tabu);
  FrameworkResult result = SearchFramework(problem, layer, start, options, method, budget);
  result.diversifications = method.diversifications();
  result.evaluations = method.evaluations();
  return result;
}

namespace {

// The same tree, with contours of what stands for them.
Plan WithRepresentativePoints(const Plan& plan, const FrameworkOptions& options, Budget& budget) {
  const IslandLayout layout = IslandsOf(plan, &budget);
  Rest rest(&budget);
  Plan reduced;
  reduced.nodes.reserve(plan.nodes.size());
  for (const PlanNode& node : plan.nodes) {
    rest(16 + node.children.size() + node.before.size());
    reduced.nodes.push_back(node);
  }
  reduced.paths.reserve(plan.paths.size());
  for (const Path& path : plan.paths) {
    rest(64 + path.points.size());
    if (path.kind != Path::Kind::kContour) {
      reduced.paths.push_back(path);
      continue;
    }
    const int contour = static_cast<int>(reduced.paths.size());
    reduced.paths.push_back(MakeContour(
        RepresentativePoints(plan, layout, contour, options.representation, options.spacing_mm)));
  }
  return reduced;
}

}  // namespace

Route SearchAnyPlan(const LayerProblem& problem, const Route& start,
                    const FrameworkOptions& options, Budget& budget) {
  const Plan& plan = *problem.plan;
  if (plan.paths.empty()) return {};
  if (GivesUp(plan, budget)) return start;
  Rest rest(&budget);
  const Plan reduced = WithRepresentativePoints(plan, options, budget);
  if (GivesUp(plan, budget)) return start;
  Route reduced_start = start;
  for (Visit& visit : reduced_start) {
    rest(8);
    visit.entry = GivenEntry(reduced.paths[static_cast<size_t>(visit.path)]);
  }
  LayerProblem sub = StepProblem(problem, reduced, 2);
  sub.finish = problem.finish;
  LinkRules rules;
  rules.node_of.assign(plan.paths.size(), 0);
  const TabuResult found = TabuSearch(sub, rules, reduced_start, options.tabu, budget);
  if (found.elite.empty() || GivesUp(plan, budget)) return start;

  std::vector<int> order;
  for (const Visit& visit : found.elite.front().route) order.push_back(visit.path);
  const EntryTable table(plan, &budget);
  std::vector<int> entries(order.size());
  EntryChoice(table, TravelCost(problem), &budget)
      .Choose(problem.start, order, problem.finish, absl::MakeSpan(entries));
  Route route;
  for (const int entry : entries) route.push_back(table.VisitOf(entry));
  return route;
}

}  // namespace traverse
