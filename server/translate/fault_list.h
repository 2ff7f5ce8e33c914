// The faults of a request, all of which its caller is told at once.
//
//   FaultList faults;
//   for (const auto& path : paths) faults.Add(Check(path));
//   return faults.status();
//
// A status carries its faults as google.rpc.BadRequest, so that lists within lists become one.

#ifndef TRAVERSE_SERVER_TRANSLATE_FAULT_LIST_H_
#define TRAVERSE_SERVER_TRANSLATE_FAULT_LIST_H_

#include "absl/status/status.h"

namespace traverse {

// A value; not thread-safe.
class FaultList {
 public:
  // So many are told.
  static constexpr int kMost = 20;

  // Whether `status` is a fault of a request, of which there may be several, and not a limit.
  static bool IsFault(const absl::Status& status) {
    return absl::IsInvalidArgument(status) || absl::IsUnimplemented(status);
  }

  // Adds what `status` tells; nothing if it is OK. The first one gives code and message.
  void Add(const absl::Status& status);

  bool empty() const { return status_.ok(); }

  // No more are told: there is no need to look for any.
  bool full() const { return count_ >= kMost; }

  // OK if there are none.
  const absl::Status& status() const { return status_; }

 private:
  absl::Status status_;
  int count_ = 0;
};

// `status`, if it is a fault, with its field as google.rpc.BadRequest, where it has none yet, and
// with google.rpc.ErrorInfo.
absl::Status WithDetails(absl::Status status);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_TRANSLATE_FAULT_LIST_H_
