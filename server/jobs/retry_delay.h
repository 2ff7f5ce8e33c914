// The advice when to try again, carried by an absl::Status.

#ifndef TRAVERSE_SERVER_JOBS_RETRY_DELAY_H_
#define TRAVERSE_SERVER_JOBS_RETRY_DELAY_H_

#include "absl/status/status.h"
#include "absl/time/time.h"

namespace traverse {

// `status` with the advice to try again after `delay`: a payload google.rpc.RetryInfo, which
// ToGrpcStatus puts into the error details.
absl::Status WithRetryDelay(absl::Status status, absl::Duration delay);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_RETRY_DELAY_H_
