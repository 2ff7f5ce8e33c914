#include "engine/weller/tabu/swap_table.h"

#include <algorithm>

namespace traverse {

SwapTable::SwapTable(const SwapSequence& sequence, int node)
    : sequence_(sequence),
      node_(node),
      count_(Index(sequence.tree().child_count(node))),
      ends_(2 * count_, -1),
      slots_(count_),
      child_at_(count_),
      present_(count_),
      placed_(count_ * count_),
      neighbors_(count_) {
  const SequenceTree& tree = sequence.tree();
  for (size_t i = 0; i < count_; ++i) {
    children_.push_back(tree.child_at(node, static_cast<int>(i)));
  }
  std::sort(children_.begin(), children_.end());
  local_.assign(Index(children_.back() - children_.front()) + 1, -1);
  for (size_t c = 0; c < count_; ++c) {
    local_[Index(children_[c] - children_.front())] = static_cast<int>(c);
  }
}

// Finds the blocks whose ends changed. Entries of paths are chosen for each place, so what they are
// now does not matter.
void SwapTable::UpdateChildren() {
  moved_.clear();
  for (size_t c = 0; c < count_; ++c) {
    if (sequence_.tree().path_of(children_[c]) >= 0) continue;
    const int first = sequence_.first_entry(children_[c]);
    const int last = sequence_.last_entry(children_[c]);
    if (ends_[2 * c] == first && ends_[2 * c + 1] == last) continue;
    ends_[2 * c] = first;
    ends_[2 * c + 1] = last;
    moved_.push_back(static_cast<int>(c));
  }
}

void SwapTable::Update() {
  const SequenceTree& tree = sequence_.tree();
  UpdateChildren();
  for (size_t k = 0; k < count_; ++k) {
    const int child = tree.child_at(node_, static_cast<int>(k));
    const Slot now{sequence_.entry_before(child), sequence_.first_entry(child),
                   sequence_.last_entry(child), sequence_.entry_after(child)};
    Slot& slot = slots_[k];
    const bool around_changed = slot.before != now.before || slot.after != now.after;
    if (around_changed || slot.first != now.first || slot.last != now.last) {
      slot = now;
      present_[k] = sequence_.PresentCost(child);
    }
    child_at_[k] = local_[Index(child - children_.front())];
    double* row = &placed_[k * count_];
    if (around_changed) {
      sequence_.FillPlacedCosts(children_, now.before, now.after, absl::MakeSpan(row, count_));
    } else {
      for (const int c : moved_) {
        row[c] = sequence_.PlacedCost(children_[Index(c)], now.before, now.after);
      }
    }
  }
  for (int i = 0; i + 1 < static_cast<int>(count_); ++i) UpdateNeighbors(i);
}

void SwapTable::UpdateNeighbors(int i) {
  const Slot& x = slots_[Index(i)];
  const Slot& y = slots_[Index(i) + 1];
  const int entries[6] = {x.before, x.first, x.last, y.first, y.last, y.after};
  Neighbors& neighbors = neighbors_[Index(i)];
  if (std::equal(entries, entries + 6, neighbors.entries)) return;
  std::copy(entries, entries + 6, neighbors.entries);
  neighbors.delta = sequence_.NeighborDelta(node_, i);
}

}  // namespace traverse
