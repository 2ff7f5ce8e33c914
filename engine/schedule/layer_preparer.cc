#include "engine/schedule/layer_preparer.h"

#include <optional>
#include <utility>

#include "engine/cost/link_cost.h"
#include "engine/cost/route_cost.h"
#include "engine/schedule/layer_outcome.h"

namespace traverse {

void LayerPreparer::Prepare(ChainLayer& layer) {
  const Plan& plan = layer.given.plan;
  Budget turns = solver_.Turns();
  if (layer.given.start) {
    given_at_ = greedy_at_ = predicted_at_ = *layer.given.start;
    given_left_ = {};
  }
  layer.predicted_start = predicted_at_;

  if (layer.cost.kind == CostSpec::Kind::kTime && !layer.given.walls.empty()) {
    const CostSpec& cost = solver_.TrueCost(layer);
    auto given = std::make_unique<const WallCost>(layer.given.walls, plan, cost, &turns);
    if (layer.given.links.empty()) {
      layer.walls = std::move(given);
    } else {
      layer.linked_walls = std::move(given);
      const LayerWalls walls = SymmetricWalls(
          layer.given.walls, layer.cost.retraction_seconds - cost.retraction_seconds);
      layer.walls = std::make_unique<const WallCost>(walls, plan, layer.cost, &turns);
    }
  }
  layer.origin = PlanOrigin(plan);
  if (!solver_.traits().serial) {
    layer.fingerprint = FingerprintOf(plan, layer.cost, layer.given.walls, &turns);
    layer.key =
        ProblemKey(layer.fingerprint.shape, layer.origin, layer.predicted_start, layer.finish);
  }
  // What is learned comes from layers that looked ahead: one layer after the other would find
  // other routes from here on.
  learned_ = learned_ || history_.EndOf(layer.fingerprint.shape, layer.key).has_value();
  layer.carries_alone = !learned_ && (layer.looks_ahead || layer.looked_at);
  if (solver_.traits().reuses_routes) {
    if (!anchored_ || solver_.FixedStart(layer)) anchored_ = std::make_shared<AnchoredRoutes>();
    layer.anchored = anchored_;
  }

  turns.ExhaustedNow();
  layer.given_route = GivenRoute(plan, &turns);
  layer.outcome.index = layer.index;
  if (turns.ExhaustedNow()) return;  // it was cancelled: nobody will look
  TellGivenOf(layer, turns);
  if (solver_.MayBeCutShort()) {
    layer.greedy = FollowGreedy(layer);
    greedy_at_ = layer.greedy->end;
  }
  layer.resumes_initial =
      solver_.ResumesInitial(solver_.Problem(layer, layer.predicted_start), layer);
  if (!solver_.traits().serial) predicted_at_ = PredictEnd(layer);
}

void LayerPreparer::TellGivenOf(ChainLayer& layer, Budget& turns) {
  const LayerProblem problem = LayerSolver::IsLinked(layer, given_left_)
                                   ? solver_.LinkedProblem(layer, {given_at_, given_left_})
                                   : solver_.Problem(layer, given_at_);
  TellGiven(problem, layer.given_route, turns, layer.outcome);
  const Departure last = DepartureAfter(problem, layer.given_route);
  given_at_ = layer.finish.value_or(*last.from);
  given_left_ = layer.finish ? LinkSeconds() : last.seconds;
}

GreedyLayer LayerPreparer::FollowGreedy(const ChainLayer& layer) const {
  const LayerProblem problem = solver_.Problem(layer, greedy_at_);
  GreedyLayer greedy{greedy_at_, solver_.GreedyRoute(problem, layer)};
  greedy.end = layer.finish.value_or(RouteEnd(layer.given.plan, greedy.route, greedy_at_));
  greedy.cost = RouteCost(problem, greedy.route);
  return greedy;
}

Point LayerPreparer::PredictEnd(const ChainLayer& layer) const {
  if (layer.finish) return *layer.finish;
  if (const std::optional<Point> end = history_.EndOf(layer.fingerprint.shape, layer.key)) {
    return {layer.origin.x + end->x, layer.origin.y + end->y};
  }
  if (layer.resumes_initial)
    return RouteEnd(layer.given.plan, layer.given.initial_route, layer.predicted_start);
  if (layer.greedy && layer.greedy->start == layer.predicted_start) return layer.greedy->end;
  if (solver_.Expired(layer)) return layer.predicted_start;
  const Route greedy = solver_.GreedyRoute(solver_.Problem(layer, layer.predicted_start), layer);
  return RouteEnd(layer.given.plan, greedy, layer.predicted_start);
}

}  // namespace traverse
