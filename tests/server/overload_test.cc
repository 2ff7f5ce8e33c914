// More jobs, or larger ones, than the server has room for, and what it counts as taken.

#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "server/ops/memory.h"
#include "tests/server/support/open_stream.h"
#include "tests/server/support/service_fixture.h"

namespace traverse::testing {
namespace {

using ::testing::HasSubstr;

// Large messages grow the windows of a connection; what comes through them before a refusal must
// not look like a flood.
TEST(Overload, ManyRefusalsOfLargeJobsDoNotCutTheConnection) {
  TestService service([](ServerOptions& options) {
    options.listen = "127.0.0.1:0";
    options.service.admission.max_jobs = 1;
  });
  v1::OptimizeBatchRequest large = MakeBatch(0);
  for (int i = 0; i < 40; ++i) {
    *large.add_layers() = MakeLayer(static_cast<uint64_t>(i + 1), 20, 200);
  }
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(service.Batch(large).status.ok());
  // The job that keeps others out is another caller's: the connection of the refused has none.
  absl::StatusOr<std::unique_ptr<Admission::Ticket>> other =
      service.server().core().admission.Admit("other", 1);
  ASSERT_TRUE(other.ok());

  for (int i = 0; i < 50; ++i) {
    const grpc::Status status = service.Batch(large).status;
    ASSERT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
  }

  EXPECT_THAT(service.server().core().MetricsText(), HasSubstr("traverse_connections_cut_total 0"));
}

double ReceivingBytes(TestService& service) {
  const std::string text = service.server().core().MetricsText();
  const std::string name = "traverse_memory_bytes{kind=\"receiving\"} ";
  return std::stod(text.substr(text.find(name) + name.size()));
}

// What came of a message until it was cancelled is let go of, and must not look like a flood.
TEST(Overload, UploadsThatAreCancelledDoNotCutTheConnection) {
  TestService service([](ServerOptions& options) { options.listen = "127.0.0.1:0"; });
  v1::OptimizeBatchRequest large = MakeBatch(0);
  const v1::Layer layer = MakeLayer(1, 2000, 200);
  while (large.ByteSizeLong() < size_t{55} << 20) *large.add_layers() = layer;

  int cancelled = 0;
  for (int i = 0; i < 20 && cancelled < 4; ++i) {
    grpc::ClientContext context;
    std::atomic<bool> over = false;  // a message may have come before it could be cancelled
    std::thread canceller([&] {
      while (!over && ReceivingBytes(service) <= 8 << 20) std::this_thread::yield();
      context.TryCancel();
    });
    const auto reader = service.stub().OptimizeBatch(&context, large);
    v1::OptimizeBatchResponse response;
    while (reader->Read(&response)) {
    }
    cancelled += reader->Finish().error_code() == grpc::StatusCode::CANCELLED;
    over = true;
    canceller.join();
    std::this_thread::sleep_for(std::chrono::milliseconds(150));  // for the table to be looked at
  }

  EXPECT_GE(cancelled, 1);
  EXPECT_THAT(service.server().core().MetricsText(), HasSubstr("traverse_connections_cut_total 0"));
}

// `tabu` searches until its deadline, so every job wants a worker all the time.
TEST(Overload, JobsThatSearchForTheSameTimeAreAnsweredInTime) {
  constexpr int kJobs = 24;
  TestService service([](ServerOptions& options) {
    options.service.threads = 1;
    options.service.admission.max_wait = absl::Hours(1);
  });
  std::atomic<int> answered{0};
  std::atomic<int> missed{0};
  std::vector<std::thread> callers;
  for (int i = 0; i < kJobs; ++i) {
    callers.emplace_back([&] {
      grpc::ClientContext context;
      context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(2));
      v1::OptimizeBatchRequest request = MakeBatch(0, "tabu");
      *request.add_layers() = MakeLayer(1, 60);
      const auto reader = service.stub().OptimizeBatch(&context, request);
      v1::OptimizeBatchResponse response;
      while (reader->Read(&response)) {
      }
      const grpc::StatusCode code = reader->Finish().error_code();
      answered += code == grpc::StatusCode::OK;
      missed += code == grpc::StatusCode::DEADLINE_EXCEEDED;
    });
  }
  for (std::thread& caller : callers) caller.join();

