// The gRPC calls that wait for their client, so that one that has stopped can be ended.

#ifndef TRAVERSE_CLIENT_GATEWAY_GRPC_LIVE_CALLS_H_
#define TRAVERSE_CLIENT_GATEWAY_GRPC_LIVE_CALLS_H_

#include <grpcpp/server_context.h>

#include <chrono>
#include <map>
#include <string>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "engine/base/mutex.h"
#include "server/net/socket_info.h"
#include "server/ops/periodic.h"

namespace traverse::gateway {

// Thread-safe.
class LiveCalls {
 public:
  // Ends calls that wait for longer than `idle_time`, or whose transfer takes longer than
  // `transfer_time` without a pause for work.
  LiveCalls(absl::Duration idle_time, absl::Duration transfer_time)
      : idle_time_(idle_time),
        transfer_time_(transfer_time),
        sweep_(std::chrono::seconds(1), [this] { Sweep(); }) {}

  // From now on `context`, of `peer`, waits for its client. Call it again whenever the client has
  // acted.
  void Waits(grpc::CallbackServerContext* context, const std::string& peer) {
    MutexLock lock(mutex_);
    Wait& wait = waits_[context];
    wait.since = absl::Now();
    if (wait.peer.empty()) {
      wait.peer = PeerKey(peer);
      wait.began = wait.since;
    }
  }

  // The call no longer waits. Call it before the context is destroyed.
  void Rests(grpc::CallbackServerContext* context) {
    MutexLock lock(mutex_);
    waits_.erase(context);
  }

  // Ends the call of `peer` (see PeerKey) that has waited for longest. Returns false if there is
  // none.
  bool EndOne(const std::string& peer) {
    MutexLock lock(mutex_);
    auto oldest = waits_.end();
    for (auto it = waits_.begin(); it != waits_.end(); ++it) {
      if (it->second.peer != peer) continue;
      if (oldest == waits_.end() || it->second.since < oldest->second.since) oldest = it;
    }
    if (oldest == waits_.end()) return false;
    oldest->first->TryCancel();
    waits_.erase(oldest);
    return true;
  }

 private:
  struct Wait {
    absl::Time began;
    absl::Time since;
    std::string peer;  // see PeerKey
  };

  void Sweep() {
    MutexLock lock(mutex_);
    const absl::Time now = absl::Now();
    for (const auto& [context, wait] : waits_) {
      if (now - wait.since > idle_time_ || now - wait.began > transfer_time_) context->TryCancel();
    }
  }

  const absl::Duration idle_time_;
  const absl::Duration transfer_time_;
  Mutex mutex_;
  std::map<grpc::CallbackServerContext*, Wait> waits_ TRAVERSE_GUARDED_BY(mutex_);
  Periodic sweep_;  // last: uses the other members
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GRPC_LIVE_CALLS_H_
