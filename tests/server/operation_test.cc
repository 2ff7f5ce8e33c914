// What an operator does to the binary and sees of it: signals, the log, the port for metrics.

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <google/protobuf/stubs/logging.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/server/support/server_process.h"
#include "tests/server/support/service_fixture.h"
#include "tests/support/scratch_folder.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::unique_ptr<v1::RouteOptimizerService::Stub> Connect(const ServerProcess& server) {
  return v1::RouteOptimizerService::NewStub(
      grpc::CreateChannel(server.address(), grpc::InsecureChannelCredentials()));
}

grpc::Status RunJob(v1::RouteOptimizerService::Stub& stub,
                    const v1::OptimizeBatchRequest& request) {
  grpc::ClientContext context;
  const auto reader = stub.OptimizeBatch(&context, request);
  v1::OptimizeBatchResponse response;
  while (reader->Read(&response)) {
  }
  return reader->Finish();
}

std::string ReadAll(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Operation, SighupOpensTheLogAnewAndEndsNothing) {
  const ScratchFolder folder;
  const std::string path = folder.Path("log");
  ServerProcess server({"--log_file=" + path});
  const auto stub = Connect(server);
  grpc::ClientContext context;
  const auto stream = stub->Optimize(&context);
  v1::OptimizeRequest message;
  message.mutable_options()->set_job_id("under way");
  *message.add_layers() = MakeLayer(1);
  ASSERT_TRUE(stream->Write(message));
  v1::OptimizeResponse response;
  ASSERT_TRUE(stream->Read(&response));
  ASSERT_EQ(std::rename(path.c_str(), (path + ".1").c_str()), 0);

  server.process().Signal(SIGHUP);

  EXPECT_TRUE(TestService::Eventually(
      [&] { return ReadAll(path).find("\"event\":\"reloaded\"") != std::string::npos; }));
  stream->WritesDone();
  while (stream->Read(&response)) {
  }
  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_TRUE(TestService::Eventually(
      [&] { return ReadAll(path).find("under way") != std::string::npos; }));
  EXPECT_THAT(ReadAll(path + ".1"), Not(HasSubstr("under way")));
  server.process().Signal(SIGTERM);
  EXPECT_EQ(server.process().Wait(), 0);
}

TEST(Operation, SighupWhileDrainingEndsNothing) {
  ServerProcess server;
  const auto stub = Connect(server);
  grpc::ClientContext context;
  const auto stream = stub->Optimize(&context);
  v1::OptimizeRequest message;
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

  server.process().Signal(SIGHUP);
  stream->WritesDone();
  while (stream->Read(&response)) {
  }

  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_EQ(server.process().Wait(), 0);
}

TEST(Operation, LinesThatAreLostAreCounted) {
  ServerProcess server({"--log_file=/dev/full"});
  const auto stub = Connect(server);

  EXPECT_TRUE(RunJob(*stub, MakeBatch(1)).ok());

  EXPECT_TRUE(
      TestService::Eventually([&] { return server.Metric("traverse_log_lines_lost_total") >= 1; }));
}

