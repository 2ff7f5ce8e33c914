// What the machine runs out of, and a clock that is set.

#include <arpa/inet.h>
#include <fcntl.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/time/clock.h"
#include "client/api/channel.h"
#include "client/api/optimizer_client.h"
#include "tests/server/support/server_process.h"
#include "tests/server/support/service_fixture.h"
#include "tests/support/scratch_folder.h"

namespace traverse::testing {
namespace {

std::vector<v1::Layer> Layers(int count, int islands = 5) {
  std::vector<v1::Layer> layers;
  for (int i = 0; i < count; ++i) layers.push_back(MakeLayer(static_cast<uint64_t>(i), islands, 8));
  return layers;
}

absl::Status RunJob(OptimizerClient& client, absl::Duration deadline = absl::Seconds(20)) {
  v1::JobOptions options;
  options.mutable_strategy()->set_name("ni2opt");
  return client.Optimize(options, Layers(10), {.deadline = deadline}).status();
}

int ConnectRaw(const std::string& address) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port =
      htons(static_cast<uint16_t>(std::atoi(address.c_str() + address.rfind(':') + 1)));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  connect(fd, reinterpret_cast<sockaddr*>(&place), sizeof(place));
  return fd;
}

int ConnectUnix(const std::string& path) {
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  path.copy(place.sun_path, sizeof(place.sun_path) - 1);
  connect(fd, reinterpret_cast<sockaddr*>(&place), sizeof(place));
  return fd;
}

// A job that is under way from its construction to its end.
class OpenJob {
 public:
  explicit OpenJob(const std::string& address)
      : stub_(v1::RouteOptimizerService::NewStub(
            grpc::CreateChannel(address, grpc::InsecureChannelCredentials()))) {
    context_.set_deadline(std::chrono::system_clock::now() + ChildProcess::kPatience);
    stream_ = stub_->Optimize(&context_);
    v1::OptimizeRequest request;
    request.mutable_options()->mutable_strategy()->set_name("greedy");
    *request.add_layers() = MakeLayer(1);
    v1::OptimizeResponse response;
    EXPECT_TRUE(stream_->Write(request));
    EXPECT_TRUE(stream_->Read(&response));
  }

  grpc::Status End() {
    stream_->WritesDone();
    v1::OptimizeResponse response;
    while (stream_->Read(&response)) {
    }
    return stream_->Finish();
  }

