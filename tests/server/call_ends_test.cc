// Cancellation, deadlines, slow readers, idle callers, drain: how calls end.

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "tests/server/support/open_stream.h"
#include "tests/server/support/service_fixture.h"
#include "tests/support/processor_watch.h"
#include "tests/support/sanitizers.h"

namespace traverse::testing {
namespace {

using ::testing::HasSubstr;

TEST(Cancellation, FreesTheJobsPlace) {
  TestService service;
  OpenStream stream(service);
  ASSERT_TRUE(stream.ReadLayer());
  EXPECT_EQ(service.server().core().admission.jobs(), 1);

  stream.context().TryCancel();

  EXPECT_EQ(stream.Finish().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(service.Eventually([&] { return service.server().core().admission.jobs() == 0; }));
  EXPECT_EQ(service.server().core().queue_layers, 0);
}

// Layers that keep `exact` busy for longer than any test, each with a start of its own.
v1::OptimizeBatchRequest HardBatch(int layers) {
  v1::OptimizeBatchRequest request = MakeBatch(0, "exact");
  for (int i = 0; i < layers; ++i) {
    *request.add_layers() = MakeLayer(static_cast<uint64_t>(i), 150);
    request.mutable_layers(i)->mutable_start();
  }
  return request;
}

// What the workers of `service` work for after a call of hard layers was cancelled, in seconds.
double WorkAfterCancelling(TestService& service) {
  ServiceCore& core = service.server().core();
  grpc::ClientContext context;
  const ProcessorWatch worked;
  const auto reader = service.stub().OptimizeBatch(&context, HardBatch(20));
  // Beyond the short stages before the searches.
  const auto both_search = [&] { return worked.Seconds() > 0.2 && core.pool.busy() == 2; };
  EXPECT_TRUE(service.Eventually(both_search)) << "the layers are too easy";

  const ProcessorWatch watch;
  context.TryCancel();
  EXPECT_TRUE(service.Eventually([&] { return core.pool.busy() == 0; }));
  const double seconds = watch.Seconds();
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(service.Eventually([&] { return core.queue_layers == 0; }));
  return seconds;
}

TEST(Cancellation, FreesTheWorkersWithin50Milliseconds) {
  TestService service;
  constexpr double kOfTwoWorkers = 2 * (kSanitized ? 2 : 0.05);
  double least = WorkAfterCancelling(service);
  // On a busy machine the cancellation may come to the server late.
  for (int i = 0; i < 4 && least >= kOfTwoWorkers; ++i) {
    least = std::min(least, WorkAfterCancelling(service));
  }
  EXPECT_LT(least, kOfTwoWorkers);
}

// The first in time of several, each of which has twice as long as the one before, for a machine
// that is busy, and none of which may take less than `least` of its time.
Answer AnswerInTime(TestService& service, const v1::OptimizeBatchRequest& request,
                    absl::Duration deadline, double least = 0) {
  Answer answer;
  for (int i = 0; i < 6; ++i, deadline *= 2) {
    const absl::Time begin = absl::Now();
    answer = service.Batch(request, deadline);
    EXPECT_GE(absl::Now() - begin, least * deadline) << "the layers are too easy";
    if (answer.status.ok()) break;
  }
  return answer;
}

TEST(Deadline, HardLayersComeBackBeforeIt) {
  TestService service;
  const v1::OptimizeBatchRequest request = HardBatch(20);

  const Answer answer = AnswerInTime(service, request, absl::Milliseconds(500), 0.5);

  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  ASSERT_EQ(answer.layers.size(), 20u);
  ASSERT_TRUE(answer.summary.has_value());
  EXPECT_EQ(answer.layers.back().stop_reason(), v1::STOP_REASON_TIME_LIMIT);
}

TEST(Deadline, TimeLimitOfTheJobCountsToo) {
  TestService service;
  v1::OptimizeBatchRequest request = HardBatch(5);
  request.mutable_options()->mutable_time_limit()->set_nanos(100'000'000);

  const ProcessorWatch watch;
  const Answer answer = service.Batch(request);

  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  EXPECT_LT(watch.Seconds(), 2 * (kSanitized ? 5 : 1)) << "of two workers";
  EXPECT_EQ(answer.layers.size(), 5u);
}

TEST(Deadline, LayerTimeLimitLetsEveryLayerHaveItsShare) {
  TestService service;
  v1::OptimizeBatchRequest request = HardBatch(4);
  // A thread may wait for a busy processor for 50 ms.
  request.mutable_options()->mutable_layer_time_limit()->set_nanos((kSanitized ? 500 : 150) *
                                                                   1'000'000);

  const ProcessorWatch watch;
  const Answer answer = service.Batch(request);

  EXPECT_LT(watch.Seconds(), 4 * (kSanitized ? 5 : 0.6)) << "of four layers";
  ASSERT_EQ(answer.layers.size(), 4u);
  for (const v1::LayerResult& layer : answer.layers) {
    EXPECT_LT(layer.cost(), layer.cost_given());
  }
}

TEST(Deadline, AllLayersComeBackBeforeIt) {
  TestService service;
  const v1::OptimizeBatchRequest request = MakeBatch(500);

  const Answer answer = AnswerInTime(service, request, absl::Milliseconds(400));

  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  EXPECT_EQ(answer.layers.size(), 500u);
  EXPECT_TRUE(answer.summary.has_value());
}

TEST(SlowReader, HoldsUpNobodyElse) {
  TestService service([](ServerOptions& options) {
    options.service.limits.window = {.layers = 16, .points = 100'000};
  });
  grpc::ClientContext context;
  const auto reader = service.stub().OptimizeBatch(&context, MakeBatch(1000));
  ServiceCore& core = service.server().core();
  // 1,000 layers less the window and what the transport holds.
  ASSERT_TRUE(service.Eventually(
      [&] { return core.queue_layers > 0 && core.queue_layers < 1000 && core.pool.busy() == 0; }));
  absl::SleepFor(absl::Milliseconds(50));
  EXPECT_GT(core.queue_layers, 900);
  EXPECT_EQ(core.pool.waiting(), 0);

  EXPECT_TRUE(service.Batch(MakeBatch(100)).status.ok());

  int layers = 0;
  v1::OptimizeBatchResponse response;
  while (reader->Read(&response)) layers += response.has_layer() ? 1 : 0;
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(layers, 1000);
}

TEST(SlowReader, HoldsBackHisOwnStream) {
  TestService service([](ServerOptions& options) {
    options.service.limits.window = {.layers = 16, .points = 100'000};
  });
  grpc::ClientContext context;
  const auto stream = service.stub().Optimize(&context);
  v1::OptimizeRequest message;
  message.mutable_options()->mutable_strategy()->set_name("none");
  std::atomic<int> written{0};
  std::thread writer([&] {
    for (uint64_t i = 0; i < 5000; ++i) {
      *message.add_layers() = MakeLayer(i);
      if (!stream->Write(message)) break;
      ++written;
      message.Clear();
    }
    stream->WritesDone();
  });
  absl::SleepFor(absl::Milliseconds(200));
  EXPECT_LT(written, 1000);

  int layers = 0;
  v1::OptimizeResponse response;
  while (stream->Read(&response)) layers += response.has_layer() ? 1 : 0;
  writer.join();
  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_EQ(layers, 5000);
}

TEST(IdleTimeout, ACallThatIsOpenedAndNeverEndsIsGivenUp) {
  TestService service([](ServerOptions& options) {
    options.service.limits.idle_timeout = absl::Milliseconds(200);
  });
  OpenStream stream(service);
  ASSERT_TRUE(stream.ReadLayer());

  const grpc::Status status = stream.WaitForEnd();

  EXPECT_EQ(status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_THAT(status.error_message(), HasSubstr("nothing was sent or read for 200ms"));
  EXPECT_TRUE(service.Eventually([&] { return service.server().core().admission.jobs() == 0; }));
}

TEST(IdleTimeout, AReaderWhoNeverReadsIsGivenUp) {
  TestService service([](ServerOptions& options) {
    options.service.limits.idle_timeout = absl::Milliseconds(200);
  });
  ServiceCore& core = service.server().core();
  grpc::ClientContext context;
  const auto reader = service.stub().OptimizeBatch(&context, MakeBatch(2000));
  ASSERT_TRUE(service.Eventually([&] { return core.admission.jobs() == 1; }));

  EXPECT_TRUE(service.Eventually([&] { return core.admission.jobs() == 0; }));
  EXPECT_TRUE(service.Eventually([&] { return core.queue_layers == 0; }));
  context.TryCancel();
  reader->Finish();
}

TEST(IdleTimeout, AnEndThatNobodyReadsIsGivenUp) {
  TestService service([](ServerOptions& options) {
    options.listen = "127.0.0.1:0";
    options.service.limits.idle_timeout = absl::Milliseconds(200);
  });
  ServiceCore& core = service.server().core();
  const Answer read = service.Batch(MakeBatch(1));
  ASSERT_TRUE(read.status.ok());
  v1::OptimizeBatchResponse first;
  *first.mutable_layer() = read.layers.front();
  // A channel that takes in the layer and not the summary, as long as nobody reads. gRPC says that
  // the summary is written, because the end comes with it.
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES,
                   static_cast<int>(first.ByteSizeLong()) + 20);
  const auto stub = v1::RouteOptimizerService::NewStub(
      grpc::CreateCustomChannel(absl::StrCat("127.0.0.1:", service.server().port()),
                                grpc::InsecureChannelCredentials(), arguments));
  grpc::ClientContext context;
  const auto reader = stub->OptimizeBatch(&context, MakeBatch(1));

  const char* both_ended = "traverse_jobs_total{code=\"OK\",strategy=\"none\"} 2";
  EXPECT_TRUE(
      service.Eventually([&] { return absl::StrContains(core.MetricsText(), both_ended); }));
  EXPECT_TRUE(service.Eventually([&] { return core.calls() == 0; }));

  context.TryCancel();
  reader->Finish();
}

// Whether a job that works for five times `idle_timeout` ends well.
bool MayWork(absl::Duration idle_timeout) {
  TestService service([idle_timeout](ServerOptions& options) {
    options.service.limits.idle_timeout = idle_timeout;
  });
  v1::OptimizeBatchRequest request = HardBatch(1);
  const absl::Duration work = 5 * idle_timeout;
  google::protobuf::Duration& limit = *request.mutable_options()->mutable_time_limit();
  limit.set_seconds(absl::ToInt64Seconds(work));
  limit.set_nanos(static_cast<int32_t>(absl::ToInt64Nanoseconds(work % absl::Seconds(1))));
  return service.Stream(request).status.ok();
}

// On a busy machine threads may stand still for as long.
TEST(IdleTimeout, WorkThatTakesLongerIsNoIdleness) {
  EXPECT_TRUE(MayWork(absl::Milliseconds(100)) || MayWork(absl::Milliseconds(400)) ||
              MayWork(absl::Milliseconds(1600)));
}

TEST(Drain, RunningJobsFinishAndNewOnesAreRefused) {
  TestService service;
  OpenStream stream(service);
  ASSERT_TRUE(stream.ReadLayer());
  bool drained = false;
  std::thread drain([&] { drained = service.server().Drain(absl::Seconds(10)); });
  ASSERT_TRUE(service.Eventually([&] { return service.server().core().admission.draining(); }));

  const Answer refused = service.Batch(MakeBatch(1));
  EXPECT_EQ(refused.status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_TRUE(stream.Finish().ok());
  drain.join();
  EXPECT_TRUE(drained);
}

TEST(Drain, JobsThatTakeTooLongEndWithUnavailable) {
  // Within a process the end of the server overtakes statuses that nobody has read yet.
  TestService service([](ServerOptions& options) { options.listen = "127.0.0.1:0"; });
  OpenStream stream(service);
  ASSERT_TRUE(stream.ReadLayer());

  grpc::Status status;
  std::thread reader([&] { status = stream.WaitForEnd(); });
  EXPECT_FALSE(service.server().Drain(absl::Milliseconds(50)));

  reader.join();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_THAT(status.error_message(), HasSubstr("layers that are missing"));
}

TEST(Drain, ServerMayGoWhileJobsRun) {
  auto service = std::make_unique<TestService>();
  OpenStream stream(*service);
  ASSERT_TRUE(stream.ReadLayer());

  grpc::Status status;
  std::thread reader([&] { status = stream.WaitForEnd(); });
  service.reset();
  reader.join();

  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE) << status.error_message();
}

// A caller who is slow to read has 2 s to read how his job ended.
TEST(Drain, WhoReadsLateStillLearnsHowItEnded) {
  TestService service([](ServerOptions& options) { options.listen = "127.0.0.1:0"; });
  ServiceCore& core = service.server().core();
  // A channel that takes in little of what nobody reads.
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 1024);
  const auto stub = v1::RouteOptimizerService::NewStub(
      grpc::CreateCustomChannel(absl::StrCat("127.0.0.1:", service.server().port()),
                                grpc::InsecureChannelCredentials(), arguments));
  v1::OptimizeBatchRequest request = MakeBatch(0);
  for (uint64_t i = 0; i < 1000; ++i) *request.add_layers() = MakeLayer(i, 50);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(20));
  const auto reader = stub->OptimizeBatch(&context, request);
  // Until nothing moves any more: a write is under way that nobody reads.
  int64_t left = 0;
  EXPECT_TRUE(service.Eventually([&] {
    absl::SleepFor(absl::Milliseconds(50));
    const int64_t before = std::exchange(left, core.queue_layers);
    return left > 0 && left == before;
  }));

  std::thread drain([&] { EXPECT_FALSE(service.server().Drain(absl::Milliseconds(10))); });
  absl::SleepFor(absl::Milliseconds(700));
  v1::OptimizeBatchResponse response;
  while (reader->Read(&response)) {
  }
  const grpc::Status status = reader->Finish();
  drain.join();

  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_THAT(status.error_message(), HasSubstr("layers that are missing"));
}

TEST(Drain, ThePortIsClosedAfterwards) {
  TestService service([](ServerOptions& options) { options.listen = "127.0.0.1:0"; });
  EXPECT_TRUE(service.Batch(MakeBatch(1)).status.ok());

  EXPECT_TRUE(service.server().Drain(absl::Seconds(10)));

  // The server itself would answer that it is draining.
  const grpc::Status status = service.Batch(MakeBatch(1)).status;
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_THAT(status.error_message(), HasSubstr("connect"));
}

}  // namespace
}  // namespace traverse::testing
