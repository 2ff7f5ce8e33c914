// The stages of a plan, and which path may follow which in a stage.
//
// A stage is an any_order of the plan, with everything below it. Where all its children are single
// paths, any of them may follow any other (but for `before`). A child with paths of its own is a
// block, done completely before the next one starts; of that, what may follow directly says nearly
// all:
//
//   any_order( in_order(a, any_order(b, c)), in_order(d, e) )        a -> b <-> c -> d -> e -> a
//
// The order a b d e c obeys no such moves: c can be reached from a and b alone, and a leads out of
// nothing. In general, a block with one path that is always its first is entered there, and as that
// path is done once, so is the block; the same holds for a block with one last path. Where a block
// has neither, a gate in front of it does the same: no path, but an item that is done once. So:
//
//   an order of the items of a stage that follows moves, begins and ends where it may, and keeps
//   `before` is an order that the plan allows, and each of these is one.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_PLAN_STAGES_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_PLAN_STAGES_H_

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "engine/base/budget.h"
#include "engine/model/plan.h"

namespace traverse {

// Items that are done one after the other, each once.
struct PlanStage {
  static constexpr int kGate = -1;

  // A block has its items in [first, last) and its gate at `item`.
  struct Gate {
    int item = 0;
    int first = 0;
    int last = 0;
  };

  int size() const { return static_cast<int>(paths.size()); }
  bool CanFollow(int i, int j) const {
    return follows[static_cast<size_t>(i) * paths.size() + static_cast<size_t>(j)] != 0;
  }

  // Stored inline for a stage of one path: a plan may have a million of these.
  absl::InlinedVector<int, 1> paths;        // [item] index into Plan::paths, or kGate
  std::vector<std::pair<int, int>> before;  // items; transitively closed
  absl::InlinedVector<char, 8> follows;     // [i * size() + j] whether j may follow i directly
  absl::InlinedVector<char, 8> begins;      // [item] whether it may be the first
  absl::InlinedVector<char, 8> ends;        // [item] whether it may be the last
  std::vector<Gate> gates;                  // inner ones first
};

// The stages of `plan` in order, or nothing if one has more than `most_items` or `budget` (may
// be null) ends. Nested in_orders outside any_orders are flattened; nodes without paths
// disappear, but the precedences that go through them stay. O(nodes + most_items (pairs +
// most_items^2)).
std::optional<std::deque<PlanStage>> StagesOf(const Plan& plan, size_t most_items,
                                              Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_PLAN_STAGES_H_
