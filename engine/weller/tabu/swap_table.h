// The deltas of all swaps of the children of one node, kept up to date.
//
// Swapping child x at position i and child y at position j > i + 1 costs
//
//   placed[j][x] + placed[i][y] - present[i] - present[j]
//
// where placed[k][c] is the cost of the two moves around position k with child c there, between the
// entries that are around it now. A swap changes the surroundings of four positions, so four rows
// are computed again, and evaluating all swaps of n children takes O(n) costs of moves instead of
// O(n^2).

#ifndef TRAVERSE_ENGINE_WELLER_TABU_SWAP_TABLE_H_
#define TRAVERSE_ENGINE_WELLER_TABU_SWAP_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/weller/tabu/swap_sequence.h"

namespace traverse {

// Memory: 8 n^2 bytes.
class SwapTable {
 public:
  // `sequence` must outlive the table.
  SwapTable(const SwapSequence& sequence, int node);

  int node() const { return node_; }

  // Has to be called after changes of the sequence, which it counts itself when `changes`, how many
  // there have been since any time, is another than at the last call. O(children) if nothing did.
  void Update(int64_t changes) {
    if (changes == changes_) return;
    changes_ = changes;
    Update();
  }

  // Calls `function(j, delta)` for all j > i, where delta is SwapSequence::Evaluate(node, i,
  // j).delta as of the last update.
  template <typename Function>
  void ForRow(int row, const Function& function) const {
    const size_t i = Index(row);
    if (i + 1 < count_) function(row + 1, neighbors_[i].delta);
    const double* at_i = &placed_[i * count_];
    const double* child_i = &placed_[Index(child_at_[i])];
    for (size_t j = i + 2; j < count_; ++j) {
      function(static_cast<int>(j),
               at_i[child_at_[j]] + child_i[j * count_] - present_[i] - present_[j]);
    }
  }

 private:
  // The ends of the child at a position, and the entries around it.
  struct Slot {
    int before = -1;
    int first = -1;
    int last = -1;
    int after = -1;
  };
  struct Neighbors {
    int entries[6] = {};  // around and of the children at i and i + 1
    double delta = 0;
  };

  static size_t Index(int i) { return static_cast<size_t>(i); }

  void Update();
  void UpdateChildren();
  void UpdateNeighbors(int i);

  const SwapSequence& sequence_;
  int node_;
  int64_t changes_ = -1;
  size_t count_;
  std::vector<int> children_;         // [local number]
  std::vector<int> local_;            // [node of the tree - children_.front()] local number
  std::vector<int> ends_;             // [2 * local number, + 1] first and last entry of a block
  std::vector<Slot> slots_;           // [position]
  std::vector<int> child_at_;         // [position] local number
  std::vector<double> present_;       // [position] cost of the moves to and from the child there
  std::vector<double> placed_;        // [position * count_ + local number]
  std::vector<Neighbors> neighbors_;  // [i] of positions i and i + 1
  std::vector<int> moved_;            // scratch: local numbers whose column is out of date
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_SWAP_TABLE_H_
