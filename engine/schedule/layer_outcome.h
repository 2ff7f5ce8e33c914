// What is told of a layer: the travel of a route, and what its moves come to.

#ifndef TRAVERSE_ENGINE_SCHEDULE_LAYER_OUTCOME_H_
#define TRAVERSE_ENGINE_SCHEDULE_LAYER_OUTCOME_H_

#include "engine/engine.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// Sets what concerns the given order. `problem` starts where that order does; the move to its
// finish, if it has one, is told apart. Others have their turns meanwhile; once `turns` is
// cancelled, nobody will look at what is told.
void TellGiven(const LayerProblem& problem, const Route& given, Budget& turns,
               LayerOutcome& outcome);

// Sets what concerns the route that was found, and whether it is what it claims to be: with walls
// its moves are computed again by other code. Takes the plan out of `layer`.
// REQUIRES: problem.plan is that of `layer`; the route is valid for it.
void TellFound(const LayerProblem& problem, Solution solution, JobLayer& layer, Budget& turns,
               LayerOutcome& outcome);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_OUTCOME_H_
