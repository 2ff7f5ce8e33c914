// Segment moves: all ways to cut a route at two or three places and put it together again.
//
//   positions    ... p [first ........ last] q ...      one segment  B
//   or           ... p [first .. middle-1][middle .. last] q ...     B and C
//
//   kReverse          p B' q          2-opt (B' is B backwards)
//   kReverseBoth      p B' C' q
//   kExchange         p C B q         Or-opt where one of the two is short
//   kExchangeReverseFirst, -Second    p C B' q, p C' B q
//
// Together these are all pure 3-opt moves (Johnson and McGeoch 1997).

#ifndef TRAVERSE_ENGINE_SEARCH_SEGMENT_MOVE_H_
#define TRAVERSE_ENGINE_SEARCH_SEGMENT_MOVE_H_

#include <array>
#include <cassert>

namespace traverse {

// A run of positions [first, last], traversed backwards if `reversed`.
struct Segment {
  int first = 0;
  int last = 0;
  bool reversed = false;

  int size() const { return last - first + 1; }
  // The position that comes at index i.
  int At(int i) const { return reversed ? last - i : first + i; }
};

struct SegmentMove {
  enum class Kind {
    kReverse,
    kReverseBoth,
    kExchange,
    kExchangeReverseFirst,
    kExchangeReverseSecond,
  };

  Kind kind = Kind::kReverse;
  int first = 0;
  int middle = 0;  // kReverse: first
  int last = 0;

  bool operator==(const SegmentMove&) const = default;

  bool exchanges() const { return kind >= Kind::kExchange; }

  // The segments in their new order; for kReverse only the first element counts.
  std::array<Segment, 2> NewOrder() const {
    switch (kind) {
      case Kind::kReverse:
        return {Segment{first, last, true}, Segment{}};
      case Kind::kReverseBoth:
        return {Segment{first, middle - 1, true}, Segment{middle, last, true}};
      default:
        return {Segment{middle, last, kind == Kind::kExchangeReverseSecond},
                Segment{first, middle - 1, kind == Kind::kExchangeReverseFirst}};
    }
  }
  int segment_count() const { return kind == Kind::kReverse ? 1 : 2; }

  // Where the second segment of the new order begins after the move. REQUIRES: there is one.
  int NewMiddle() const {
    assert(segment_count() == 2);
    return exchanges() ? first + (last - middle + 1) : middle;
  }
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_SEGMENT_MOVE_H_
