// OptimizeBatch: a whole job in one message.

#ifndef TRAVERSE_SERVER_RPC_BATCH_REACTOR_H_
#define TRAVERSE_SERVER_RPC_BATCH_REACTOR_H_

#include <grpcpp/support/server_callback.h>

#include <string>

#include "server/rpc/job_stream.h"

namespace traverse {

// A reactor of both directions, as it is called when the headers are there: a job that can be
// refused for them is refused before its message has come. Deletes itself when the call is done.
class BatchReactor : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                     private JobStream {
 public:
  static BatchReactor* Start(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call,
                             const absl::Status& authorized);

 private:
  using Bidi = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

  BatchReactor(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call)
      : JobStream(core, context, std::move(call)), context_(context) {}

  absl::Status OnRequest(bool ok);

  // grpc::ServerBidiReactor.
  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override { AnswerWritten(ok); }
  void OnCancel() override { OnCallCancelled(); }
  void OnDone() override { delete this; }

  // JobStream.
  const char* RequestType() const override { return "traverse.v1.OptimizeBatchRequest"; }
  absl::Status OnOptions(const RequestReader& message) override { return Begin(message.options()); }
  void OnMessageRead() override;
  bool MoreFollowsMessage() const override { return true; }
  void StartWrite(std::string message, bool more_follows) override;
  void OnRoom() override {}
  void FinishCall(const grpc::Status& status) override { Bidi::Finish(status); }
  std::string Encode(const LayerOutcome& outcome, uint64_t id) const override;
  std::string Encode(const v1::JobSummary& summary) const override;

  grpc::CallbackServerContext& context_;
  grpc::ByteBuffer request_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_BATCH_REACTOR_H_
