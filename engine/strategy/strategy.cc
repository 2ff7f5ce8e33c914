#include "engine/strategy/strategy.h"

#include <cassert>
#include <utility>

#include "engine/cost/route_cost.h"

namespace traverse {
namespace {

// Of a strategy that keeps nothing.
class Unprepared : public PreparedLayer {
 public:
  Unprepared(const Strategy& strategy, const Plan& plan) : strategy_(strategy), plan_(plan) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) override {
    assert(problem.plan == &plan_);
    return strategy_.Solve(problem, budget);
  }

  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) override {
    assert(problem.plan == &plan_);
    return strategy_.Resume(problem, start, budget);
  }

  Solution ResumeWithNext(const LayerProblem& problem, const Route& start,
                          std::vector<NextLayer>& next, Budget& budget) override {
    assert(problem.plan == &plan_);
    return strategy_.ResumeWithNext(problem, start, next, budget);
  }

 private:
  const Strategy& strategy_;
  [[maybe_unused]] const Plan& plan_;
};

}  // namespace

Solution Strategy::Resume(const LayerProblem& problem, const Route& start, Budget& budget) const {
  Solution solution = Solve(problem, budget);
  if (RouteCost(problem, start) < RouteCost(problem, solution.route)) solution.route = start;
  return solution;
}

Solution Strategy::ResumeWithNext(const LayerProblem& problem, const Route& start,
                                  [[maybe_unused]] std::vector<NextLayer>& next,
                                  Budget& budget) const {
  assert(!next.empty() && problem.cost == next.front().problem.cost && !problem.finish);
  return Resume(problem, start, budget);
}

std::unique_ptr<PreparedLayer> Strategy::Prepare(const Plan& plan) const {
  return std::make_unique<Unprepared>(*this, plan);
}

Solution PreparingStrategy::Solve(const LayerProblem& problem, Budget& budget) const {
  return Prepare(*problem.plan)->Solve(problem, budget);
}

Solution PreparingStrategy::Resume(const LayerProblem& problem, const Route& start,
                                   Budget& budget) const {
  return Prepare(*problem.plan)->Resume(problem, start, budget);
}

Solution PreparingStrategy::ResumeWithNext(const LayerProblem& problem, const Route& start,
                                           std::vector<NextLayer>& next, Budget& budget) const {
  return Prepare(*problem.plan)->ResumeWithNext(problem, start, next, budget);
}

}  // namespace traverse
