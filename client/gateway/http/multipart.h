// multipart/form-data (RFC 7578), read piece by piece: no part is ever held in memory.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_MULTIPART_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_MULTIPART_H_

#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace traverse::gateway {

// The head of one part. File names are as sent: their users must check them.
struct PartHead {
  std::string name;
  std::optional<std::string> filename;
};

// Receives the parts. An error ends the reading, and Feed returns it.
class PartSink {
 public:
  virtual ~PartSink() = default;
  virtual absl::Status BeginPart(const PartHead& head) = 0;
  virtual absl::Status TakePart(std::string_view bytes) = 0;
  virtual absl::Status EndPart() = 0;
};

// The boundary in a Content-Type header of multipart/form-data. InvalidArgument if there is none,
// or one that RFC 2046 does not allow.
absl::StatusOr<std::string> BoundaryOf(const std::string& content_type);

class MultipartReader {
 public:
  // Most bytes of the head of one part, and most parts.
  static constexpr size_t kMaxHeadBytes = 8192;
  static constexpr int kMaxParts = 32;

  // `sink` must outlive the reader.
  MultipartReader(const std::string& boundary, PartSink& sink);

  // Reads the next bytes of the body. InvalidArgument if they are not such a body; errors of the
  // sink.
  absl::Status Feed(std::string_view bytes);

  // The body has ended: InvalidArgument if it was truncated.
  absl::Status Finish() const;

 private:
  enum class State { kPreamble, kAfterBoundary, kHead, kBody, kEpilogue };

  // Each consumes what it can from buffered_; false if it needs more.
  absl::StatusOr<bool> Step();
  absl::StatusOr<bool> StepAfterBoundary();
  absl::StatusOr<bool> StepHead();
  absl::StatusOr<bool> StepBody();

  const std::string boundary_;  // "\r\n--" and the boundary
  PartSink& sink_;
  State state_ = State::kPreamble;
  std::string buffered_;
  int parts_ = 0;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_MULTIPART_H_