  EXPECT_GT(answered, kJobs / 2);
  EXPECT_LT(missed, kJobs / 4);
}

TEST(Overload, JobsBeyondTheLimitAreRefusedWithAdviceWhenToRetry) {
  TestService service([](ServerOptions& options) { options.service.admission.max_jobs = 2; });
  OpenStream first(service);
  OpenStream second(service);
  ASSERT_TRUE(first.ReadLayer());
  ASSERT_TRUE(second.ReadLayer());

  const Answer refused = service.Batch(MakeBatch(1));

  EXPECT_EQ(refused.status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  ASSERT_TRUE(RetryDelay(refused.status).has_value());
  EXPECT_GT(*RetryDelay(refused.status), absl::ZeroDuration());
  EXPECT_THAT(service.server().core().MetricsText(),
              HasSubstr("traverse_rejected_total{reason=\"jobs\"} 1"));
  EXPECT_TRUE(first.Finish().ok());
  EXPECT_TRUE(service.Batch(MakeBatch(1)).status.ok());
  EXPECT_TRUE(second.Finish().ok());
}

TEST(Overload, AnIdleStreamGivesWayToACallerWithoutAPlace) {
  TestService service([](ServerOptions& options) { options.service.admission.max_jobs = 1; });
  OpenStream idle(service);
  ASSERT_TRUE(idle.ReadLayer());
  Admission& admission = service.server().core().admission;

  // The service's caller has a place: nobody gives way to him.
  EXPECT_FALSE(service.Batch(MakeBatch(1)).status.ok());
  EXPECT_FALSE(admission.Admit("another", 1).ok());
  EXPECT_EQ(admission.jobs(), 1) << "not yet idle for long";
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  EXPECT_FALSE(admission.Admit("another", 1).ok());
  EXPECT_TRUE(service.Eventually([&] { return admission.jobs() == 0; }));

  const grpc::Status ended = idle.Finish();
  EXPECT_EQ(ended.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(RetryDelay(ended).has_value());
  EXPECT_TRUE(service.Batch(MakeBatch(1)).status.ok());
}

// What becomes of a batch of which only the headers are sent.
grpc::Status HeadersOnly(TestService& service, const std::string& message_bytes) {
  grpc::GenericStub stub(service.shared_channel());
  grpc::CompletionQueue queue;
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(300));
  if (!message_bytes.empty()) context.AddMetadata("traverse-message-bytes", message_bytes);
  const auto call =
      stub.PrepareCall(&context, "/traverse.v1.RouteOptimizerService/OptimizeBatch", &queue);
  void* tag = nullptr;
  bool ok = false;
  call->StartCall(nullptr);
  queue.Next(&tag, &ok);
  grpc::Status status;
  call->Finish(&status, nullptr);
  queue.Next(&tag, &ok);
  return status;
}

TEST(Overload, ABatchIsRefusedBeforeItsMessageIsSent) {
  TestService service([](ServerOptions& options) {
    options.service.admission.max_queued_points = 1500;
    options.service.admission.max_jobs = 3;
  });
  Admission& admission = service.server().core().admission;
  const auto queued = admission.Admit("another", 1000);
  const auto full = grpc::StatusCode::RESOURCE_EXHAUSTED;
  const auto waits_for_the_message = grpc::StatusCode::DEADLINE_EXCEEDED;

  EXPECT_EQ(HeadersOnly(service, "16000").error_code(), full);
  // What is no number states nothing.
  for (const char* bytes : {"1600", "16000 bytes", ""}) {
    EXPECT_EQ(HeadersOnly(service, bytes).error_code(), waits_for_the_message) << bytes;
    ASSERT_TRUE(service.Eventually([&admission] { return admission.jobs() == 1; }));
  }
  const auto second = admission.Admit("another", 1);
  const auto third = admission.Admit("another", 1);
  EXPECT_EQ(HeadersOnly(service, "").error_code(), full);
}

// Sends `layers` layers of 1,000 points, waits until all are answered, and returns the memory that
// is still held for the job, which is open.
int64_t BytesHeldForAnswered(bool chain_bound, int layers) {
  TestService service;
  grpc::ClientContext context;
  const auto stream = service.stub().Optimize(&context);
  v1::OptimizeRequest message;
  v1::Strategy& strategy = *message.mutable_options()->mutable_strategy();
  strategy.set_name("auto");
  (*strategy.mutable_options())["effort"] = "0.1";
  (*strategy.mutable_options())["chain_bound"] = chain_bound ? "true" : "false";
  for (int i = 0; i < layers; ++i) *message.add_layers() = MakeLayer(1, 2, 500);
  stream->Write(message);
  v1::OptimizeResponse response;
  for (int i = 0; i < layers; ++i) stream->Read(&response);
  const Admission& admission = service.server().core().admission;
  const bool kept = chain_bound && layers < 100;
  // What was written is let go after it was read.
  if (!kept) service.Eventually([&] { return admission.held_bytes() == 0; });
  const int64_t held = admission.held_bytes();

  stream->WritesDone();
  EXPECT_TRUE(stream->Read(&response));
  EXPECT_EQ(response.summary().has_chain_lower_bound(), kept);
  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_TRUE(service.Eventually([&] { return admission.held_bytes() == 0; }));
  return held;
}

// What jobs leave with the allocator is no reason to refuse the next ones.
TEST(Overload, FreedMemoryGoesBackToTheSystemBeforeJobsAreRefused) {
  constexpr size_t kBlock = 64 << 10, kBlocks = 3000;  // from the heap; larger ones are mapped
  TestService service;
  ServiceCore& core = service.server().core();
  std::vector<std::unique_ptr<std::string>> blocks;
  for (size_t i = 0; i < kBlocks; ++i) blocks.push_back(std::make_unique<std::string>(kBlock, 'x'));
  blocks.erase(blocks.begin(), blocks.end() - 1);  // the last one keeps the heap from shrinking
  if (mallinfo2().fordblks < kBlock * kBlocks / 2) GTEST_SKIP() << "another allocator";
  const int64_t resident = ResidentBytes();

  core.Watch(nullptr, resident * 5 / 4);

  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE(core.admission.Admit("a", 1).ok());
    absl::SleepFor(absl::Milliseconds(2));
  }
  EXPECT_LT(ResidentBytes(), resident - static_cast<int64_t>(kBlock * kBlocks / 2));
}

TEST(Overload, LayersThatAreKeptForTheBoundOfTheChainCountAsTaken) {
  EXPECT_EQ(BytesHeldForAnswered(false, 10), 0);
  EXPECT_GT(BytesHeldForAnswered(true, 10), 10 * 1000 * 16);
  EXPECT_EQ(BytesHeldForAnswered(true, 110), 0) << "too many to be kept";
}

}  // namespace
}  // namespace traverse::testing
