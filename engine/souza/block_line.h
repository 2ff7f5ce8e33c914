// A line of blocks: what an order search sees of the children of one any_order node.
//
//   from -> [block 0] -> [block 1] -> ... -> [block n-1] -> to
//
// A block is entered and left at two points; what lies between does not matter here. A reversible
// one may also be run through backwards, with the two points exchanged, at no change inside.

#ifndef TRAVERSE_ENGINE_SOUZA_BLOCK_LINE_H_
#define TRAVERSE_ENGINE_SOUZA_BLOCK_LINE_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/point.h"
#include "engine/model/tree/plan_tree.h"

namespace traverse {

struct Block {
  Point enter;
  Point exit;
  int slot = 0;
  bool reversible = false;
};

// The blocks in their present order, with what a 2-opt move costs in O(1). Keeps its memory from
// one line to the next. Not thread-safe.
class BlockLine {
 public:
  explicit BlockLine(const TravelCost& cost) : cost_(cost) {}

  // Begins another line. No `to`: the line ends with its last block. `precedence` (of the slots)
  // outlives the line; `blocks` keeps it.
  void Load(Point from, const std::optional<Point>& to, const std::vector<Block>& blocks,
            const Precedence& precedence);

  int size() const { return static_cast<int>(slots_.size()); }

  // In the present order: the slots, and whether each block is run through backwards, compared with
  // how it was loaded.
  absl::Span<const int> slots() const { return slots_; }
  absl::Span<const char> reversed() const { return reversed_; }

  // The change of cost if blocks [first, last] were done in the reverse order, the reversible ones
  // backwards; negative is better. REQUIRES: 0 <= first <= last < size().
  double ReversalDelta(int first, int last) const;

  // The best reversal that begins with block `first`. REQUIRES: 0 <= first < size().
  struct Reversal {
    int last = -1;     // -1: none changes the cost by less than `delta`
    double delta = 0;  // change of cost
  };
  // Looks only for changes below `delta`, which is <= 0. O(size()), mostly without square roots for
  // lengths.
  Reversal BestReversalFrom(int first, double delta) const;

  // Does it. O(last - first), and O(size() + pairs) with precedence or blocks that are not
  // reversible. REQUIRES: 0 <= first <= last < size(), and no block of them waits for another one.
  void Reverse(int first, int last);

  // Deltas nearer to 0 than this may be rounding noise: kImprovementTolerance or, where deltas come
  // from long sums, the noise of these.
  double tolerance() const;

  // The cost of all moves, computed anew.
  double Cost() const;

 private:
  Point LeftBefore(int position) const {
    return position > 0 ? exit_[static_cast<size_t>(position) - 1] : from_;
  }
  double MoveAfter(Point exit, int position) const;
  void UpdateMoves(int first, int last);
  void UpdateDetours(int first);
  void UpdateLastBefore();

  TravelCost cost_;
  Point from_;
  std::optional<Point> to_;
  const Precedence* precedence_ = nullptr;
  bool symmetric_ = true;      // all blocks are reversible
  double largest_detour_ = 0;  // so far, without sign

  // [position]
  std::vector<Point> enter_;
  std::vector<Point> exit_;
  std::vector<Point> back_enter_;  // where the block is entered and left once it was reversed with
  std::vector<Point> back_exit_;   // others: exchanged if it is reversible
  std::vector<int> slots_;
  std::vector<char> reversed_;
  std::vector<char> reversible_;
  std::vector<double> move_;    // cost of the move to the block; [size()] of the one to `to`
  std::vector<double> detour_;  // what reversing the moves into blocks 1..position would add; all 0
                                // if symmetric
  std::vector<int> last_before_;  // the last position of a block that has to come before it

  std::vector<int> position_of_;  // [slot] scratch
  std::vector<int> last_of_;      // [slot] scratch
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SOUZA_BLOCK_LINE_H_