TEST(Operation, TheLogHoldsNoControlCharactersAndNoLongNames) {
  ServerProcess server;
  const auto stub = Connect(server);
  v1::OptimizeBatchRequest request = MakeBatch(1);
  request.mutable_options()->set_job_id(
      "a\x7f"
      "b\xc2\x9b"
      "c\xc3\xa9"
      "d\xe2\x80\xae"
      "e\xe2\x81\xa6"
      "f\xd8\x9c");
  EXPECT_TRUE(RunJob(*stub, request).ok());
  request.mutable_options()->mutable_strategy()->set_name(std::string(900'000, 'n'));
  EXPECT_EQ(RunJob(*stub, request).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  request.mutable_options()->mutable_strategy()->set_name("tabu");
  (*request.mutable_options()->mutable_strategy()->mutable_options())["tenure"] =
      std::string(900'000, 'v');
  EXPECT_EQ(RunJob(*stub, request).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  request.mutable_options()->clear_strategy();
  const google::protobuf::LogSilencer silencer;  // of this side
  request.mutable_options()->set_job_id("not UTF-8: \xff");
  EXPECT_EQ(RunJob(*stub, request).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  server.process().Signal(SIGTERM);
  ASSERT_EQ(server.process().Wait(), 0);

  const std::string log = server.process().Errors();
  EXPECT_THAT(log, HasSubstr("a\\u007fb\\u009bc\xc3\xa9"
                             R"(d\u202ee\u2066f\u061c)"));
  EXPECT_THAT(log, Not(HasSubstr("\x7f")));
  EXPECT_THAT(log, Not(HasSubstr("\xc2\x9b")));
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LT(line.size(), 1000u);
    EXPECT_THAT(line, StartsWith("{\"time\":"));  // no library writes between ours
  }
}

TEST(Operation, ACallThatIsResetBeforeAnyMessageIsOfNoStrategy) {
  ServerProcess server;
  const auto stub = Connect(server);
  for (int i = 0; i < 5; ++i) {
    grpc::ClientContext context;
    const auto stream = stub->Optimize(&context);
    ASSERT_TRUE(
        TestService::Eventually([&] { return server.Metric("traverse_jobs_in_flight") == 1; }));
    context.TryCancel();
    stream->Finish();
    ASSERT_TRUE(
        TestService::Eventually([&] { return server.Metric("traverse_jobs_in_flight") == 0; }));
  }

  const std::string cancelled = "traverse_jobs_total{code=\"CANCELLED\",strategy=\"unknown\"}";
  EXPECT_TRUE(TestService::Eventually([&] { return server.Metric(cancelled) == 5; }));
  EXPECT_THAT(server.Get("/metrics"), Not(HasSubstr("strategy=\"auto\"")));
}

// A batch of so many layers, compressed by `algorithm`.
grpc::Status Send(const ServerProcess& server, int layers, grpc_compression_algorithm algorithm) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxSendMessageSize(-1);
  const auto stub = v1::RouteOptimizerService::NewStub(
      grpc::CreateCustomChannel(server.address(), grpc::InsecureChannelCredentials(), arguments));
  grpc::ClientContext context;
  context.set_compression_algorithm(algorithm);
  const auto reader = stub->OptimizeBatch(&context, MakeBatch(layers));
  v1::OptimizeBatchResponse response;
  while (reader->Read(&response)) {
  }
  return reader->Finish();
}

TEST(Operation, CompressedMessagesAreRefused) {
  ServerProcess server;

  EXPECT_EQ(Send(server, 10, GRPC_COMPRESS_GZIP).error_code(), grpc::StatusCode::UNIMPLEMENTED);
  EXPECT_EQ(Send(server, 10, GRPC_COMPRESS_DEFLATE).error_code(), grpc::StatusCode::UNIMPLEMENTED);
  EXPECT_TRUE(Send(server, 10, GRPC_COMPRESS_NONE).ok());
}

TEST(Operation, AMessageThatIsTooLargeIsCountedAsThat) {
  ServerProcess server({"--max_message_bytes=100000"});

  const grpc::Status status = Send(server, 1000, GRPC_COMPRESS_NONE);

  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("more than this server's limit of 100000"));
  EXPECT_EQ(server.Metric("traverse_rejected_total{reason=\"message\"}"), 1);
  EXPECT_EQ(server.Metric("traverse_jobs_total{code=\"RESOURCE_EXHAUSTED\",strategy=\"unknown\"}"),
            1);
}

// Connections that send next to nothing, and are never ended by their side.
class SlowConnections {
 public:
  explicit SlowConnections(int port) : port_(port) {}
  ~SlowConnections() {
    for (const int socket : sockets_) close(socket);
  }

  void Open(int count) {
    for (int i = 0; i < count; ++i) {
      const int fd = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_port = htons(static_cast<uint16_t>(port_));
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address));
      send(fd, "GET /he", 7, MSG_NOSIGNAL);
      sockets_.push_back(fd);
    }
  }

 private:
  const int port_;
  std::vector<int> sockets_;
};

TEST(Operation, SlowConnectionsDoNotFailTheLivenessProbe) {
  ServerProcess server;
  SlowConnections slow(server.metrics_port());
  const auto probe = [&server] {
    const auto begin = std::chrono::steady_clock::now();
    int status = 0;
    EXPECT_EQ(server.Get("/healthz", &status), "ok\n");
    EXPECT_EQ(status, 200);
    return std::chrono::steady_clock::now() - begin;
  };
  auto alone = probe();
  for (int i = 0; i < 20; ++i) alone = std::max(alone, probe());

  auto beside = std::chrono::steady_clock::duration::max();
  for (int round = 0; round < 20; ++round) {
    slow.Open(20);
    beside = std::min(beside, probe());
  }
  // The probe's own limit is a second; connections that are waited for cost ten of them.
  EXPECT_LT(beside, std::chrono::seconds(1) + 10 * alone);
}

}  // namespace
}  // namespace traverse::testing
