// Checks that the translations of options and of layers share.

#ifndef TRAVERSE_SERVER_TRANSLATE_TRANSLATE_CHECK_H_
#define TRAVERSE_SERVER_TRANSLATE_TRANSLATE_CHECK_H_

#include <google/protobuf/message.h>

#include <cmath>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "engine/model/cost_spec.h"
#include "engine/model/point.h"
#include "traverse/v1/options.pb.h"

namespace traverse {

// Leaves the calling function with the status if it is an error.
#define TRAVERSE_RETURN_IF_ERROR(expression)                \
  do {                                                      \
    if (absl::Status status = (expression); !status.ok()) { \
      return status;                                        \
    }                                                       \
  } while (false)

// InvalidArgument `place: what`.
inline absl::Status Fault(const std::string& place, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(place, ": ", what));
}

// Unimplemented `place: ...` if `message` itself (not its parts) has a field that this version does
// not know: what the field asks for would silently not be done.
absl::Status CheckKnown(const google::protobuf::Message& message, const std::string& place);

// A point whose coordinates are in range (field_ranges.h).
absl::StatusOr<Point> PointFromProto(const v1::Point& point, const std::string& place);

// The cost model; an empty one is length.
absl::StatusOr<CostSpec> CostFromProto(const v1::CostModel& cost, const std::string& place);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_TRANSLATE_TRANSLATE_CHECK_H_
