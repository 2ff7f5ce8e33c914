// How long gRPC lets calls wait before anybody looks at them.
//
// gRPC 1.51 reads all connections by the same few threads, and says nothing of how late they are. A
// caller who keeps them busy makes everybody wait, whatever is done with his calls in the end. So
// calls are sent through a connection of the process to itself.

#ifndef TRAVERSE_SERVER_NET_LAG_PROBE_H_
#define TRAVERSE_SERVER_NET_LAG_PROBE_H_

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/server.h>

#include <chrono>
#include <memory>

#include "engine/base/mutex.h"

namespace traverse {

// Look is for one thread.
class LagProbe {
 public:
  // `server` has been started; it is not shut down before this has ended.
  explicit LagProbe(grpc::Server& server) : server_(server) {}

  // Waits for the call under way.
  ~LagProbe();

  LagProbe(const LagProbe&) = delete;
  LagProbe& operator=(const LagProbe&) = delete;

  // How long the last call took, or how long the one under way has by now. Sends the next one if
  // none is under way.
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
  std::unique_ptr<grpc::GenericStub> stub_;  // null: to be connected
  std::unique_ptr<Call> call_;
  Mutex mutex_;
  ConditionVariable done_;
  bool under_way_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool failed_ TRAVERSE_GUARDED_BY(mutex_) = false;  // the last one
  Clock::time_point ended_ TRAVERSE_GUARDED_BY(mutex_);
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_LAG_PROBE_H_
