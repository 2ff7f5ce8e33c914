// Which numbers the fields of requests may have: one table for all of them.
//
// The comments in proto/ say the same; tests compare the two. The engine keeps its promises over
// all of these ranges: tests/engine/strategy/corners_test.cc.

#ifndef TRAVERSE_SERVER_FIELD_RANGES_H_
#define TRAVERSE_SERVER_FIELD_RANGES_H_

#include <string>

#include "absl/status/status.h"
#include "absl/types/span.h"

namespace traverse {

struct FieldRange {
  const char* field;  // "TimeCost.speed_mm_s": message and field of traverse.v1
  double least;
  double greatest;
  bool or_zero = false;  // 0 is allowed, although it is below `least`
};

absl::Span<const FieldRange> FieldRanges();

// The row of `field`. REQUIRES: there is one.
const FieldRange& RangeOf(const char* field);

// InvalidArgument `place: 5e-324 is not from 0.001 to 100000` or `place: not finite`; OK if `value`
// is in the range.
absl::Status CheckRange(const FieldRange& range, double value, const std::string& place);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_FIELD_RANGES_H_
