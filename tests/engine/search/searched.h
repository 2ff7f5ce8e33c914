// Problems with all that local search needs, for its tests.

#ifndef TRAVERSE_TESTS_ENGINE_SEARCH_SEARCHED_H_
#define TRAVERSE_TESTS_ENGINE_SEARCH_SEARCHED_H_

#include <utility>

#include "engine/base/rng.h"
#include "engine/model/route.h"
#include "engine/search/end_groups.h"
#include "engine/search/search_state.h"
#include "tests/support/problems/random_plan.h"

namespace traverse::testing {

// The state is loaded with the order given.
struct Searched {
  explicit Searched(uint64_t seed,
                    const RandomPlanOptions& options = {.min_paths = 3, .max_paths = 12})
      : Searched(RandomProblem(seed, options)) {}

  explicit Searched(OwnedProblem problem)
      : owned(std::move(problem)),
        tree(owned.plan()),
        entries(owned.problem),
        state(owned.problem, tree, entries),
        groups(entries),
        neighbors(FindNeighbors(tree, groups, 12, budget)) {
    state.Load(GivenRoute(owned.plan()));
  }

  OwnedProblem owned;
  OrderTree tree;
  LeafEntries entries;
  SearchState state;
  Budget budget;
  EndGroups groups;
  NeighborLists neighbors;
};

inline SegmentMove RandomMove(Rng& rng, int paths) {
  SegmentMove move;
  move.kind = static_cast<SegmentMove::Kind>(rng.Below(5));
  move.first = rng.Between(1, paths);
  move.last = rng.Between(move.first, paths);
  move.middle = move.first;
  if (move.segment_count() == 2) {
    if (move.first == move.last) return RandomMove(rng, paths);
    move.middle = rng.Between(move.first + 1, move.last);
  }
  return move;
}

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_ENGINE_SEARCH_SEARCHED_H_
