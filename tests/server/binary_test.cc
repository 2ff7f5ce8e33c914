// The binary over real sockets: ports, metrics, health, reflection, signals, exit codes.

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/impl/client_unary_call.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/support/server_process.h"
#include "tests/server/support/service_fixture.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse::testing {
namespace {

using ::testing::HasSubstr;

std::unique_ptr<v1::RouteOptimizerService::Stub> Connect(const ServerProcess& server) {
  return v1::RouteOptimizerService::NewStub(
      grpc::CreateChannel(server.address(), grpc::InsecureChannelCredentials()));
}

// Runs a job to its end; the number of layers that came back, or -1.
int RunJob(v1::RouteOptimizerService::Stub& stub, const v1::OptimizeBatchRequest& request) {
  grpc::ClientContext context;
  const auto reader = stub.OptimizeBatch(&context, request);
  int layers = 0;
  v1::OptimizeBatchResponse response;
  while (reader->Read(&response)) layers += response.has_layer() ? 1 : 0;
  return reader->Finish().ok() ? layers : -1;
}

// Messages of the health service, by hand: {1: service} and {1: status}; SERVING is 1.
int HealthStatus(const std::string& address, const std::string& service) {
  const auto channel = grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
  const std::string request =
      service.empty() ? "" : std::string("\x0a") + static_cast<char>(service.size()) + service;
  const grpc::Slice slice(request);
  const grpc::ByteBuffer message(&slice, 1);
  grpc::ByteBuffer response;
  grpc::ClientContext context;
  const grpc::internal::RpcMethod method("/grpc.health.v1.Health/Check",
                                         grpc::internal::RpcMethod::NORMAL_RPC);
  const grpc::Status status =
      grpc::internal::BlockingUnaryCall(channel.get(), method, &context, message, &response);
  if (!status.ok()) return -static_cast<int>(status.error_code());
  grpc::Slice bytes;
  if (!response.DumpToSingleSlice(&bytes).ok() || bytes.size() != 2) return 0;
  return bytes.begin()[1];
}

TEST(Binary, AnswersJobsAndCountsThem) {
  ServerProcess server;
  const auto stub = Connect(server);

  EXPECT_EQ(RunJob(*stub, MakeBatch(10)), 10);

  EXPECT_EQ(server.Metric("traverse_layers_total{stop=\"LOCAL_OPTIMUM\",strategy=\"none\"}"), 10);
  EXPECT_GT(server.Metric("process_resident_memory_bytes"), 1e6);
  EXPECT_GE(server.Metric("process_heap_used_bytes"), 0);
  EXPECT_GE(server.Metric("process_heap_free_bytes"), 0);
  int status = 0;
  EXPECT_EQ(server.Get("/healthz", &status), "ok\n");
  EXPECT_EQ(status, 200);
  EXPECT_EQ(server.Get("/readyz", &status), "ready\n");
  EXPECT_EQ(status, 200);
  server.Get("/etc/passwd", &status);
  EXPECT_EQ(status, 404);
}

TEST(Binary, HealthKnowsTheServiceByName) {
  ServerProcess server;

  EXPECT_EQ(HealthStatus(server.address(), ""), 1);
  EXPECT_EQ(HealthStatus(server.address(), "traverse.v1.RouteOptimizerService"), 1);
  EXPECT_EQ(HealthStatus(server.address(), "no.such.Service"), -grpc::StatusCode::NOT_FOUND);
}

TEST(Binary, LogsOneLineOfJsonForEachJob) {
  ServerProcess server;
  const auto stub = Connect(server);
  v1::OptimizeBatchRequest request = MakeBatch(3);
  request.mutable_options()->set_job_id("a \"quoted\"\nid");
  grpc::ClientContext context;
  context.AddMetadata("traceparent", "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01");
  const auto reader = stub->OptimizeBatch(&context, request);
  v1::OptimizeBatchResponse response;
  while (reader->Read(&response)) {
  }
  ASSERT_TRUE(reader->Finish().ok());
  server.process().Signal(SIGTERM);
  ASSERT_EQ(server.process().Wait(), 0);

  std::istringstream lines(server.process().Errors());
  int jobs = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("\"event\":\"job\"") == std::string::npos) continue;
    ++jobs;
    for (const char* const field :
         {R"("job_id":"a \"quoted\"\nid")", R"("layers":3,)", R"("points":36,)", R"("code":"OK")",
          R"("strategy":"none")", R"("trace_id":"4bf92f3577b34da6a3ce929d0e0e4736")",
          R"("caller":"ipv4:127.0.0.1")"}) {
      EXPECT_THAT(line, HasSubstr(field));
    }
  }
  EXPECT_EQ(jobs, 1);
}

TEST(Binary, SigtermLetsTheJobUnderWayFinish) {
  ServerProcess server;
  const auto stub = Connect(server);
  grpc::ClientContext context;
  const auto stream = stub->Optimize(&context);
  v1::OptimizeRequest message;
  message.mutable_options()->mutable_strategy()->set_name("none");
  *message.add_layers() = MakeLayer(1);
  ASSERT_TRUE(stream->Write(message));
  v1::OptimizeResponse response;
  ASSERT_TRUE(stream->Read(&response));

  server.process().Signal(SIGTERM);
  int ready = 200;
  ASSERT_TRUE(TestService::Eventually([&] {
    server.Get("/readyz", &ready);
    return ready == 503;
  }));
  EXPECT_EQ(HealthStatus(server.address(), "traverse.v1.RouteOptimizerService"), 2);
  EXPECT_EQ(RunJob(*stub, MakeBatch(1)), -1);
  message.clear_options();
  ASSERT_TRUE(stream->Write(message));
  stream->WritesDone();
  int messages = 1;
  while (stream->Read(&response)) ++messages;

  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_EQ(messages, 3);  // two layers and the summary
  EXPECT_EQ(server.process().Wait(), 0);
}

