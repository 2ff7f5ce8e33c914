// The problems that the steps of the framework solve, on plans of their own.

#ifndef TRAVERSE_ENGINE_WELLER_STEP_PROBLEM_H_
#define TRAVERSE_ENGINE_WELLER_STEP_PROBLEM_H_

#include <cstdint>

#include "engine/model/layer_problem.h"
#include "engine/model/plan.h"

namespace traverse {

// Makes the tree of `plan` any_order over its paths 0, 1, ...
void ArrangeFreely(Plan& plan);

// A problem on `plan`, which must outlive it: start and cost of `problem`, no finish, and a
// separate seed for each `step`.
LayerProblem StepProblem(const LayerProblem& problem, const Plan& plan, uint64_t step);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_STEP_PROBLEM_H_
