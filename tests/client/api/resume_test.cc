#include "client/api/resume.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <string>
#include <vector>

#include "absl/time/clock.h"
#include "client/api/optimizer_client.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "tests/client/api/fake_service.h"

namespace traverse {
namespace {

using ::testing::Each;
using testing::FakeService;
using testing::KeepOrder;
using ::testing::Pair;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

std::vector<v1::Layer> Layers(int count) {
  std::vector<v1::Layer> layers;
  for (int i = 0; i < count; ++i) {
    v1::Layer& layer = layers.emplace_back();
    layer.set_id(static_cast<uint64_t>(100 + i));
    v1::Contour& contour = *layer.add_islands()->add_contours();
    for (const double c : {1.0 * i, 2.0}) contour.add_points(c);
  }
  return layers;
}

CallOptions Quick(int attempts) {
  CallOptions call;
  call.retry = {.max_attempts = attempts,
                .first_delay = absl::Milliseconds(1),
                .max_delay = absl::Milliseconds(5)};
  return call;
}

TEST(Resume, LayersThatCameBackAreNotAskedForAgain) {
  FakeService service;
  service.status = grpc::Status(grpc::StatusCode::UNAVAILABLE, "draining");
  service.layers_before_status = 2;
  std::map<uint64_t, int> answers;
  service.answer = [&](const v1::Layer& layer, uint64_t index) {
    ++answers[layer.id()];
    v1::LayerResult result = KeepOrder(layer, index);
    result.mutable_end()->set_x_mm(static_cast<double>(layer.id()));
    return result;
  };
  OptimizerClient client(service.InProcessChannel());

  const absl::StatusOr<JobResult> result = client.Optimize({}, Layers(6), Quick(2));

  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_THAT(result->layers, SizeIs(6));
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(result->layers[i].index(), i);
  EXPECT_THAT(answers, SizeIs(6));
  EXPECT_THAT(answers, Each(Pair(::testing::_, 1)));
  EXPECT_EQ(service.options.start().x_mm(), 103);  // the end of the fourth layer
  EXPECT_EQ(result->summary.layers(), 6u);
}

TEST(Resume, GivesUpAfterAttemptsThatBroughtNothing) {
  FakeService service;
  service.status = grpc::Status(grpc::StatusCode::UNAVAILABLE, "draining");
  OptimizerClient client(service.InProcessChannel());

  const absl::StatusOr<JobResult> result = client.Optimize({}, Layers(3), Quick(3));

  EXPECT_EQ(result.status().code(), absl::StatusCode::kUnavailable);
}

// The statuses of a server that is full, or about to go, with the advice to come back then.
grpc::Status WithAdvice(grpc::StatusCode code, absl::Duration delay) {
  google::rpc::RetryInfo advice;
  advice.mutable_retry_delay()->set_nanos(static_cast<int32_t>(absl::ToInt64Nanoseconds(delay)));
  google::rpc::Status details;
  details.add_details()->PackFrom(advice);
  return {code, "full", details.SerializeAsString()};
}

TEST(Resume, ComesBackNoEarlierThanTheServerAdvises) {
  constexpr absl::Duration kAdvice = absl::Milliseconds(150);
  for (const auto code : {grpc::StatusCode::RESOURCE_EXHAUSTED, grpc::StatusCode::UNAVAILABLE}) {
    FakeService service;
    service.status = WithAdvice(code, kAdvice);
    OptimizerClient client(service.InProcessChannel());
    CallOptions call = Quick(2);
    call.retry.max_refusals = 2;

    const absl::Time began = absl::Now();
    const absl::StatusOr<JobResult> result = client.Optimize({}, Layers(3), call);

    EXPECT_EQ(result.status().code(), static_cast<absl::StatusCode>(code));
    EXPECT_GE(absl::Now() - began, kAdvice);
  }
}

TEST(Resume, AServerThatIsFullIsAskedMoreOftenThanOneThatIsGone) {
  FakeService service;
  service.status = WithAdvice(grpc::StatusCode::RESOURCE_EXHAUSTED, absl::Milliseconds(1));
  std::atomic<int> calls{0};
  service.on_call = [&] { ++calls; };
  OptimizerClient client(service.InProcessChannel());
  CallOptions call = Quick(2);
  call.retry.max_refusals = 4;

  EXPECT_FALSE(client.Optimize({}, Layers(3), call).ok());

  EXPECT_EQ(calls, 4);
}

TEST(Resume, EverySignOfALostConnectionCounts) {
  for (const grpc::Status& lost :
       {grpc::Status(grpc::StatusCode::CANCELLED, "CANCELLED"),
        grpc::Status(grpc::StatusCode::UNKNOWN, "Stream removed"),
        grpc::Status(grpc::StatusCode::INTERNAL, "Received RST_STREAM with error code 2")}) {
    FakeService service;
    service.status = lost;
    service.layers_before_status = 2;
    OptimizerClient client(service.InProcessChannel());

    const absl::StatusOr<JobResult> result = client.Optimize({}, Layers(6), Quick(2));

    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_THAT(result->layers, SizeIs(6));
  }
}

TEST(Resume, OtherFaultsOfTheServerAreNot) {
  for (const auto code : {grpc::StatusCode::INTERNAL, grpc::StatusCode::UNKNOWN}) {
    FakeService service;
    service.status = grpc::Status(code, "a bug");
    OptimizerClient client(service.InProcessChannel());

    EXPECT_EQ(client.Optimize({}, Layers(3), Quick(5)).status().message(), "a bug");
  }
}

TEST(Resume, FaultsOfTheJobAreNotTriedAgain) {
  for (const auto code :
       {grpc::StatusCode::INVALID_ARGUMENT, grpc::StatusCode::RESOURCE_EXHAUSTED}) {
    FakeService service;
    service.status = grpc::Status(code, "layers[1]: too much");
    service.layers_before_status = 1;
    int answers = 0;
    service.answer = [&](const v1::Layer& layer, uint64_t index) {
      ++answers;
      return KeepOrder(layer, index);
    };
    OptimizerClient client(service.InProcessChannel());

    const absl::StatusOr<JobResult> result = client.Optimize({}, Layers(3), Quick(5));

    EXPECT_EQ(result.status().message(), "layers[1]: too much");
    EXPECT_EQ(answers, 1);
  }
}

TEST(ResumedOptions, GoOnWhereTheJobBrokeOff) {
  v1::JobOptions options;
  options.mutable_cleaning()->mutable_point()->set_x_mm(-5);
  options.mutable_cleaning()->set_every_layers(4);
  options.mutable_cleaning()->set_layers_since_cleaning(1);
  options.mutable_time_limit()->set_seconds(10);
  v1::LayerResult before;
  before.mutable_end()->set_x_mm(7);

  const v1::JobOptions third = ResumedOptions(options, 2, &before, absl::Milliseconds(2500));
  const v1::JobOptions fourth = ResumedOptions(options, 3, &before, absl::Seconds(60));

  EXPECT_EQ(third.start().x_mm(), 7);
  EXPECT_EQ(third.cleaning().layers_since_cleaning(), 3u);
  EXPECT_EQ(third.time_limit().seconds(), 7);
  EXPECT_EQ(third.time_limit().nanos(), 500'000'000);
  EXPECT_EQ(fourth.start().x_mm(), -5);  // the head was cleaned after the third layer
  EXPECT_EQ(fourth.cleaning().layers_since_cleaning(), 0u);
  EXPECT_EQ(fourth.time_limit().nanos(), 1'000'000);
}

// A job of which nothing came back is as good as one that was never begun.
TEST(ResumedOptions, BeforeTheFirstLayerAreThoseOfTheJob) {
  v1::JobOptions options;
  options.mutable_time_limit()->set_seconds(10);

  const v1::JobOptions again = ResumedOptions(options, 0, nullptr, absl::Milliseconds(2500));

  EXPECT_EQ(again.time_limit().seconds(), 10);
  EXPECT_EQ(again.time_limit().nanos(), 0);
}

v1::LayerResult Result(double given_mm, double travel_mm, v1::StopReason stop) {
  v1::LayerResult result;
  for (v1::Travel* travel : {result.mutable_given(), result.mutable_travel()}) {
    const double total_mm = travel == &result.given() ? given_mm : travel_mm;
    travel->set_contours_mm(0.5 * total_mm);
    travel->set_rasters_mm(0.3 * total_mm);
    travel->set_links_mm(0.2 * total_mm);
    travel->set_total_mm(total_mm);
  }
  result.set_cleaning_given_mm(8);
  result.set_cleaning_mm(4);
  result.set_cost_given(given_mm + 8);
  result.set_cost(travel_mm + 4);
  result.set_solve_seconds(0.25);
  result.set_lower_bound(travel_mm - 1);
  result.set_stop_reason(stop);
  return result;
}

TEST(SummaryOf, AddsUpTheLayers) {
  std::vector<v1::LayerResult> layers = {Result(100, 60, v1::STOP_REASON_TIME_LIMIT),
                                         Result(50, 20, v1::STOP_REASON_OPTIMAL),
                                         Result(30, 20, v1::STOP_REASON_TIME_LIMIT)};
  v1::JobSummary last;
  last.set_job_id("job-3");
  last.set_strategy("auto");
  v1::JobOptions options;
  options.set_idle_speed_mm_s(2);

  const v1::JobSummary sum = SummaryOf(options, layers, last, 1.5);

  EXPECT_EQ(sum.job_id(), "job-3");
  EXPECT_EQ(sum.strategy(), "auto");
  EXPECT_EQ(sum.layers(), 3u);
  EXPECT_DOUBLE_EQ(sum.given().contours_mm(), 90);
  EXPECT_DOUBLE_EQ(sum.given().rasters_mm(), 54);
  EXPECT_DOUBLE_EQ(sum.given().links_mm(), 36);
  EXPECT_DOUBLE_EQ(sum.given().total_mm(), 180);
  EXPECT_DOUBLE_EQ(sum.travel().total_mm(), 100);
  EXPECT_DOUBLE_EQ(sum.cleaning_given_mm(), 24);
  EXPECT_DOUBLE_EQ(sum.cleaning_mm(), 12);
  EXPECT_DOUBLE_EQ(sum.cost_given(), 204);
  EXPECT_DOUBLE_EQ(sum.cost(), 112);
  EXPECT_DOUBLE_EQ(sum.compute_seconds(), 0.75);
  EXPECT_DOUBLE_EQ(sum.lower_bound(), 97);
  EXPECT_DOUBLE_EQ(sum.idle_seconds_given(), 102);
  EXPECT_DOUBLE_EQ(sum.idle_seconds(), 56);
  EXPECT_DOUBLE_EQ(sum.wall_seconds(), 1.5);
  std::map<v1::StopReason, uint64_t> stops;
  for (const v1::StopCount& stop : sum.stops()) stops[stop.stop_reason()] = stop.layers();
  EXPECT_THAT(stops, UnorderedElementsAre(Pair(v1::STOP_REASON_TIME_LIMIT, 2),
                                          Pair(v1::STOP_REASON_OPTIMAL, 1)));
}

TEST(SummaryOf, HasABoundOnlyIfAllLayersHave) {
  std::vector<v1::LayerResult> layers = {Result(100, 60, v1::STOP_REASON_TIME_LIMIT),
                                         Result(50, 20, v1::STOP_REASON_TIME_LIMIT)};
  EXPECT_TRUE(SummaryOf({}, layers, {}, 0).has_lower_bound());
  layers[0].clear_lower_bound();
  EXPECT_FALSE(SummaryOf({}, layers, {}, 0).has_lower_bound());
}

TEST(ShiftPlace, CountsFromTheWholeJob) {
  EXPECT_EQ(ShiftPlace("layers[3].z_mm: not finite", 10), "layers[13].z_mm: not finite");
  EXPECT_EQ(ShiftPlace("options.seed: x", 10), "options.seed: x");
  EXPECT_EQ(ShiftPlace("layers[3]: x", 0), "layers[3]: x");
}

TEST(FirstMissing, IsOneRun) {
  const MissingRun run = FirstMissing({true, false, false, true, false});
  EXPECT_EQ(run.begin, 1u);
  EXPECT_EQ(run.end, 3u);
  EXPECT_EQ(FirstMissing({true, true}).begin, 2u);
}

TEST(CleaningDueAfter, CountsFromTheLastCleaning) {
  v1::JobOptions options;
  EXPECT_FALSE(CleaningDueAfter(options, 2));
  options.mutable_cleaning()->set_every_layers(3);
  options.mutable_cleaning()->set_layers_since_cleaning(1);

  std::vector<size_t> due;
  for (size_t layer = 0; layer < 8; ++layer) {
    if (CleaningDueAfter(options, layer)) due.push_back(layer);
  }

  EXPECT_EQ(due, (std::vector<size_t>{1, 4, 7}));
}

}  // namespace
}  // namespace traverse
