#include "engine/strategy/framework_milp.h"

#include <chrono>
#include <utility>

#include "engine/cost/route_cost.h"
#include "engine/exact/raster_milp.h"
#include "engine/strategy/ni2opt.h"

namespace traverse {
namespace {

// Of the time left, what step 2 may use.
constexpr double kContourShare = 0.5;

Budget::Clock::duration Seconds(double seconds) {
  return std::chrono::duration_cast<Budget::Clock::duration>(
      std::chrono::duration<double>(seconds));
}

}  // namespace

MilpMethod::MilpMethod(const MilpOptions& options, double time_limit_seconds)
    : options_(options),
      time_limit_seconds_(time_limit_seconds),
      heuristic_(Ni2optEntry().make(*StrategyOptions::Parse(Ni2optEntry().options, {}))) {}

Budget MilpMethod::StepBudget(const Budget& budget, double share) const {
  const Budget limited = budget.Within(Seconds(time_limit_seconds_));
  if (!budget.deadline()) return limited;
  const std::chrono::duration<double> left = *budget.deadline() - Budget::Clock::now();
  return limited.Within(Seconds(left.count() * share));
}

std::vector<TabuElite> MilpMethod::Finish(const LayerProblem& problem, const MilpRoute& found,
                                          const Route& first, const Budget& step) {
  if (step.was_exhausted()) timed_out_ = true;
  const Route& route = found.route.empty() ? first : found.route;
  return {TabuElite{route, RouteCost(problem, route), 0}};
}

std::vector<TabuElite> MilpMethod::ArrangeContours(const LayerProblem& problem,
                                                   const LinkRules& rules, const Route&,
                                                   Budget& budget) {
  const Route first = heuristic_->Solve(problem, budget).route;
  Budget step = StepBudget(budget, kContourShare);
  contours_ = SolveContourMilp(problem, *rules.linked, first, options_, step);
  return Finish(problem, contours_, first, step);
}

std::vector<TabuElite> MilpMethod::ArrangeRasters(const LayerProblem& problem,
                                                  const LinkRules& rules, const Route&,
                                                  Budget& budget) {
  const Route first = heuristic_->Solve(problem, budget).route;
  Budget step = StepBudget(budget, 1);
  const RasterGroups groups{rules.node_of, rules.start_node, rules.linked};
  rasters_ = SolveRasterMilp(problem, groups, first, options_, step);
  return Finish(problem, rasters_, first, step);
}

}  // namespace traverse
