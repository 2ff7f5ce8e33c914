// What the reactors of both calls that bring jobs share, whatever their messages are called.

#ifndef TRAVERSE_SERVER_RPC_JOB_REACTOR_H_
#define TRAVERSE_SERVER_RPC_JOB_REACTOR_H_

#include <grpcpp/support/server_callback.h>

#include <memory>
#include <string>
#include <utility>

#include "server/rpc/job_stream.h"
#include "server/rpc/wire.h"

namespace traverse {

// A bidirectional reactor, so that it is called when the headers have arrived: a job that can be
// refused by its headers is refused before its message comes. One read and one write at a time.
// Deletes itself when the call is done.
template <typename Request, typename Response>
class JobReactor : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                   protected JobStream {
 protected:
  JobReactor(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call)
      : JobStream(core, context, std::move(call)), context_(context) {}

  // Admits the call and reads its first message, or ends it; see JobStream::Admit.
  void Open(const absl::Status& authorized, int64_t points) {
    if (const absl::Status status = Admit(authorized, points); !status.ok()) {
      End(status);
    } else {
      ReadNext();
    }
  }

  void ReadNext() { StartRead(&incoming_); }

  // A message has arrived, or (`ok` false) no more will. A status other than OK ends the
  // job.
  virtual absl::Status OnRead(bool ok) = 0;

  bool is_cancelled() const { return context_.IsCancelled(); }
  grpc::ByteBuffer& incoming() { return incoming_; }

 private:
  using Bidi = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

  // grpc::ServerBidiReactor.
  void OnReadDone(bool ok) final {
    const std::shared_ptr<JobRun> run = this->run();
    if (!run->Hold()) return;
    if (const absl::Status status = OnRead(ok); !status.ok()) run->Abort(status);
    run->Release();  // may end the call
  }
  void OnWriteDone(bool ok) final { AnswerWritten(ok); }
  void OnCancel() final { OnCallCancelled(); }
  void OnDone() final { delete this; }

  // JobStream.
  const char* RequestType() const final { return Request::descriptor()->full_name().c_str(); }
  void StartWrite(std::string message, bool more_follows) final {
    grpc::WriteOptions options;
    if (more_follows) options.set_buffer_hint();
    Bidi::StartWrite(Outgoing(message), options);
  }
  void FinishCall(const grpc::Status& status) final { Bidi::Finish(status); }
  std::string Encode(const LayerOutcome& outcome, uint64_t id) const final {
    return Serialize<Response>([&](Response& response) {
      ToProto(outcome, id, setup().strategy_name, *response.mutable_layer());
    });
  }
  std::string Encode(const v1::LayerResult& result) const final {
    return Serialize<Response>([&](Response& response) { *response.mutable_layer() = result; });
  }
  std::string Encode(const v1::JobSummary& summary) const final {
    return Serialize<Response>([&](Response& response) { *response.mutable_summary() = summary; });
  }

  grpc::CallbackServerContext& context_;
  grpc::ByteBuffer incoming_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_JOB_REACTOR_H_
