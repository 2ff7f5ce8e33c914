// What algorithms want to know of a plan's tree again and again, computed once.

#ifndef TRAVERSE_ENGINE_MODEL_TREE_PLAN_TREE_H_
#define TRAVERSE_ENGINE_MODEL_TREE_PLAN_TREE_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/model/plan.h"
#include "engine/model/tree/compiled_plan.h"

namespace traverse {

// The pairs `before` of one any_order node, in terms of its slots: its children that have paths,
// numbered from 0 in the order given. Children without paths have no place in a route, but what
// comes before them still comes before what comes after them: they stay in here as items above the
// slots.
class Precedence {
 public:
  // Nothing is before anything.
  Precedence() = default;

  // `item_of[c]`: the slot of child c, or an item from `slots` on for a child without paths.
  Precedence(const PlanNode& node, int slots, const std::vector<int>& item_of);

  bool empty() const { return pairs_.empty(); }

  // Slots, and above them the children without paths. 0 if empty.
  int item_count() const { return static_cast<int>(topological_.size()); }

  // Writes to last[s] the greatest position of a slot that has to come before slot s, -1 if none.
  // An order of the slots is legal if last[s] < position[s] for all s. `position` and `last` are
  // indexed by slot. O(items + pairs). REQUIRES: not empty.
  void LastBefore(absl::Span<const int> position, std::vector<int>& last) const;

  // [item] as bits, which of the slots `first` .. `first` + 63 have to come before it, by pairs or
  // by several of them. O(items + pairs). REQUIRES: not empty.
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

// Which slots of a node may be done next, while they are done one after the other.
class ReadySlots {
 public:
  // Calls `ready(slot)` for each slot that may be done first. `precedence` outlives this.
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

  // Notes that `slot` is done; calls `ready(slot)` for each that may be done from now on.
  template <typename F>
  void Finish(int slot, F&& ready) {
    Finish(slot, ready, [](int, int) {});
  }

  // Same; before that calls `pair(first, second)` for each pair of items that is fulfilled now. All
  // pairs to an item come before those from it.
  template <typename F, typename G>
  void Finish(int slot, F&& ready, G&& pair) {
    if (precedence_->empty()) return;
    Release(slot, ready, pair);
  }

 private:
  // An item has nothing left to wait for: a slot is reported, any other is done at once.
  template <typename F>
  void Pass(int item, F&& ready) {
    if (item < precedence_->slots_) {
      ready(item);
    } else {
      Release(item, ready, [](int, int) {});
    }
  }

  // A chain of items without paths is followed by a list, as it may be long.
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
  std::vector<int> waiting_for_;  // [item] pairs whose first is not yet done
};

// A plan's tree, with what the order of its paths may be. O(nodes + pairs) to build. Immutable.
class PlanTree : public CompiledPlan {
 public:
  // See CompiledPlan.
  explicit PlanTree(const Plan& plan, Budget* budget = nullptr);

  // The pairs of an any_order node; empty for every other node.
  const Precedence& precedence(int index) const {
    return precedences_[static_cast<size_t>(precedence_of_[static_cast<size_t>(index)])];
  }

  // Whether every legal order of the node's paths is still legal when it is reversed and each path
  // is run through backwards. The travel between the paths is then the same.
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
