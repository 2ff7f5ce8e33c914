// The faults of a request, all of which are reported to its caller at once.
//
//   FaultList faults;
//   for (const auto& path : paths) faults.Add(Check(path));
//   return faults.status();
//
// A status carries its faults as google.rpc.BadRequest, so lists within lists become one.

#ifndef TRAVERSE_SERVER_TRANSLATE_FAULT_LIST_H_
#define TRAVERSE_SERVER_TRANSLATE_FAULT_LIST_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace traverse {

// The beginning of `text`, which is UTF-8: at most `most` bytes, and no part of a character.
// Protobuf refuses to read what ends in one.
std::string Beginning(std::string_view text, size_t most);

// A value; not thread-safe.
class FaultList {
 public:
  // At most this many are reported.
  static constexpr int kMost = 20;

  // Whether `status` is a fault of the request, of which there may be several, and not a limit.
  static bool IsFault(const absl::Status& status) {
    return absl::IsInvalidArgument(status) || absl::IsUnimplemented(status);
  }

  // Adds the faults of `status`; nothing if it is OK. The first one gives code and message.
  void Add(const absl::Status& status);

  bool empty() const { return status_.ok(); }

  // No more are reported: there is no need to look for any.
  bool full() const { return count_ >= kMost; }

  // OK if there are none.
  const absl::Status& status() const { return status_; }

 private:
  absl::Status status_;
  int count_ = 0;
};

// `status`; if it is a fault, with its field as google.rpc.BadRequest if it has none yet, and with
// google.rpc.ErrorInfo.
absl::Status WithDetails(absl::Status status);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_TRANSLATE_FAULT_LIST_H_
