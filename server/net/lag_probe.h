// Measures how long gRPC lets calls wait before it processes them.
//
// gRPC 1.51 reads all connections with the same few threads and does not report how late they are.
// A caller who keeps them busy makes everybody wait, whatever becomes of that caller's calls. So
// this sends calls through a connection of the process to itself.

#ifndef TRAVERSE_SERVER_NET_LAG_PROBE_H_
#define TRAVERSE_SERVER_NET_LAG_PROBE_H_

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/server.h>

#include <chrono>
#include <memory>

#include "engine/base/mutex.h"

namespace traverse {

// Only one thread may call Look.
class LagProbe {
 public:
  // `server` has been started; do not shut it down before this object is destroyed.
  explicit LagProbe(grpc::Server& server) : server_(server) {}

  // Waits for the running call.
  ~LagProbe();

  LagProbe(const LagProbe&) = delete;
  LagProbe& operator=(const LagProbe&) = delete;

  // How long the last call took, or how long the running one has taken so far. Sends the next one
  // if none is running.
  std::chrono::duration<double> Look();

 private:
  using Clock = std::chrono::steady_clock;

  // One call to the health service.
  struct Call {
    grpc::ClientContext context;
    grpc::ByteBuffer request;
    grpc::ByteBuffer response;
    Clock::time_point begun = Clock::now();
  };

  bool Connect();
  void Send();

  grpc::Server& server_;
  std::unique_ptr<grpc::GenericStub> stub_;  // null: not connected yet
  std::unique_ptr<Call> call_;
  Mutex mutex_;
  ConditionVariable done_;
  bool under_way_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool failed_ TRAVERSE_GUARDED_BY(mutex_) = false;  // the last one
  Clock::time_point ended_ TRAVERSE_GUARDED_BY(mutex_);
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_LAG_PROBE_H_
