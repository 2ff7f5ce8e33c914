#include "engine/souza/published.h"

#include <optional>
#include <vector>

#include "engine/cost/route_cost.h"
#include "engine/model/sub_plan.h"
#include "engine/souza/descent.h"
#include "engine/souza/nearest_insertion.h"
#include "engine/souza/point_release.h"
#include "engine/souza/search_route.h"

namespace traverse {

Route PublishedRoute(const LayerView& layer, bool point_release, Budget& budget) {
  const LayerProblem& problem = layer.problem;
  Route route;
  const std::vector<SubPlan> stages = StagesOf(*problem.plan);
  for (const SubPlan& stage : stages) {
    LayerProblem part;
    part.plan = &stage.plan;
    part.start = RouteEnd(*problem.plan, route, problem.start);
    part.cost = problem.cost;
    part.walls = problem.walls;
    part.walls_unit = problem.walls_unit;
    if (&stage == &stages.back()) part.finish = problem.finish;
    const LayerView view(part);
    const std::optional<Route> inserted = NearestInsertionRoute(view, budget);
    if (!inserted) return GivenRoute(*problem.plan);
    DescentOptions two_opt;
    two_opt.point_release = false;
    AppendRoute(stage, Improve(view, *inserted, two_opt, budget), route);
  }
  if (!point_release) return route;
  SearchRoute search(layer, route, &budget);
  ReleasePoints(search, Released::kAll, budget);
  return search.ToRoute();
}

}  // namespace traverse
