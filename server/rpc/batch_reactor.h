// OptimizeBatch: a whole job in one message.

#ifndef TRAVERSE_SERVER_RPC_BATCH_REACTOR_H_
#define TRAVERSE_SERVER_RPC_BATCH_REACTOR_H_

#include <utility>

#include "server/rpc/job_reactor.h"

namespace traverse {

class BatchReactor : public JobReactor<v1::OptimizeBatchRequest, v1::OptimizeBatchResponse> {
 public:
  static BatchReactor* Start(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call,
                             const absl::Status& authorized);

 private:
  using JobReactor::JobReactor;

  absl::Status OnRead(bool ok) override;
  absl::Status OnOptions(const RequestReader& message) override { return Begin(message.options()); }
  void OnMessageRead() override;
  bool MoreFollowsMessage() const override { return true; }
  void OnRoom() override {}
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_BATCH_REACTOR_H_
