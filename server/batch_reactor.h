// OptimizeBatch: a whole job in one message.

#ifndef TRAVERSE_SERVER_BATCH_REACTOR_H_
#define TRAVERSE_SERVER_BATCH_REACTOR_H_

#include <grpcpp/support/server_callback.h>

#include <string>

#include "server/job_stream.h"

namespace traverse {

// Deletes itself when the call is done.
class BatchReactor : public grpc::ServerWriteReactor<grpc::ByteBuffer>, private JobStream {
 public:
  // Reads `request`, which is emptied as soon as it is parsed. Returns the reactor of the call.
  static BatchReactor* Start(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call,
                             const absl::Status& authorized, grpc::ByteBuffer& request);

 private:
  BatchReactor(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call,
               grpc::ByteBuffer& request)
      : JobStream(core, context, std::move(call)), request_(request) {}

  void Run(const absl::Status& authorized);
  absl::Status ReadJob();

  // grpc::ServerWriteReactor.
  void OnWriteDone(bool ok) override { run()->OnWriteDone(ok); }
  void OnCancel() override { OnCallCancelled(); }
  void OnDone() override { delete this; }

  // JobStream.
  void StartWrite(std::string message, bool more_follows) override;
  void OnRoom() override {}
  void FinishCall(const grpc::Status& status) override {
    grpc::ServerWriteReactor<grpc::ByteBuffer>::Finish(status);
  }
  std::string Encode(const LayerOutcome& outcome, uint64_t id) const override;
  std::string Encode(const v1::JobSummary& summary) const override;

  grpc::ByteBuffer& request_;
  grpc::ByteBuffer write_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_BATCH_REACTOR_H_
