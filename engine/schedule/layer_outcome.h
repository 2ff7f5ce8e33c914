// Fills in the answer for a layer: the travel of a route, and the totals of its moves.

#ifndef TRAVERSE_ENGINE_SCHEDULE_LAYER_OUTCOME_H_
#define TRAVERSE_ENGINE_SCHEDULE_LAYER_OUTCOME_H_

#include "engine/engine.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// Sets the part about the given order. `problem` starts where that order does; the move to its
// finish, if it has one, is reported separately. Other tasks get their turns meanwhile. Once
// `turns` is cancelled, nobody will read the result.
void TellGiven(const LayerProblem& problem, const Route& given, Budget& turns,
               LayerOutcome& outcome);

// Sets the part about the route that was found, after checking the solution's claims: with walls,
// other code computes its moves again. Takes the plan out of `layer`. REQUIRES: problem.plan is
// that of `layer`; the route is valid for it.
void TellFound(const LayerProblem& problem, Solution solution, JobLayer& layer, Budget& turns,
               LayerOutcome& outcome);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_OUTCOME_H_
