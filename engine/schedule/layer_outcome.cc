#include "engine/schedule/layer_outcome.h"

#include <cassert>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "engine/base/rest.h"
#include "engine/cost/link_cost.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/travel_cost.h"
#include "engine/cost/wall_cost.h"
#include "engine/validator.h"

namespace traverse {
namespace {

// The totals of the moves of `route`, without the one to the cleaning point.
struct Moves {
  MoveCounts counts;
  std::vector<Detour> detours;
};

Moves MovesOf(const LayerProblem& problem, const Route& route, Budget& budget) {
  Rest rest(&budget);
  Moves moves;
  if (problem.cost.kind == CostSpec::Kind::kLength) return moves;
  const LinkCost cost(problem);
  LinkCost::Left left = cost.Before();
  for (size_t i = 0; i < route.size(); ++i) {
    rest(4);
    if (problem.walls != nullptr && budget.Exhausted()) break;
    WallMove move = cost.MoveTo(left, route[i]);
    moves.counts.crossings += move.crosses ? 1 : 0;
    moves.counts.retractions += move.retracts && problem.cost.retraction_seconds > 0 ? 1 : 0;
    if (!move.via.empty()) moves.detours.push_back({i, std::move(move.via)});
    left = cost.After(route[i]);
  }
  return moves;
}

double MoveMm(Point from, const std::optional<Point>& to) { return to ? Distance(from, *to) : 0; }

}  // namespace

void TellGiven(const LayerProblem& problem, const Route& given, Budget& turns,
               LayerOutcome& outcome) {
  const Plan& plan = *problem.plan;
  LayerProblem open_ended = problem;
  open_ended.finish.reset();
  outcome.given = MeasureTravel(plan, problem.start, given, &turns, problem.links);
  outcome.cost_given = RouteCost(open_ended, given, &turns);
  outcome.moves_given = MovesOf(open_ended, given, turns).counts;
  outcome.cleaning_given_mm = MoveMm(*DepartureAfter(problem, given).from, problem.finish);
}

void TellFound(const LayerProblem& problem, Solution solution, JobLayer& layer, Budget& turns,
               LayerOutcome& outcome) {
  assert(problem.plan == &layer.plan && solution.route.size() == layer.plan.paths.size());
  const Plan& plan = layer.plan;
  outcome.start = problem.start;
  const Departure last = DepartureAfter(problem, solution.route);
  outcome.end = *last.from;
  outcome.departure = last.seconds;
  outcome.travel = MeasureTravel(plan, problem.start, solution.route, &turns, problem.links);
  outcome.cleaning_mm = MoveMm(outcome.end, problem.finish);
  const double finish_cost = problem.finish ? TravelCost(problem)(outcome.end, *problem.finish) : 0;
  outcome.cost = RouteCost(problem, solution.route, &turns) - finish_cost;
  Moves moves = MovesOf(problem, solution.route, turns);
  outcome.moves = moves.counts;
  outcome.detours = std::move(moves.detours);
  if (solution.lower_bound) outcome.lower_bound = *solution.lower_bound - finish_cost;
  const bool is_time = problem.cost.kind == CostSpec::Kind::kTime;
  const bool is_checked = problem.walls != nullptr || (problem.links != nullptr && is_time);
  if (is_checked && outcome.invalid_route.empty()) {
    const MoveClaims claims{outcome.cost, outcome.moves, outcome.detours};
    const absl::Status same =
        ValidateMoves(plan, layer.walls, problem.cost, problem.start, solution.route, claims,
                      &turns, problem.links, problem.before.seconds);
    if (!same.ok()) outcome.invalid_route = std::string(same.message());
  }
  outcome.stop = solution.stop;
  outcome.statistics = std::move(solution.statistics);
  outcome.route = std::move(solution.route);
  outcome.plan = std::move(layer.plan);
}

}  // namespace traverse
