// The first rule: the same deposits under the same conditions, and the lines beside them.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_SAME_PRINT_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_SAME_PRINT_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "absl/types/span.h"
#include "client/gcode/verify/match/moved_objects.h"
#include "client/gcode/verify/report.h"
#include "client/gcode/verify/sections.h"
#include "client/gcode/work_limit.h"

namespace traverse::gcode {

// One of the two files, as far as it has been cut into sections.
struct Side {
  std::string_view text;
  const std::string& name;
  const Sections& cut;
  const absl::flat_hash_set<uint64_t>& other_gaps;  // digests of deposits with a moved gap
  bool right_digest = false;                        // its first line states the digest of the file
};

// The first difference in each of the sections `first` to `end` - 1, up to the first section that
// ends with a line of its own. `whole`: the files end with section `end` - 1, and have equally
// many. In the layers `moved` whole objects have changed places.
std::vector<VerifyBreak> Differences(const Side& original, const Side& optimised, size_t first,
                                     size_t end, bool whole, absl::Span<const MovedLayer> moved,
                                     const WorkLimit& limit = {});

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_SAME_PRINT_H_