TEST(Binary, StreamWithoutLayersIsAnsweredAtOnce) {
  ServerProcess server;
  const auto stub = Connect(server);
  grpc::ClientContext context;
  // Far below --keepalive_time, whose pings push out what the transport holds back.
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));

  const auto stream = stub->Optimize(&context);
  stream->WritesDone();
  v1::OptimizeResponse response;

  EXPECT_TRUE(stream->Read(&response));
  EXPECT_TRUE(response.has_summary());
  EXPECT_FALSE(stream->Read(&response));
  EXPECT_TRUE(stream->Finish().ok());
}

TEST(Binary, SecondSigtermEndsAtOnce) {
  ServerProcess server({"--drain_timeout=1h"});
  const auto stub = Connect(server);
  grpc::ClientContext context;
  const auto stream = stub->Optimize(&context);
  v1::OptimizeRequest message;
  *message.add_layers() = MakeLayer(1);
  stream->Write(message);
  v1::OptimizeResponse response;
  ASSERT_TRUE(stream->Read(&response));

  server.process().Signal(SIGTERM);
  int ready = 200;
  ASSERT_TRUE(TestService::Eventually([&] {
    server.Get("/readyz", &ready);
    return ready == 503;
  }));
  server.process().Signal(SIGTERM);

  EXPECT_EQ(server.process().Wait(), 128 + SIGTERM);
  EXPECT_FALSE(stream->Read(&response));
  EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST(Binary, StartFailsWithOneLine) {
  ServerProcess first;
  const std::string taken = "--listen=" + first.address();
  ChildProcess second({TRAVERSE_SERVER_BINARY, taken, "--metrics_listen="});

  EXPECT_EQ(second.Wait(), 1);
  EXPECT_EQ(second.Errors(),
            "traverse-server: cannot listen on " + first.address() + ": Address already in use\n");

  ChildProcess no_log({TRAVERSE_SERVER_BINARY, "--listen=127.0.0.1:0",
                       "--metrics_listen=", "--log_file=/proc/no_such_folder/log"});
  EXPECT_EQ(no_log.Wait(), 1);
  EXPECT_THAT(no_log.Errors(), HasSubstr("/proc/no_such_folder"));
}

TEST(Binary, UsageErrorsExitWith2AndOneLine) {
  const std::string config = ::testing::TempDir() + "server_usage_" + std::to_string(getpid());
  std::ofstream(config) << "# a farm\nthreads = 2\nthread = 2\n";
  const struct {
    std::vector<std::string> arguments;
    std::string line;
  } cases[] = {
      {{"--no_such_flag"}, "unknown flag --no_such_flag; --help lists all flags"},
      {{"--no_such_flag=1"}, "unknown flag --no_such_flag; --help lists all flags"},
      {{"--nothreads"}, "unknown flag --nothreads; --help lists all flags"},
      {{"--flagfile=/no/such/file"}, "/no/such/file: cannot be read"},
      {{"file.gcode"}, "unexpected argument \"file.gcode\""},
      {{"--", "--insecure"}, "unexpected argument \"--\""},
      {{"--threads=x"}, "\"x\" is not a value of --threads"},
      {{"--threads", "2x"}, "\"2x\" is not a value of --threads"},
      {{"--max_wait=5"}, "\"5\" is not a value of --max_wait"},
      {{"--insecure=perhaps"}, "\"perhaps\" is not a value of --insecure"},
      {{"--threads=-1"}, "--threads: -1 is below 0"},
      {{"--max_jobs"}, "--max_jobs: the value is missing"},
      {{"--config"}, "--config: the value is missing"},
      {{"--config=/no/such/file"}, "/no/such/file: cannot be read"},
      {{"--config=" + config}, config + ":3: unknown flag --thread; --help lists all flags"},
  };
  for (const auto& bad : cases) {
    std::vector<std::string> line = {TRAVERSE_SERVER_BINARY};
    line.insert(line.end(), bad.arguments.begin(), bad.arguments.end());
    ChildProcess process(line);
    EXPECT_EQ(process.Wait(), 2) << bad.line;
    EXPECT_EQ(process.Errors(), "traverse-server: " + bad.line + "\n");
  }
}

TEST(Binary, FlagsAreReadInAllTheirForms) {
  const std::string config = ::testing::TempDir() + "server_forms_" + std::to_string(getpid());
  std::ofstream(config) << "threads = 3\n--reflection=false\n--insecure\n";
  ServerProcess server({"--flagfile=" + config, "--config", config, "--noreflection", "-threads=5",
                        "--insecure", "--max_jobs", "7", "--log_file="});

  EXPECT_EQ(server.Metric("traverse_workers"), 5);
}

TEST(Binary, HelpListsTheFlags) {
  ChildProcess help({TRAVERSE_SERVER_BINARY, "--threads=x", "--help"});

  EXPECT_THAT(help.ReadLine(), HasSubstr("Finds short routes"));
  std::string all;
  for (std::string line = help.ReadLine(); all.find("--window_points") == std::string::npos;
       line = help.ReadLine()) {
    ASSERT_LT(all.size(), 100'000u);
    all += line + "\n";
  }
  EXPECT_THAT(all, HasSubstr("--max_jobs=256"));
  EXPECT_EQ(help.Wait(), 0);
}

TEST(Binary, PrintsItsVersion) {
  ChildProcess version({TRAVERSE_SERVER_BINARY, "--version"});

  EXPECT_THAT(version.ReadLine(), HasSubstr("traverse-server 0."));
  EXPECT_EQ(version.Wait(), 0);
}

}  // namespace
}  // namespace traverse::testing
