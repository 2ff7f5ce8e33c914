// A problem together with the plan it points to.

#ifndef TRAVERSE_TESTS_SUPPORT_PROBLEMS_OWNED_PROBLEM_H_
#define TRAVERSE_TESTS_SUPPORT_PROBLEMS_OWNED_PROBLEM_H_

#include <memory>
#include <utility>

#include "engine/model/layer_problem.h"

namespace traverse::testing {

// Movable; `problem.plan` stays valid.
class OwnedProblem {
 public:
  explicit OwnedProblem(Plan plan, Point start = {})
      : plan_(std::make_unique<const Plan>(std::move(plan))) {
    problem.plan = plan_.get();
    problem.start = start;
  }

  const Plan& plan() const { return *plan_; }

  LayerProblem problem;

 private:
  std::unique_ptr<const Plan> plan_;
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_PROBLEMS_OWNED_PROBLEM_H_
