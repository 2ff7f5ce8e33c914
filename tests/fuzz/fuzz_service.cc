// Bytes as a request to the whole service, over an in-process channel.
//
// Rules: every call ends, in time, with a status that the API knows, never INTERNAL; and an OK
// comes with one answer for each layer, each a route of that layer, and one summary.

#include <google/protobuf/stubs/logging.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/api/job_result.h"
#include "server/server.h"
#include "tests/fuzz/support/check.h"
#include "tests/fuzz/support/seed_jobs.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::fuzz {
namespace {

constexpr auto kDeadline = std::chrono::milliseconds(300);

// The status may be late on a busy machine under sanitizers; a call that hangs is later than that.
constexpr auto kPatience = std::chrono::seconds(15);

struct Answer {
  std::vector<std::string> messages;
  grpc::Status status;
};

class Service {
 public:
  Service() {
    google::protobuf::SetLogHandler(nullptr);
    ServerOptions options = ServerOptions::Embedded(2);
    options.service.limits.max_points_per_layer = 5000;
    options.service.limits.max_layers_per_message = 100;
    auto server = Server::Start(options);
    Check(server.ok(), "the service starts");
    server_ = *std::move(server);
    stub_ = std::make_unique<grpc::GenericStub>(server_->InProcessChannel({}));
  }

  // Sends `message`, alone, to `method`.
  Answer Call(const std::string& method, const std::string& message) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + kDeadline);
    const auto call =
        stub_->PrepareCall(&context, "/traverse.v1.RouteOptimizerService/" + method, &queue_);
    call->StartCall(nullptr);
    Wait();
    const grpc::Slice slice(message);
    call->WriteLast(grpc::ByteBuffer(&slice, 1), grpc::WriteOptions(), nullptr);
    Wait();
    Answer answer;
    for (grpc::ByteBuffer buffer;; buffer.Clear()) {
      call->Read(&buffer, nullptr);
      if (!Wait()) break;
      grpc::Slice whole;
      Check(buffer.DumpToSingleSlice(&whole).ok(), "an answer has bytes");
      answer.messages.emplace_back(reinterpret_cast<const char*>(whole.begin()), whole.size());
    }
    call->Finish(&answer.status, nullptr);
    Wait();
    return answer;
  }

  std::string MetricsText() { return server_->core().MetricsText(); }

 private:
  bool Wait() {
    void* tag = nullptr;
    bool ok = false;
    const auto end = std::chrono::system_clock::now() + kPatience;
    const auto next = queue_.AsyncNext(&tag, &ok, end);
    Check(next == grpc::CompletionQueue::GOT_EVENT, "a call ends in time");
    return ok;
  }

  std::unique_ptr<Server> server_;
  std::unique_ptr<grpc::GenericStub> stub_;
  grpc::CompletionQueue queue_;
};

Service& TheService() {
  static Service* service = new Service();  // lives until the process ends
  return *service;
}

void CheckStatus(const std::string& method, const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::OK:
      return;
    case grpc::StatusCode::INVALID_ARGUMENT:
    case grpc::StatusCode::UNIMPLEMENTED:
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return Check(!status.error_message().empty(), "a refusal says why");
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return;
    default:
      Check(false, absl::StrCat(method, " ended with ", status.error_code(), ": ",
                                status.error_message()));
  }
}

template <typename Response>
void CheckAnswers(const v1::OptimizeBatchRequest& request, const Answer& answer) {
  std::vector<int> answers(static_cast<size_t>(request.layers_size()));
  int summaries = 0;
  for (const std::string& bytes : answer.messages) {
    Response response;
    Check(response.ParseFromString(bytes), "an answer parses");
    if (response.has_summary()) {
      ++summaries;
      continue;
    }
    const uint64_t index = response.layer().index();
    Check(response.has_layer() && index < answers.size(), "an answer is for a layer");
    ++answers[index];
    if (!response.layer().fault().empty()) {
      Check(request.options().partial_answers(), "only who asks for it gets part of the answers");
      Check(response.layer().visits().empty(), "a layer at fault has no route");
      continue;
    }
    const absl::Status route =
        CheckVisits(request.layers(static_cast<int>(index)), response.layer());
    Check(route.ok(), absl::StrCat("an answer is a route: ", route.ToString()));
  }
  const bool only_checked = request.options().validate_only();
  Check(summaries == (only_checked ? 0 : 1), "a job has one summary, one that is checked none");
  for (const int count : answers) {
    Check(count == (only_checked ? 0 : 1), "each layer has one answer, if it is not only checked");
  }
}

}  // namespace
}  // namespace traverse::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace traverse;
  const std::string message(reinterpret_cast<const char*>(data), size);
  fuzz::Service& service = fuzz::TheService();
  v1::OptimizeBatchRequest request;
  const bool parses = request.ParseFromString(message);
  // The requests of both calls have the same fields.
  if (size % 2 == 0) {
    const fuzz::Answer answer = service.Call("OptimizeBatch", message);
    fuzz::CheckStatus("OptimizeBatch", answer.status);
    if (answer.status.ok()) {
      fuzz::Check(parses, "what is answered parses");
      fuzz::CheckAnswers<v1::OptimizeBatchResponse>(request, answer);
    }
  } else {
    const fuzz::Answer answer = service.Call("Optimize", message);
    fuzz::CheckStatus("Optimize", answer.status);
    if (answer.status.ok()) {
      fuzz::Check(parses, "what is answered parses");
      fuzz::CheckAnswers<v1::OptimizeResponse>(request, answer);
    }
  }
  static uint64_t runs = 0;
  if (++runs % 64 == 0) {
    fuzz::Check(
        service.MetricsText().find("\ntraverse_invalid_routes_total 0\n") != std::string::npos,
        "no strategy made an invalid route");
    fuzz::CheckStatus("ListStrategies", service.Call("ListStrategies", message).status);
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  return traverse::fuzz::MutateJob(data, size, max_size, seed);
}
