#include "engine/weller/milp/milp_method.h"

#include <chrono>
#include <utility>

#include "engine/cost/route_cost.h"
#include "engine/weller/milp/raster_milp.h"

namespace traverse {
namespace {

// Of the time left, what step 2 may use.
constexpr double kContourShare = 0.5;

Budget::Clock::duration Seconds(double seconds) {
  return std::chrono::duration_cast<Budget::Clock::duration>(
      std::chrono::duration<double>(seconds));
}

}  // namespace

MilpMethod::MilpMethod(const MilpOptions& options, double time_limit_seconds, FirstRoute first)
    : options_(options), time_limit_seconds_(time_limit_seconds), first_(std::move(first)) {}

Budget MilpMethod::StepBudget(const Budget& budget, double share) const {
  return budget.WithShare(share).Within(Seconds(time_limit_seconds_));
}

std::vector<TabuElite> MilpMethod::Finish(const LayerProblem& problem, MilpRoute found,
                                          const Route& start, const Budget& step,
                                          std::vector<MilpRoute>& programmes) {
  if (step.was_exhausted()) timed_out_ = true;
  const Route& route = found.route.empty() ? start : found.route;
  std::vector<TabuElite> sequences = {TabuElite{route, RouteCost(problem, route), 0}};
  programmes.push_back(std::move(found));
  return sequences;
}

std::vector<TabuElite> MilpMethod::ArrangeContours(const LayerProblem& problem,
                                                   const LinkRules& rules, const Route& start,
                                                   Budget& budget) {
  const Route first = first_ ? first_(problem, budget) : Route();
  Budget step = StepBudget(budget, kContourShare);
  MilpRoute found = SolveContourMilp(problem, *rules.linked, first, options_, step);
  return Finish(problem, std::move(found), first_ ? first : start, step, contours_);
}

std::vector<TabuElite> MilpMethod::ArrangeRasters(const LayerProblem& problem,
                                                  const LinkRules& rules, const Route& start,
                                                  Budget& budget) {
  const Route first = first_ ? first_(problem, budget) : Route();
  Budget step = StepBudget(budget, 1);
  const RasterGroups groups{rules.node_of, rules.start_node, rules.linked};
  MilpRoute found = SolveRasterMilp(problem, groups, first, options_, step);
  return Finish(problem, std::move(found), first_ ? first : start, step, rasters_);
}

}  // namespace traverse
