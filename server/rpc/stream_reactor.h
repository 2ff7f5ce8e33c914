// Optimize: a job of any size, its layers as they come.

#ifndef TRAVERSE_SERVER_RPC_STREAM_REACTOR_H_
#define TRAVERSE_SERVER_RPC_STREAM_REACTOR_H_

#include "server/rpc/job_reactor.h"

namespace traverse {

// Does not read while enough of the job is in progress: the flow control of the transport then
// holds the caller back.
class StreamReactor : public JobReactor<v1::OptimizeRequest, v1::OptimizeResponse> {
 public:
  static StreamReactor* Start(ServiceCore& core, grpc::CallbackServerContext& context,
                              CallInfo call, const absl::Status& authorized);

 private:
  using JobReactor::JobReactor;

  void ReadIfRoom();
  absl::Status OnEnd();

  absl::Status OnRead(bool ok) override;
  absl::Status OnOptions(const RequestReader& message) override;
  void OnMessageRead() override;
  bool MoreFollowsMessage() const override { return setup().look_ahead; }
  void OnRoom() override { ReadIfRoom(); }

  bool begun_ = false;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_STREAM_REACTOR_H_
