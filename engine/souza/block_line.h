// A line of blocks: what an order search sees of the children of one any_order node.
//
//   from -> [block 0] -> [block 1] -> ... -> [block n-1] -> to
//
// A block is entered and left at two points; what lies between does not matter here. A reversible
// block may also be traversed backwards, with the two points exchanged, at no change inside.

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

// The blocks in their present order, with the cost of a 2-opt move in O(1). Keeps its memory
// between lines. Not thread-safe.
class BlockLine {
 public:
  explicit BlockLine(const TravelCost& cost) : cost_(cost) {}

  // Begins another line. Without `to` the line ends with its last block. `precedence` (of the
  // slots) must outlive the line; `blocks` keeps it.
  void Load(Point from, const std::optional<Point>& to, const std::vector<Block>& blocks,
            const Precedence& precedence);

  int size() const { return static_cast<int>(slots_.size()); }

  // In the present order: the slots, and whether each block is traversed backwards compared with
  // how it was loaded.
  absl::Span<const int> slots() const { return slots_; }
  absl::Span<const char> reversed() const { return reversed_; }

  // The change of cost if blocks [first, last] came in reverse order, the reversible ones
  // backwards; negative is better. REQUIRES: 0 <= first <= last < size().
  double ReversalDelta(int first, int last) const;

  // The best reversal that begins with block `first`. REQUIRES: 0 <= first < size().
  struct Reversal {
    int last = -1;     // -1: no reversal changes the cost by less than `delta`
    double delta = 0;  // change of cost
  };
  // Considers only changes below `delta`, which is <= 0. O(size()), mostly without square roots for
  // lengths.
  Reversal BestReversalFrom(int first, double delta) const;

  // Applies that reversal. O(last - first), or O(size() + pairs) with precedence or irreversible
  // blocks. REQUIRES: 0 <= first <= last < size(), and no block among them waits for another one.
  void Reverse(int first, int last);

  // Deltas nearer to 0 than this may be rounding noise: kImprovementTolerance, or the noise of the
  // sums if deltas come from long ones.
  double tolerance() const;

  // The cost of all moves, computed again.
  double Cost() const;

 private:
  Point LeftBefore(int position) const {
    return position > 0 ? exit_[static_cast<size_t>(position) - 1] : from_;
  }
  double MoveAfter(Point exit, int position) const;

  // The same as ReversalDelta, if the two new moves cost at most `most`; otherwise something above.
  double ReversalDelta(int first, int last, double most) const;
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
  std::vector<Point> back_enter_;  // where the block is entered and left when it was reversed with
  std::vector<Point> back_exit_;   // others: the two points exchanged if it is reversible
  std::vector<int> slots_;
  std::vector<char> reversed_;
  std::vector<char> reversible_;
  std::vector<double> move_;    // cost of the move to the block; [size()] of the one to `to`
  std::vector<double> detour_;  // what reversing the moves into blocks 1..position would add; all 0
                                // if symmetric
  std::vector<int> last_before_;  // the last position of a block that must come before it

  std::vector<int> position_of_;  // [slot] scratch
  std::vector<int> last_of_;      // [slot] scratch
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SOUZA_BLOCK_LINE_H_
