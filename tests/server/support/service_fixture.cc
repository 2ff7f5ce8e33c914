#include "tests/server/support/service_fixture.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/slice.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "google/rpc/status.pb.h"

namespace traverse::testing {

std::optional<absl::Duration> RetryDelay(const grpc::Status& status) {
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) return std::nullopt;
  for (const google::protobuf::Any& any : details.details()) {
    google::rpc::RetryInfo info;
    if (any.UnpackTo(&info)) {
      return absl::Seconds(info.retry_delay().seconds()) +
             absl::Nanoseconds(info.retry_delay().nanos());
    }
  }
  return std::nullopt;
}

v1::Layer MakeLayer(uint64_t id, int islands, int vertices) {
  v1::Layer layer;
  layer.set_id(id);
  for (int i = 0; i < islands; ++i) {
    const double x = 10.0 * ((i * 7 + static_cast<int>(id)) % std::max(1, islands));
    v1::Island& island = *layer.add_islands();
    v1::Contour& contour = *island.add_contours();
    for (int v = 0; v < vertices; ++v) {
      contour.add_points(x + v % 3);
      contour.add_points(v);
    }
    v1::OpenPath& raster = *island.add_rasters();
    for (const double coordinate : {x, 1.0, x + 2, 1.0}) raster.add_points(coordinate);
  }
  return layer;
}

v1::OptimizeBatchRequest MakeBatch(int layers, const std::string& strategy) {
  v1::OptimizeBatchRequest request;
  request.mutable_options()->mutable_strategy()->set_name(strategy);
  for (int i = 0; i < layers; ++i) *request.add_layers() = MakeLayer(static_cast<uint64_t>(i + 1));
  return request;
}

TestService::TestService(const std::function<void(ServerOptions&)>& change) {
  ServerOptions options;
  options.service.threads = 2;
  options.service.log = false;
  if (change) change(options);
  absl::StatusOr<std::unique_ptr<Server>> server = Server::Start(options);
  if (!server.ok()) {
    std::cerr << server.status() << "\n";
    std::abort();
  }
  server_ = *std::move(server);
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  channel_ = options.listen.empty()
                 ? server_->InProcessChannel(arguments)
                 : grpc::CreateCustomChannel(absl::StrCat("127.0.0.1:", server_->port()),
                                             grpc::InsecureChannelCredentials(), arguments);
  stub_ = v1::RouteOptimizerService::NewStub(channel_);
}

Answer TestService::Batch(const v1::OptimizeBatchRequest& request,
                          std::optional<absl::Duration> deadline) {
  grpc::ClientContext context;
  if (deadline) context.set_deadline(absl::ToChronoTime(absl::Now() + *deadline));
  Answer answer;
  const auto reader = stub_->OptimizeBatch(&context, request);
  v1::OptimizeBatchResponse response;
  while (reader->Read(&response)) {
    if (response.has_layer()) answer.layers.push_back(response.layer());
    if (response.has_summary()) answer.summary = response.summary();
  }
  answer.status = reader->Finish();
  return answer;
}

Answer TestService::Stream(const v1::OptimizeBatchRequest& request, int layers_per_message) {
  grpc::ClientContext context;
  Answer answer;
  const auto stream = stub_->Optimize(&context);
  std::thread writer([&] {
    v1::OptimizeRequest message;
    if (request.has_options()) *message.mutable_options() = request.options();
    for (const v1::Layer& layer : request.layers()) {
      *message.add_layers() = layer;
      if (message.layers_size() < layers_per_message) continue;
      if (!stream->Write(message)) break;
      message.Clear();
    }
    if (message.has_options() || message.layers_size() > 0) stream->Write(message);
    stream->WritesDone();
  });
  v1::OptimizeResponse response;
  while (stream->Read(&response)) {
    if (response.has_layer()) answer.layers.push_back(response.layer());
    if (response.has_summary()) answer.summary = response.summary();
  }
  writer.join();
  answer.status = stream->Finish();
  return answer;
}

grpc::Status TestService::Raw(const std::string& method, const std::string& bytes) {
  grpc::GenericStub stub(channel_);
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  const auto call =
      stub.PrepareCall(&context, "/traverse.v1.RouteOptimizerService/" + method, &queue);
  void* tag = nullptr;
  bool ok = false;
  call->StartCall(nullptr);
  queue.Next(&tag, &ok);
  const grpc::Slice slice(bytes);
  call->WriteLast(grpc::ByteBuffer(&slice, 1), grpc::WriteOptions(), nullptr);
  queue.Next(&tag, &ok);
  for (ok = true; ok;) {
    grpc::ByteBuffer response;
    call->Read(&response, nullptr);
    queue.Next(&tag, &ok);
  }
  grpc::Status status;
  call->Finish(&status, nullptr);
  queue.Next(&tag, &ok);
  return status;
}

bool TestService::Eventually(const std::function<bool()>& condition) {
  for (int i = 0; i < 5000; ++i) {
    if (condition()) return true;
    absl::SleepFor(absl::Milliseconds(1));
  }
  return condition();
}

}  // namespace traverse::testing
