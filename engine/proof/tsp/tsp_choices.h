// What the branch and cut of a path TSP (path_tsp.h) may branch on.

#ifndef TRAVERSE_ENGINE_PROOF_TSP_TSP_CHOICES_H_
#define TRAVERSE_ENGINE_PROOF_TSP_TSP_CHOICES_H_

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/proof/tsp/tsp_relaxation.h"

namespace traverse {

// 0 or 1 in every path: a column, or, where that is -1, whether two items follow each other. Where
// items have many ports, a single move is little: without it the bound is mostly what it was.
struct TspChoice {
  int column = -1;
  TspRelaxation::ItemPair pair;
};

// Choices made, in or out.
using TspChoices = std::vector<std::pair<TspChoice, bool>>;

// Choices that the last solution leaves open and that are not made, pairs before columns, of each
// the most undecided first: up to so many pairs.
std::vector<TspChoice> OpenChoices(TspRelaxation& relaxation, const TspChoices& made,
                                   size_t most_pairs);

// Holds the pairs of the choices that are made, and of these.
void HoldPairsOf(const TspChoices& made, const std::vector<TspChoice>& choices,
                 TspRelaxation& relaxation);

// REQUIRES: the pair, if it is one, is held.
void Fix(const TspChoice& choice, bool in, TspRelaxation& relaxation);
void Free(const TspChoice& choice, TspRelaxation& relaxation);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TSP_TSP_CHOICES_H_
