#include "client/loadgen/load_run.h"

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "absl/time/clock.h"
#include "client/loadgen/job_bytes.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse::loadgen {
namespace {

// Answers each layer and the summary, but for what a test asks for.
class Service : public v1::RouteOptimizerService::Service {
 public:
  grpc::Status OptimizeBatch(grpc::ServerContext* context, const v1::OptimizeBatchRequest* request,
                             grpc::ServerWriter<v1::OptimizeBatchResponse>* writer) override {
    const auto found = context->client_metadata().find("authorization");
    if (found != context->client_metadata().end()) {
      const std::lock_guard<std::mutex> lock(mutex_);
      authorization.assign(found->second.data(), found->second.size());
    }
    const int call = calls++;
    {
      // Whoever comes while the first one is stalled waits with it.
      const std::lock_guard<std::mutex> lock(stall_);
      if (call == 0) absl::SleepFor(stall);
    }
    if (refuse_every > 0 && call % refuse_every == 0) {
      return grpc::Status(grpc::StatusCode::RESOURCE_EXHAUSTED, "full");
    }
    const int answers = drop_summary ? request->layers_size() : request->layers_size() + 1;
    for (int i = 0; i < answers; ++i) writer->Write({});
    return grpc::Status::OK;
  }

  absl::Duration stall = absl::ZeroDuration();
  int refuse_every = 0;
  bool drop_summary = false;
  std::atomic<int> calls{0};
  std::string authorization;

 private:
  std::mutex mutex_;
  std::mutex stall_;
};

class LoadRun : public ::testing::Test {
 protected:
  LoadRun() {
    grpc::ServerBuilder builder;
    builder.RegisterService(&service_);
    server_ = builder.BuildAndStart();
  }

  LoadResult Run(const LoadOptions& options, const std::vector<SizeShare>& mix = {{1, 1}}) {
    std::vector<JobKind> kinds;
    const std::vector<v1::Layer> parts = {MadeUpLayer(1, 2)};
    for (const SizeShare& share : mix) kinds.push_back({share, JobBytes({}, parts, share.layers)});
    return RunLoad(options, kinds, {server_->InProcessChannel({})});
  }

  static LoadOptions At(double rate) {
    LoadOptions options;
    options.rate = rate;
    options.warm_up = absl::ZeroDuration();
    options.duration = absl::Milliseconds(500);
    return options;
  }

  Service service_;
  std::unique_ptr<grpc::Server> server_;
};

TEST_F(LoadRun, SendsAndCountsEveryJob) {
  const LoadResult result = Run(At(200), {{1, 1}, {7, 1}});

  EXPECT_EQ(service_.calls, 100);
  EXPECT_EQ(result.sent[0] + result.sent[1], 100u);
  EXPECT_EQ(result.ok[0].jobs, result.sent[0]);
  EXPECT_EQ(result.ok[1].jobs, result.sent[1]);
  EXPECT_EQ(result.code.at("OK").jobs, 100u);
  EXPECT_EQ(result.code.size(), 1u);
  EXPECT_GT(result.ok[0].jobs, 30u);
}

// Who waits for answers would send one job during the stall, and find the median as good as ever.
TEST_F(LoadRun, AStallIsInTheLatencyOfAllJobsMeantToBeSentMeanwhile) {
  service_.stall = absl::Milliseconds(400);

  const LoadResult result = Run(At(200));

  EXPECT_EQ(result.ok[0].jobs, 100u);
  EXPECT_GT(result.ok[0].latency.Percentile(0.5), absl::Milliseconds(100));
  EXPECT_GE(result.ok[0].latency.max(), absl::Milliseconds(395));
}

TEST_F(LoadRun, OutcomesAreCountedByCode) {
  service_.refuse_every = 4;

  const LoadResult result = Run(At(200));

  EXPECT_EQ(result.code.at("RESOURCE_EXHAUSTED").jobs, 25u);
  EXPECT_EQ(result.code.at("RESOURCE_EXHAUSTED").latency.count(), 25u);
  EXPECT_EQ(result.code.at("RESOURCE_EXHAUSTED").from_sent.count(), 25u);
  EXPECT_EQ(result.code.at("OK").jobs, 75u);
  EXPECT_EQ(result.example.at("RESOURCE_EXHAUSTED"), "full");
}

TEST_F(LoadRun, AnswersThatAreMissingAreNoSuccess) {
  service_.drop_summary = true;

  const LoadResult result = Run(At(100));

  EXPECT_EQ(result.code.at("INCOMPLETE").jobs, 50u);
  EXPECT_FALSE(result.code.contains("OK"));
}

TEST_F(LoadRun, WarmUpIsNotCounted) {
  LoadOptions options = At(100);
  options.warm_up = absl::Milliseconds(300);
  service_.stall = absl::Milliseconds(100);

  const LoadResult result = Run(options);

  EXPECT_EQ(service_.calls, 80);
  EXPECT_EQ(result.sent[0], 50u);
  EXPECT_EQ(result.ok[0].latency.count(), 50u);
}

TEST_F(LoadRun, JobsBeyondTheMostInFlightAreCountedAsNotSent) {
  service_.stall = absl::Milliseconds(1500);
  LoadOptions options = At(100);
  options.max_in_flight = 10;

  const LoadResult result = Run(options);

  EXPECT_EQ(result.sent[0], 50u);
  EXPECT_EQ(result.ok[0].jobs, 10u);
  EXPECT_EQ(result.not_sent, 40u);
}

TEST_F(LoadRun, ClosedLoopKeepsSoManyJobsInFlight) {
  LoadOptions options = At(0);
  options.in_flight = 3;
  options.duration = absl::Milliseconds(200);

  const LoadResult result = Run(options);

  EXPECT_GT(result.ok[0].jobs, 3u);
  EXPECT_EQ(result.ok[0].jobs, result.sent[0]);
}

// The caller's channel is then the last one: no job may still hold it on one of gRPC's threads.
TEST_F(LoadRun, TheChannelMayGoAsSoonAsTheRunEnds) {
  LoadOptions options = At(0);
  options.in_flight = 4;
  options.duration = absl::Milliseconds(1);

  for (int i = 0; i < 500; ++i) EXPECT_GT(Run(options).ok[0].jobs, 0u);
}

TEST_F(LoadRun, TheTokenGoesWithEachJob) {
  LoadOptions options = At(20);
  options.token = "secret";

  Run(options);

  EXPECT_EQ(service_.authorization, "Bearer secret");
}

}  // namespace
}  // namespace traverse::loadgen
