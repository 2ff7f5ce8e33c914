// A job that stays open until the test ends it.

#ifndef TRAVERSE_TESTS_SERVER_SUPPORT_OPEN_STREAM_H_
#define TRAVERSE_TESTS_SERVER_SUPPORT_OPEN_STREAM_H_

#include <grpcpp/grpcpp.h>

#include <memory>

#include "tests/server/support/service_fixture.h"

namespace traverse::testing {

// One of several jobs at once, each of which the test ends when it wants.
class OpenStream {
 public:
  explicit OpenStream(TestService& service) : stream_(service.stub().Optimize(&context_)) {
    v1::OptimizeRequest message;
    message.mutable_options()->mutable_strategy()->set_name("none");
    *message.add_layers() = MakeLayer(1);
    stream_->Write(message);
  }

  // The first message that comes back; false if the call ended instead.
  bool ReadLayer() {
    v1::OptimizeResponse response;
    return stream_->Read(&response) && response.has_layer();
  }

  // Ends the job.
  grpc::Status Finish() {
    stream_->WritesDone();
    return WaitForEnd();
  }

  // Waits until the server ends it.
  grpc::Status WaitForEnd() {
    v1::OptimizeResponse response;
    while (stream_->Read(&response)) {
    }
    return stream_->Finish();
  }

  grpc::ClientContext& context() { return context_; }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::OptimizeRequest, v1::OptimizeResponse>> stream_;
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SERVER_SUPPORT_OPEN_STREAM_H_
