// Three servers under load, one of which dies, or all of which are replaced in turn: every job
// comes back whole.

#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/api/channel.h"
#include "client/api/optimizer_client.h"
#include "tests/server/support/server_process.h"
#include "tests/server/support/service_fixture.h"

namespace traverse::testing {
namespace {

constexpr int kServers = 3;
constexpr int kCallers = 3;
constexpr size_t kLayers = 300;

class Fleet {
 public:
  Fleet() {
    for (int i = 0; i < kServers; ++i) servers_.push_back(std::make_unique<ServerProcess>());
    for (const auto& server : servers_) addresses_.push_back(server->address());
  }

  const std::vector<std::string>& addresses() const { return addresses_; }

  void Kill(size_t server) { servers_[server]->process().Signal(SIGKILL); }

  // Ends a server as a rollout does, and starts another one at its address. Returns the exit code.
  int Replace(size_t server) {
    servers_[server]->process().Signal(SIGTERM);
    const int code = servers_[server]->process().Wait();
    servers_[server] =
        std::make_unique<ServerProcess>(std::vector<std::string>{"--listen=" + addresses_[server]});
    return code;
  }

 private:
  std::vector<std::unique_ptr<ServerProcess>> servers_;
  std::vector<std::string> addresses_;
};

// Callers that send one job after the other until they are stopped.
class Load {
 public:
  explicit Load(const Fleet& fleet) {
    for (uint64_t i = 0; i < kLayers; ++i) layers_.push_back(MakeLayer(i, 8, 8));
    for (int c = 0; c < kCallers; ++c) {
      callers_.emplace_back([this, &fleet] { Run(fleet); });
    }
  }

  void Stop() {
    stop_ = true;
    for (std::thread& caller : callers_) caller.join();
  }

  // Some caller has begun another job, if that happens within 20 seconds.
  void AwaitMoreJobsThanCallers() const {
    for (int i = 0; i < 200 && jobs_ <= kCallers; ++i) absl::SleepFor(absl::Milliseconds(100));
  }

  int jobs() const { return jobs_; }
  int failures() const { return failures_; }

 private:
  void Run(const Fleet& fleet) {
    const auto channel = ConnectTo(fleet.addresses());
    OptimizerClient client(*channel);
    v1::JobOptions options;
    options.mutable_strategy()->set_name("ni2opt");
    while (!stop_) {
      CallOptions call;
      call.deadline = absl::Seconds(30);
      const absl::StatusOr<JobResult> result = client.Optimize(options, layers_, call);
      ++jobs_;
      // That each layer came back once and is a route is what the client checks.
      if (!result.ok() || result->summary.layers() != kLayers) {
        ++failures_;
        ADD_FAILURE() << result.status();
      }
    }
  }

  std::vector<v1::Layer> layers_;
  std::vector<std::thread> callers_;
  std::atomic<bool> stop_{false};
  std::atomic<int> jobs_{0};
  std::atomic<int> failures_{0};
};

TEST(Fleet, DeathOfOneServerLosesNoJob) {
  Fleet fleet;
  Load load(fleet);
  absl::SleepFor(absl::Milliseconds(500));

  fleet.Kill(1);
  absl::SleepFor(absl::Milliseconds(1000));
  load.AwaitMoreJobsThanCallers();
  load.Stop();

  EXPECT_GT(load.jobs(), kCallers);
  EXPECT_EQ(load.failures(), 0);
}

TEST(Fleet, RolloutLosesNoJob) {
  Fleet fleet;
  Load load(fleet);
  for (size_t server = 0; server < kServers; ++server) {
    absl::SleepFor(absl::Milliseconds(1000));
    EXPECT_EQ(fleet.Replace(server), 0);
  }
  absl::SleepFor(absl::Milliseconds(300));
  load.AwaitMoreJobsThanCallers();
  load.Stop();

  EXPECT_GT(load.jobs(), kCallers);
  EXPECT_EQ(load.failures(), 0);
}

}  // namespace
}  // namespace traverse::testing
