// The gRPC calls that wait for their client, so that one that has stopped can be ended.

#ifndef TRAVERSE_CLIENT_GATEWAY_GRPC_LIVE_CALLS_H_
#define TRAVERSE_CLIENT_GATEWAY_GRPC_LIVE_CALLS_H_

#include <grpcpp/server_context.h>

#include <chrono>
#include <map>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "engine/base/mutex.h"
#include "server/ops/periodic.h"

namespace traverse::gateway {

// Thread-safe.
class LiveCalls {
 public:
  explicit LiveCalls(absl::Duration idle_time)
      : idle_time_(idle_time), sweep_(std::chrono::seconds(1), [this] { Sweep(); }) {}

  // From now on `context` waits for its client. Call it again whenever the client has acted.
  void Waits(grpc::CallbackServerContext* context) {
    MutexLock lock(mutex_);
    since_[context] = absl::Now();
  }

  // The call no longer waits. Call it before the context is destroyed.
  void Rests(grpc::CallbackServerContext* context) {
    MutexLock lock(mutex_);
    since_.erase(context);
  }

 private:
  void Sweep() {
    MutexLock lock(mutex_);
    const absl::Time latest = absl::Now() - idle_time_;
    for (const auto& [context, since] : since_) {
      if (since < latest) context->TryCancel();
    }
  }

  const absl::Duration idle_time_;
  Mutex mutex_;
  std::map<grpc::CallbackServerContext*, absl::Time> since_ TRAVERSE_GUARDED_BY(mutex_);
  Periodic sweep_;  // last: uses the other members
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GRPC_LIVE_CALLS_H_
