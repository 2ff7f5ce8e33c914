// JobOptions.partial_answers: a layer with a fault does not cost the job.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <map>

#include "tests/server/support/service_fixture.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

using ::testing::StartsWith;

// Ten layers, of which the first, two in the middle and the last are faulty.
const std::map<uint64_t, const char*> kFaulty = {{0, "layers[0].islands[0].contours[0].points"},
                                                 {4, "layers[4].z_mm"},
                                                 {5, "layers[5].islands[0].rasters[0].points"},
                                                 {9, "layers[9].islands[0].contours[0].points"}};

v1::OptimizeBatchRequest FaultyBatch() {
  v1::OptimizeBatchRequest request = MakeBatch(10);
  for (int i = 0; i < 10; ++i) request.mutable_layers(i)->set_id(static_cast<uint64_t>(i) + 100);
  request.mutable_layers(0)->mutable_islands(0)->mutable_contours(0)->add_points(1);
  request.mutable_layers(4)->set_z_mm(std::numeric_limits<double>::infinity());
  request.mutable_layers(5)->mutable_islands(0)->mutable_rasters(0)->clear_points();
  request.mutable_layers(9)->mutable_islands(0)->mutable_contours(0)->clear_points();
  request.mutable_options()->set_result_order(v1::RESULT_ORDER_BUILD);
  return request;
}

v1::OptimizeBatchRequest WithoutFaulty(v1::OptimizeBatchRequest request) {
  for (auto faulty = kFaulty.rbegin(); faulty != kFaulty.rend(); ++faulty) {
    request.mutable_layers()->DeleteSubrange(static_cast<int>(faulty->first), 1);
  }
  return request;
}

TEST(PartialAnswers, StateTheFaultsAndAnswerTheOtherLayers) {
  TestService service;
  v1::OptimizeBatchRequest request = FaultyBatch();
  const Answer good = service.Batch(WithoutFaulty(request));
  ASSERT_TRUE(good.status.ok());
  request.mutable_options()->set_partial_answers(true);

  for (const Answer& answer : {service.Batch(request), service.Stream(request)}) {
    ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
    ASSERT_EQ(answer.layers.size(), 10u);
    size_t next_good = 0;
    for (uint64_t i = 0; i < 10; ++i) {
      const v1::LayerResult& layer = answer.layers[i];
      EXPECT_EQ(layer.index(), i);
      EXPECT_EQ(layer.id(), i + 100);
      const auto faulty = kFaulty.find(i);
      if (faulty != kFaulty.end()) {
        EXPECT_THAT(layer.fault(), StartsWith(faulty->second));
        EXPECT_EQ(layer.visits_size(), 0);
        continue;
      }
      EXPECT_TRUE(layer.fault().empty());
      v1::LayerResult same = good.layers[next_good++];
      EXPECT_EQ(layer.travel().total_mm(), same.travel().total_mm()) << i;
      EXPECT_EQ(layer.visits_size(), same.visits_size());
    }
    ASSERT_TRUE(answer.summary.has_value());
    EXPECT_EQ(answer.summary->layers(), 6u);
    EXPECT_EQ(answer.summary->faulty_layers(), 4u);
  }
  EXPECT_EQ(service.server().core().queue_layers, 0);
  EXPECT_EQ(service.server().core().admission.held_bytes(), 0);
}

TEST(PartialAnswers, AreAskedFor) {
  TestService service;

  EXPECT_EQ(service.Batch(FaultyBatch()).status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST(PartialAnswers, DoNotHideFaultsOfOptions) {
  TestService service;
  v1::OptimizeBatchRequest request = FaultyBatch();
  request.mutable_options()->set_partial_answers(true);
  request.mutable_options()->set_idle_speed_mm_s(0);

  EXPECT_EQ(service.Batch(request).status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST(PartialAnswers, OfAJobOfFaultyLayersAlone) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(3);
  for (v1::Layer& layer : *request.mutable_layers()) {
    layer.mutable_islands(0)->mutable_contours(0)->add_points(1);
  }
  request.mutable_options()->set_partial_answers(true);

  const Answer answer = service.Batch(request);

  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  EXPECT_EQ(answer.layers.size(), 3u);
  EXPECT_EQ(answer.summary->faulty_layers(), 3u);
}

// `auto` answers the first layer only when it knows the last one, which has to fit the window.
TEST(PartialAnswers, FaultyLayersThatWaitForTheirTurnLeaveRoomForOthers) {
  TestService service([](ServerOptions& options) { options.service.limits.window.layers = 8; });
  v1::OptimizeBatchRequest request = MakeBatch(20, "auto");
  for (int i = 1; i < 19; ++i) {
    request.mutable_layers(i)->mutable_islands(0)->mutable_contours(0)->add_points(1);
  }
  request.mutable_options()->set_partial_answers(true);
  request.mutable_options()->set_result_order(v1::RESULT_ORDER_BUILD);

  const Answer answer = service.Batch(request, absl::Seconds(10));

  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  ASSERT_EQ(answer.layers.size(), 20u);
  for (uint64_t i = 0; i < 20; ++i) EXPECT_EQ(answer.layers[i].index(), i);
}

}  // namespace
}  // namespace traverse
