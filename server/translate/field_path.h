// Positions in a layer of a request, and the checks made at many of them.

#ifndef TRAVERSE_SERVER_TRANSLATE_FIELD_PATH_H_
#define TRAVERSE_SERVER_TRANSLATE_FIELD_PATH_H_

#include <climits>
#include <cstddef>
#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "engine/model/point.h"
#include "google/protobuf/repeated_field.h"
#include "server/translate/field_ranges.h"
#include "server/translate/translate_check.h"

namespace traverse {

// The steps that Rest counts for a translated message.
inline constexpr size_t kStepsOfMessage = 64;

// A position in the request, whose text is only built when there is a fault.
class FieldPath {
 public:
  FieldPath(const FieldPath* parent, const char* field, uint64_t index)
      : parent_(parent), field_(field), index_(index) {}

  std::string text() const {
    return absl::StrCat(parent_ == nullptr ? "" : absl::StrCat(parent_->text(), "."), field_, "[",
                        index_, "]");
  }

 private:
  const FieldPath* parent_;
  const char* field_;
  uint64_t index_;
};

// Like CheckKnown, but without building the text of the position; for frequent messages.
template <typename Message>
absl::Status CheckKnownAt(const Message& message, const FieldPath& place) {
  if (message.GetReflection()->GetUnknownFields(message).empty()) return absl::OkStatus();
  return CheckKnown(message, place.text());
}

using Coordinates = google::protobuf::RepeatedField<double>;

inline absl::Status CheckCoordinates(const Coordinates& coordinates, const FieldRange& range,
                                     const FieldPath& place) {
  if (coordinates.size() % 2 != 0) {
    return Fault(place.text() + ".points",
                 absl::StrCat(coordinates.size(), " coordinates, which are not pairs of x and y"));
  }
  for (int i = 0; i < coordinates.size(); ++i) {
    // NaN is in no range.
    if (coordinates[i] >= range.least && coordinates[i] <= range.greatest) continue;
    return CheckRange(range, coordinates[i],
                      absl::StrCat(place.text(), ".points[", i / 2, "].", i % 2 == 0 ? "x" : "y"));
  }
  return absl::OkStatus();
}

inline Point PointAt(const Coordinates& coordinates, int point) {
  return {coordinates[2 * point], coordinates[2 * point + 1]};
}

// An index of the API as one of the engine. Values beyond int are not valid indices.
inline absl::StatusOr<int> Index(uint32_t value, const std::string& place) {
  if (value > INT_MAX) return Fault(place, absl::StrCat(value, " is too large for an index"));
  return static_cast<int>(value);
}

}  // namespace traverse

#endif  // TRAVERSE_SERVER_TRANSLATE_FIELD_PATH_H_
