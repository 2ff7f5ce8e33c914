// Optimize: a job of any size, its layers as they come.

#ifndef TRAVERSE_SERVER_RPC_STREAM_REACTOR_H_
#define TRAVERSE_SERVER_RPC_STREAM_REACTOR_H_

#include <grpcpp/support/server_callback.h>

#include <string>

#include "server/rpc/job_stream.h"

namespace traverse {

// One read at a time, and none while the job has enough under way: the flow control of the
// transport then holds back the caller. Deletes itself when the call is done.
class StreamReactor : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                      private JobStream {
 public:
  static StreamReactor* Start(ServiceCore& core, grpc::CallbackServerContext& context,
                              CallInfo call, const absl::Status& authorized);

 private:
  using Bidi = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

  StreamReactor(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call)
      : JobStream(core, context, std::move(call)), context_(context) {}

  void ReadNext();
  absl::Status OnEnd();

  // grpc::ServerBidiReactor.
  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override { AnswerWritten(ok); }
  void OnCancel() override { OnCallCancelled(); }
  void OnDone() override { delete this; }

  // JobStream.
  const char* RequestType() const override { return "traverse.v1.OptimizeRequest"; }
  absl::Status OnOptions(const RequestReader& message) override;
  void OnMessageRead() override;
  bool MoreFollowsMessage() const override { return setup().look_ahead; }
  void StartWrite(std::string message, bool more_follows) override;
  void OnRoom() override { ReadNext(); }
  void FinishCall(const grpc::Status& status) override { Bidi::Finish(status); }
  std::string Encode(const LayerOutcome& outcome, uint64_t id) const override;
  std::string Encode(const v1::JobSummary& summary) const override;

  grpc::CallbackServerContext& context_;
  bool begun_ = false;
  grpc::ByteBuffer read_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_STREAM_REACTOR_H_
