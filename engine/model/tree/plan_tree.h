// What algorithms ask about a plan's tree again and again, computed once.

#ifndef TRAVERSE_ENGINE_MODEL_TREE_PLAN_TREE_H_
#define TRAVERSE_ENGINE_MODEL_TREE_PLAN_TREE_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/model/plan.h"
#include "engine/model/tree/compiled_plan.h"

namespace traverse {

// The pairs `before` of one any_order node, in terms of its slots: its children that have
// paths, numbered from 0 in the given order. Children without paths have no place in a route.
// But what precedes them still precedes what follows them, so they remain here as items above
// the slots.
class Precedence {
 public:
  // No pairs.
  Precedence() = default;

  // `item_of[c]`: the slot of child c, or an item from `slots` on for a child without paths.
  Precedence(const PlanNode& node, int slots, const std::vector<int>& item_of);

  bool empty() const { return pairs_.empty(); }

  // The number of slots plus children without paths. 0 if empty.
  int item_count() const { return static_cast<int>(topological_.size()); }

  // Sets last[s] to the greatest position of a slot that must come before slot s, or -1 if there is
  // none. An order of the slots is legal if last[s] < position[s] for all s. `position` and `last`
  // are indexed by slot. O(items + pairs). REQUIRES: not empty.
  void LastBefore(absl::Span<const int> position, std::vector<int>& last) const;

  // Returns [item] as bits which of the slots `first` .. `first` + 63 must come before it, directly
  // or through several pairs. O(items + pairs). REQUIRES: not empty.
  std::vector<uint64_t> SlotsBefore(int first) const;

 private:
  friend class ReadySlots;

  absl::Span<const int> After(int item) const {
    const size_t begin = static_cast<size_t>(first_pair_[static_cast<size_t>(item)]);
    const size_t end = static_cast<size_t>(first_pair_[static_cast<size_t>(item) + 1]);
    return absl::MakeConstSpan(pairs_).subspan(begin, end - begin);
  }

  int slots_ = 0;
  std::vector<int> first_pair_;   // [item] where its pairs begin in pairs_; one more at the end
  std::vector<int> pairs_;        // items that come after the item
  std::vector<int> topological_;  // items in an order that keeps all pairs
};

// Tracks which slots of a node may come next while they are done one after the other.
class ReadySlots {
 public:
  // Calls `ready(slot)` for each slot that may come first. `precedence` outlives this object.
  template <typename F>
  ReadySlots(const Precedence& precedence, int slots, F&& ready) : precedence_(&precedence) {
    if (precedence.empty()) {
      for (int s = 0; s < slots; ++s) ready(s);
      return;
    }
    waiting_for_.assign(precedence.topological_.size(), 0);
    for (const int item : precedence.pairs_) ++waiting_for_[static_cast<size_t>(item)];
    const std::vector<int> waits_at_first = waiting_for_;
    for (size_t item = 0; item < waits_at_first.size(); ++item) {
      if (waits_at_first[item] == 0) Pass(static_cast<int>(item), ready);
    }
  }

  // Notes that `slot` is done. Calls `ready(slot)` for each slot that may come from now on.
  template <typename F>
  void Finish(int slot, F&& ready) {
    Finish(slot, ready, [](int, int) {});
  }

  // The same, but before that calls `pair(first, second)` for each pair of items that is now
  // fulfilled. All pairs to an item come before those from it.
  template <typename F, typename G>
  void Finish(int slot, F&& ready, G&& pair) {
    if (precedence_->empty()) return;
    Release(slot, ready, pair);
  }

 private:
  // An item waits for nothing any more: report a slot; any other item is done at once.
  template <typename F>
  void Pass(int item, F&& ready) {
    if (item < precedence_->slots_) {
      ready(item);
    } else {
      Release(item, ready, [](int, int) {});
    }
  }

  // A list, not recursion, follows a chain of items without paths, because it may be long.
  template <typename F, typename G>
  void Release(int item, F&& ready, G&& pair) {
    std::vector<int> done = {item};
    while (!done.empty()) {
      const int before = done.back();
      done.pop_back();
      for (const int after : precedence_->After(before)) {
        pair(before, after);
        if (--waiting_for_[static_cast<size_t>(after)] > 0) continue;
        if (after < precedence_->slots_) {
          ready(after);
        } else {
          done.push_back(after);
        }
      }
    }
  }

  const Precedence* precedence_;
  std::vector<int> waiting_for_;  // [item] pairs whose first item is not done yet
};

// A plan's tree with the possible orders of its paths. O(nodes + pairs) to build. Immutable.
class PlanTree : public CompiledPlan {
 public:
  // See CompiledPlan.
  explicit PlanTree(const Plan& plan, Budget* budget = nullptr);

  // The pairs of an any_order node; empty for every other node.
  const Precedence& precedence(int index) const {
    return precedences_[static_cast<size_t>(precedence_of_[static_cast<size_t>(index)])];
  }

  // True if every legal order of the node's paths stays legal when reversed with each path
  // traversed backwards. The travel between the paths is then the same.
  bool reversible(int index) const { return reversible_[static_cast<size_t>(index)]; }

 private:
  void AddPrecedence(int index);
  bool ComputeReversible(int index) const;

  std::vector<int> precedence_of_;       // [node] index into precedences_
  std::vector<Precedence> precedences_;  // [0] is the empty one
  std::vector<bool> reversible_;         // [node]
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_TREE_PLAN_TREE_H_