 private:
  const std::unique_ptr<v1::RouteOptimizerService::Stub> stub_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::OptimizeRequest, v1::OptimizeResponse>> stream_;
};

// Leaves the process `files` more than it has open.
void LimitFiles(pid_t process, rlim_t files) {
  namespace fs = std::filesystem;
  const auto open = std::distance(
      fs::directory_iterator("/proc/" + std::to_string(process) + "/fd"), fs::directory_iterator());
  const rlimit few{static_cast<rlim_t>(open) + files, static_cast<rlim_t>(open) + files};
  ASSERT_EQ(prlimit(process, RLIMIT_NOFILE, &few, nullptr), 0);
}

TEST(FileDescriptors, WhenTheyRunOutIdleConnectionsMakeRoomForJobs) {
  ServerProcess server;
  OpenJob under_way(server.address());
  LimitFiles(server.process().pid(), 24);  // two for each connection
  std::vector<int> idle;
  for (int i = 0; i < 20; ++i) idle.push_back(ConnectRaw(server.address()));

  // Each time by a new connection: a channel that was turned away waits for ever longer.
  absl::Status served;
  EXPECT_TRUE(TestService::Eventually([&] {
    OptimizerClient late(*ConnectTo({server.address()}, {.tls = {}, .own_connection = true}));
    served = RunJob(late, absl::Seconds(5));
    return served.ok();
  })) << served;

  EXPECT_TRUE(under_way.End().ok()) << "what is under way is finished";
  for (const int fd : idle) close(fd);
  server.process().Signal(SIGTERM);
  EXPECT_EQ(server.process().Wait(), 0);
}

TEST(FileDescriptors, TheStartSaysThatThereAreFewerThanConnectionsNeed) {
  ServerProcess enough({"--max_connections=10"});
  EXPECT_TRUE(TestService::Eventually(
      [&] { return enough.process().Errors().find("\"started\"") != std::string::npos; }));
  ServerProcess few({"--max_connections=2000000000"});

  EXPECT_TRUE(TestService::Eventually([&] {
    return few.process().Errors().find("connections, not 2000000000") != std::string::npos;
  })) << few.process().Errors();
  EXPECT_EQ(enough.process().Errors().find("few_files"), std::string::npos);
}

// gRPC takes the connections of such a port, and gives it up then; a server that lives on without
// would be worse than one that is started again.
TEST(FileDescriptors, WhenTheyRunOutAServerOnAUnixSocketDrainsAndEnds) {
  const ScratchFolder folder;
  const std::string path = folder.Path("socket");
  ServerProcess server({"--listen=unix:" + path});
  OpenJob under_way("unix:" + path);
  LimitFiles(server.process().pid(), 8);

  std::vector<int> connections;
  for (int i = 0; i < 40; ++i) connections.push_back(ConnectUnix(path));

  EXPECT_TRUE(TestService::Eventually([&] {
    return server.process().Errors().find("\"event\":\"port_lost\"") != std::string::npos;
  })) << server.process().Errors();
  EXPECT_TRUE(under_way.End().ok()) << "what is under way is finished";
  for (const int fd : connections) close(fd);
  EXPECT_EQ(server.process().Wait(), 1);
}

TEST(FullDisk, CostsTheLogAndNoJob) {
  ServerProcess server({"--log_file=/dev/full"});
  OptimizerClient client(*ConnectTo({server.address()}));

  for (int i = 0; i < 20; ++i) EXPECT_TRUE(RunJob(client).ok());

  server.process().Signal(SIGTERM);
  EXPECT_EQ(server.process().Wait(), 0);
}

// A server whose clock can be set.
class ShiftedServer {
 public:
  ShiftedServer() {
    SetClockBy(0);
    setenv("LD_PRELOAD", TRAVERSE_CLOCK_SHIM, 1);
    setenv("CLOCK_SHIM_FILE", path_.c_str(), 1);
    server_ = std::make_unique<ServerProcess>(
        std::vector<std::string>{"--log_file=/dev/null", "--idle_timeout=5s"});
    unsetenv("LD_PRELOAD");
    unsetenv("CLOCK_SHIM_FILE");
  }

  void SetClockBy(int64_t seconds) {
    const int fd = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    EXPECT_EQ(pwrite(fd, &seconds, sizeof(seconds), 0), static_cast<ssize_t>(sizeof(seconds)));
    close(fd);
  }

  ServerProcess& server() { return *server_; }

 private:
  const ScratchFolder folder_;
  const std::string path_ = folder_.Path("clock");
  std::unique_ptr<ServerProcess> server_;
};

TEST(ClockJump, NeitherCutsJobsShortNorKeepsThemForever) {
  ShiftedServer shifted;
  OptimizerClient client(*ConnectTo({shifted.server().address()}));
  ASSERT_TRUE(RunJob(client).ok());

  for (const int64_t jump : {int64_t{24 * 3600}, int64_t{-24 * 3600}}) {
    // A job that takes all the time it is given.
    v1::JobOptions options;
    options.mutable_strategy()->set_name("exact");
    std::vector<v1::Layer> hard = Layers(2, 150);
    for (v1::Layer& layer : hard) layer.mutable_start();
    absl::StatusOr<JobResult> result = absl::UnknownError("");
    const absl::Time begin = absl::Now();
    std::thread caller(
        [&] { result = client.Optimize(options, hard, {.deadline = absl::Milliseconds(1500)}); });
    absl::SleepFor(absl::Milliseconds(400));
    shifted.SetClockBy(jump);
    caller.join();
    const absl::Duration took = absl::Now() - begin;

    // Just too late is no fault of the clock's: other tests keep the machine busy.
    EXPECT_TRUE(result.ok() ||
                (absl::IsDeadlineExceeded(result.status()) && took > absl::Milliseconds(1490)))
        << result.status();
    // A job that the jump cuts short ends at 400 ms; on a busy machine any ends early.
    EXPECT_GT(took, absl::Milliseconds(500)) << "jump by " << jump;
    EXPECT_LT(took, absl::Milliseconds(3000)) << "jump by " << jump;
    EXPECT_TRUE(RunJob(client).ok());
  }
}

}  // namespace
}  // namespace traverse::testing
