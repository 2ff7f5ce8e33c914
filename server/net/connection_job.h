// A job as its connection sees it.

#ifndef TRAVERSE_SERVER_NET_CONNECTION_JOB_H_
#define TRAVERSE_SERVER_NET_CONNECTION_JOB_H_

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>

#include "server/net/connections.h"

namespace traverse {

// Reports a job of `peer` from its admission until gRPC is done with its call. Thread-safe.
class ConnectionJob {
 public:
  // `connections` may be null, and must outlive it.
  ConnectionJob(Connections* connections, std::string peer)
      : connections_(connections), peer_(std::move(peer)) {
    if (connections_ == nullptr) return;
    connections_->OnAuthorized(peer_);
    pending_before_ = connections_->OnJob(peer_);
  }
  ~ConnectionJob() {
    if (connections_ != nullptr) connections_->OnJobDone(peer_, pending_before_, all_came_);
  }

  ConnectionJob(const ConnectionJob&) = delete;
  ConnectionJob& operator=(const ConnectionJob&) = delete;

  // A message of `bytes` has arrived.
  void OnMessage(int64_t bytes) {
    if (connections_ != nullptr) connections_->OnMessage(peer_, bytes);
  }

  // Its messages are complete.
  void OnAllCame() { all_came_ = true; }

 private:
  Connections* const connections_;
  const std::string peer_;
  double pending_before_ = 0;
  std::atomic<bool> all_came_ = false;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_CONNECTION_JOB_H_
