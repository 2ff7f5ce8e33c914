// Callers that stall, or die in the middle of a job.

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "absl/time/clock.h"
#include "client/api/channel.h"
#include "client/api/optimizer_client.h"
#include "tests/server/support/server_process.h"
#include "tests/server/support/service_fixture.h"

namespace traverse::testing {
namespace {

std::vector<v1::Layer> Layers(int count) {
  std::vector<v1::Layer> layers;
  for (int i = 0; i < count; ++i) layers.push_back(MakeLayer(static_cast<uint64_t>(i), 20, 10));
  return layers;
}

// Streams layers for as long as it lives, and reads no answer.
class StalledReader {
 public:
  explicit StalledReader(const std::string& address)
      : stub_(v1::RouteOptimizerService::NewStub(
            grpc::CreateChannel(address, grpc::InsecureChannelCredentials()))),
        stream_(stub_->Optimize(&context_)),
        writer_([this] {
          v1::OptimizeRequest message;
          message.mutable_options()->mutable_strategy()->set_name("greedy");
          for (const v1::Layer& layer : Layers(20)) *message.add_layers() = layer;
          while (stream_->Write(message)) {
            message.clear_options();
            ++written_;
          }
        }) {}

  ~StalledReader() {
    context_.TryCancel();
    writer_.join();
    stream_->Finish();
  }

  int written() const { return written_; }

 private:
  const std::unique_ptr<v1::RouteOptimizerService::Stub> stub_;
  grpc::ClientContext context_;
  const std::unique_ptr<grpc::ClientReaderWriter<v1::OptimizeRequest, v1::OptimizeResponse>>
      stream_;
  std::atomic<int> written_{0};
  std::thread writer_;
};

void BearsStalledReaders(absl::Duration time) {
  ServerProcess server({"--log_file=/dev/null"});
  OptimizerClient client(*ConnectTo({server.address()}));
  v1::JobOptions options;
  options.mutable_strategy()->set_name("greedy");
  const std::vector<v1::Layer> layers = Layers(20);
  absl::Duration alone = absl::ZeroDuration();
  for (int i = 0; i < 5; ++i) {
    const absl::Time begin = absl::Now();
    ASSERT_TRUE(client.Optimize(options, layers).ok());
    alone = std::max(alone, absl::Now() - begin);
  }
  const double before = server.Metric("process_resident_memory_bytes");
  {
    StalledReader first(server.address());
    StalledReader second(server.address());
    double settled = 0;  // once buffers and windows are full
    double most = 0;
    std::vector<absl::Duration> latencies;
    for (const absl::Time end = absl::Now() + time; absl::Now() < end;) {
      const absl::Time begin = absl::Now();
      ASSERT_TRUE(client.Optimize(options, layers).ok());
      latencies.push_back(absl::Now() - begin);
      most = std::max(most, server.Metric("process_resident_memory_bytes"));
      if (absl::Now() < end - time / 2) settled = most;
      absl::SleepFor(absl::Milliseconds(20));
    }
    std::sort(latencies.begin(), latencies.end());
    EXPECT_LT(most - before, 200e6);
    if (time > absl::Seconds(30)) {
      EXPECT_LT(most - settled, 10e6);
    }
    EXPECT_LT(latencies[latencies.size() / 2], absl::Milliseconds(500) + 10 * alone);
    EXPECT_LT(first.written(), 2000);
    EXPECT_EQ(server.Metric("traverse_jobs_in_flight"), 2);
    std::printf(
        "%zu jobs beside, median %s, memory +%.1f MB, of it after half of the time +%.1f MB\n",
        latencies.size(), absl::FormatDuration(latencies[latencies.size() / 2]).c_str(),
        (most - before) / 1e6, (most - settled) / 1e6);
  }
  EXPECT_TRUE(
      TestService::Eventually([&] { return server.Metric("traverse_jobs_in_flight") == 0; }));
}

// TRAVERSE_STALL_SECONDS: how long they stall, 2 unless stated.
TEST(StalledReaderTest, CostsBoundedMemoryAndNobodyElse) {
  const char* const seconds = std::getenv("TRAVERSE_STALL_SECONDS");
  BearsStalledReaders(absl::Seconds(seconds == nullptr ? 2 : std::atoi(seconds)));
}

TEST(DeadCaller, FreesItsPlacesAndWorkers) {
  ServerProcess server({"--log_file=/dev/null"});
  ChildProcess caller({TRAVERSE_LOADGEN_BINARY, "--target=" + server.address(), "--in_flight=8",
                       "--mix=5000", "--duration=60s", "--strategy=ni2opt"});
  ASSERT_TRUE(TestService::Eventually([&] {
    return server.Metric("traverse_jobs_in_flight") > 1 &&
           server.Metric("traverse_workers_busy") > 0;
  }));

  caller.Signal(SIGKILL);
  caller.Wait();
  EXPECT_TRUE(TestService::Eventually([&] {
    return server.Metric("traverse_jobs_in_flight") == 0 &&
           server.Metric("traverse_workers_busy") == 0;
  }));
}

}  // namespace
}  // namespace traverse::testing
