// What the service costs: CPU time of the server for each layer of a stream of small layers with
// `none` through a real socket, beside that of an empty gRPC stream of messages of the same sizes,
// which is the limit of nature.
//
//   build/release/tests/bench/service/server_stream_bench [LAYERS]
//   build/release/tests/bench/service/server_stream_bench to HOST:PORT LAYERS    one stream, alone
//
// The server is the binary with its defaults. Layers: 5 islands, each one contour of 8 vertices and
// one raster.

#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/grpcpp.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/support/server_process.h"
#include "tests/server/support/service_fixture.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse::testing {
namespace {

constexpr int kRuns = 3;

// CPU seconds of a process, user and system.
double CpuSeconds(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  std::getline(file, line);
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::string skipped;
  double user = 0, system = 0;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

struct Cost {
  double cpu_seconds;
  double wall_seconds;
};

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Streams `layers` layers, `per_message` in a message, reading the answers meanwhile.
bool StreamLayers(v1::RouteOptimizerService::Stub& stub, int layers, int per_message,
                  const std::string& strategy) {
  grpc::ClientContext context;
  const auto stream = stub.Optimize(&context);
  std::thread writer([&] {
    v1::OptimizeRequest message;
    message.mutable_options()->mutable_strategy()->set_name(strategy);
    const v1::Layer layer = MakeLayer(1, 5, 8);
    for (int sent = 0; sent < layers;) {
      for (int i = 0; i < per_message && sent < layers; ++i, ++sent) *message.add_layers() = layer;
      if (!stream->Write(message)) break;
      message.Clear();
    }
    stream->WritesDone();
  });
  v1::OptimizeResponse response;
  int received = 0;
  while (stream->Read(&response)) received += response.has_layer() ? 1 : 0;
  writer.join();
  return stream->Finish().ok() && received == layers;
}

Cost Measure(v1::RouteOptimizerService::Stub& stub, pid_t server, int layers, int per_message,
             const std::string& strategy) {
  std::vector<double> cpu, wall;
  for (int run = 0; run <= kRuns; ++run) {
    const double cpu_before = CpuSeconds(server);
    const auto begin = std::chrono::steady_clock::now();
    if (!StreamLayers(stub, layers, per_message, strategy)) std::abort();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    if (run == 0) continue;  // warms up
    cpu.push_back(CpuSeconds(server) - cpu_before);
    wall.push_back(took.count());
  }
  return {Median(cpu), Median(wall)};
}

// The empty service: for each message of a stream it writes one of a result's size.
class EchoReactor : public grpc::ServerGenericBidiReactor {
 public:
  EchoReactor() {
    const std::string bytes(kAnswerBytes, 'x');
    const grpc::Slice slice(bytes);
    answer_ = grpc::ByteBuffer(&slice, 1);
    StartRead(&request_);
  }
  void OnReadDone(bool ok) override {
    if (!ok) return Finish(grpc::Status::OK);
    StartWrite(&answer_);
  }
  void OnWriteDone(bool ok) override {
    if (!ok) return Finish(grpc::Status::CANCELLED);
    StartRead(&request_);
  }
  void OnDone() override { delete this; }

 private:
  static constexpr size_t kAnswerBytes = 330;
  grpc::ByteBuffer request_;
  grpc::ByteBuffer answer_;
};

class EchoService : public grpc::CallbackGenericService {
 public:
  grpc::ServerGenericBidiReactor* CreateReactor(
      grpc::GenericCallbackServerContext* /*context*/) override {
    return new EchoReactor();
  }
};

// Runs the empty service until stdin ends.
int RunEcho() {
  EchoService service;
  grpc::ServerBuilder builder;
  int port = 0;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
  builder.RegisterCallbackGenericService(&service);
  const auto server = builder.BuildAndStart();
  std::printf("listening on port %d\n", port);
  std::fflush(stdout);
  pause();
  return 0;
}

bool StreamEcho(v1::RouteOptimizerService::Stub& stub, int messages) {
  grpc::ClientContext context;
  const auto stream = stub.Optimize(&context);
  std::thread writer([&] {
    v1::OptimizeRequest message;
    *message.add_layers() = MakeLayer(1, 5, 8);
    for (int i = 0; i < messages; ++i) stream->Write(message);
    stream->WritesDone();
  });
  v1::OptimizeResponse response;
  int received = 0;
  while (stream->Read(&response)) ++received;
  writer.join();
  stream->Finish();
  return true;
}

void Print(const char* what, int layers, const Cost& cost) {
  std::printf("%-34s %8.1f us CPU/layer %8.0f layers/s per core %8.0f layers/s wall\n", what,
              cost.cpu_seconds / layers * 1e6, layers / cost.cpu_seconds,
              layers / cost.wall_seconds);
  std::fflush(stdout);
}

// One stream to a server that runs already, under a profiler perhaps.
int RunTo(const std::string& address, int layers) {
  const auto stub = v1::RouteOptimizerService::NewStub(
      grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
  return StreamLayers(*stub, layers, 1, "none") ? 0 : 1;
}

int Run(const char* self, int layers) {
  {
    ChildProcess echo({self, "echo"});
    const std::string line = echo.ReadLine();
    const auto stub = v1::RouteOptimizerService::NewStub(grpc::CreateChannel(
        "127.0.0.1:" + line.substr(line.rfind(' ') + 1), grpc::InsecureChannelCredentials()));
    StreamEcho(*stub, layers);
    const double before = CpuSeconds(echo.pid());
    const auto begin = std::chrono::steady_clock::now();
    StreamEcho(*stub, layers);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    Print("empty gRPC stream, 1 a message", layers,
          {CpuSeconds(echo.pid()) - before, took.count()});
  }
  ServerProcess server;
  const auto stub = v1::RouteOptimizerService::NewStub(
      grpc::CreateChannel(server.address(), grpc::InsecureChannelCredentials()));
  for (const int per_message : {1, 16, 256}) {
    const std::string what = "none, " + std::to_string(per_message) + " a message";
    Print(what.c_str(), layers,
          Measure(*stub, server.process().pid(), layers, per_message, "none"));
  }
  return 0;
}

}  // namespace
}  // namespace traverse::testing

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "echo") return traverse::testing::RunEcho();
  if (command == "to" && argc == 4) return traverse::testing::RunTo(argv[2], std::atoi(argv[3]));
  return traverse::testing::Run(argv[0], argc > 1 ? std::atoi(argv[1]) : 100'000);
}
