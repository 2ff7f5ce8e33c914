// Jobs that go well.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/support/service_fixture.h"

namespace traverse::testing {
namespace {

using ::testing::HasSubstr;

std::vector<uint64_t> Ids(const Answer& answer) {
  std::vector<uint64_t> ids;
  for (const v1::LayerResult& layer : answer.layers) ids.push_back(layer.id());
  return ids;
}

// All of a result but its time of work.
std::string Routes(const Answer& answer) {
  std::string text;
  for (v1::LayerResult layer : answer.layers) {
    layer.clear_solve_seconds();
    text += layer.DebugString();
  }
  return text;
}

TEST(Service, BatchAnswersEachLayerThenTheSummary) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(5);
  request.mutable_options()->set_job_id("plate 7");

  const Answer answer = service.Batch(request);

  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  EXPECT_EQ(Ids(answer), (std::vector<uint64_t>{1, 2, 3, 4, 5}));
  ASSERT_TRUE(answer.summary.has_value());
  EXPECT_EQ(answer.summary->job_id(), "plate 7");
  EXPECT_EQ(answer.summary->strategy(), "none");
  EXPECT_EQ(answer.summary->layers(), 5u);
  double travel_mm = 0;
  for (const v1::LayerResult& layer : answer.layers) travel_mm += layer.travel().total_mm();
  EXPECT_NEAR(answer.summary->travel().total_mm(), travel_mm, 1e-9);
  EXPECT_NEAR(answer.summary->idle_seconds(), travel_mm / 20.32, 1e-9);
}

TEST(Service, PassesOnWhatTheSearchTellsOfItself) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(2, "tabu");
  (*request.mutable_options()->mutable_strategy()->mutable_options())["diversifications"] = "2";

  const Answer answer = service.Batch(request);

  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  for (const v1::LayerResult& layer : answer.layers) {
    EXPECT_EQ(layer.statistics().at("points_bbcp"), 2);
  }
}

TEST(Service, VisitsNameIslandsContoursAndRasters) {
  TestService service;
  v1::OptimizeBatchRequest request;
  request.mutable_options()->mutable_strategy()->set_name("none");
  v1::Layer& layer = *request.add_layers();
  layer = MakeLayer(1, 2);
  *layer.mutable_islands(0)->add_contours() = layer.islands(0).contours(0);

  const Answer answer = service.Batch(request);

  ASSERT_EQ(answer.layers.size(), 1u);
  std::vector<std::string> visits;
  for (const v1::Visit& visit : answer.layers[0].visits()) {
    EXPECT_TRUE(visit.has_island());
    visits.push_back(std::to_string(visit.island()) + (visit.has_contour()
                                                           ? "c" + std::to_string(visit.contour())
                                                           : "r" + std::to_string(visit.raster())));
    EXPECT_EQ(visit.has_vertex(), visit.has_contour());
    EXPECT_EQ(visit.has_reversed(), visit.has_raster());
  }
  EXPECT_EQ(visits, (std::vector<std::string>{"0c0", "0c1", "1c0", "0r0", "1r0"}));
}

TEST(Service, VisitsOfAPlanNameItsPaths) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(0);
  v1::Plan& plan = *request.add_layers()->mutable_plan();
  for (const double x : {5.0, 1.0}) {
    v1::Contour& contour = *plan.add_paths()->mutable_contour();
    contour.add_points(x);
    contour.add_points(0);
  }
  plan.add_nodes()->mutable_any_order()->add_children(1);
  plan.mutable_nodes(0)->mutable_any_order()->add_children(2);
  plan.add_nodes()->set_path(0);
  plan.add_nodes()->set_path(1);

  const Answer answer = service.Batch(request);

  ASSERT_EQ(answer.layers.size(), 1u) << answer.status.error_message();
  ASSERT_EQ(answer.layers[0].visits_size(), 2);
  EXPECT_FALSE(answer.layers[0].visits(0).has_island());
  EXPECT_EQ(answer.layers[0].visits(0).plan_path(), 0u);
  EXPECT_EQ(answer.layers[0].visits(1).plan_path(), 1u);
  EXPECT_DOUBLE_EQ(answer.layers[0].travel().total_mm(), 9);
}

TEST(Service, StreamEqualsBatchHoweverItIsCut) {
  TestService service;
  const v1::OptimizeBatchRequest request = MakeBatch(50);
  const Answer batch = service.Batch(request);

  for (const int layers_per_message : {1, 7, 1000}) {
    const Answer stream = service.Stream(request, layers_per_message);
    ASSERT_TRUE(stream.status.ok()) << stream.status.error_message();
    EXPECT_EQ(Routes(stream), Routes(batch));
    EXPECT_EQ(stream.summary->layers(), 50u);
  }
}

// Rings that lie elsewhere in each layer.
v1::Layer ScatteredLayer(uint64_t id) {
  v1::Layer layer;
  layer.set_id(id);
  for (uint64_t i = 0; i < 5; ++i) {
    v1::Contour& ring = *layer.add_islands()->add_contours();
    const double x = static_cast<double>((37 * i + 11 * id) % 97);
    const double y = static_cast<double>((53 * i + 29 * id) % 89);
    for (int v = 0; v < 300; ++v) {
      ring.add_points(x + 3 * std::cos(0.02 * v));
      ring.add_points(y + 3 * std::sin(0.02 * v));
    }
  }
  return layer;
}

// Large messages are read in pieces, small ones come one by one: neither may change a route.
TEST(Service, LookingAheadDependsOnWhatWasSentAlone) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(0, "auto");
  for (uint64_t id = 1; id <= 8; ++id) *request.add_layers() = ScatteredLayer(id);
  const Answer batch = service.Batch(request);
  ASSERT_TRUE(batch.status.ok()) << batch.status.error_message();
  const Answer blind = service.Stream(request);

  EXPECT_EQ(Routes(service.Stream(request, 1000)), Routes(batch));
  request.mutable_options()->set_look_ahead(true);
  EXPECT_EQ(Routes(service.Stream(request)), Routes(batch));
  EXPECT_EQ(Routes(service.Stream(request, 3)), Routes(batch));
  EXPECT_LT(batch.summary->travel().total_mm(), blind.summary->travel().total_mm());
}

TEST(Service, NobodyHasToSendALayerToHaveTheOneBeforeAnswered) {
  TestService service;
  grpc::ClientContext context;
  const auto stream = service.stub().Optimize(&context);
  v1::OptimizeRequest message;
  message.mutable_options()->mutable_strategy()->set_name("auto");

  for (uint64_t id = 1; id <= 6; id += 2) {
    *message.add_layers() = MakeLayer(id);
    *message.add_layers() = MakeLayer(id + 1);
    ASSERT_TRUE(stream->Write(message));
    message.Clear();
    v1::OptimizeResponse response;
    for (const uint64_t expected : {id, id + 1}) {
      ASSERT_TRUE(stream->Read(&response));
      EXPECT_EQ(response.layer().id(), expected);
    }
  }
  stream->WritesDone();
  v1::OptimizeResponse summary;
  ASSERT_TRUE(stream->Read(&summary));
  EXPECT_EQ(summary.summary().layers(), 6u);
  EXPECT_TRUE(stream->Finish().ok());
}

TEST(Service, AWindowOfOneLayerStillLooksAheadAndCleans) {
  TestService service([](ServerOptions& options) {
    options.service.limits.window = {.layers = 1, .points = 1};
    options.service.admission.max_queued_points = 1;
  });
  v1::OptimizeBatchRequest request = MakeBatch(30, "auto");
  request.mutable_options()->set_look_ahead(true);
  v1::Cleaning& cleaning = *request.mutable_options()->mutable_cleaning();
  cleaning.mutable_point();

  // With 5, the last layer in view of the first one is the last before a cleaning.
  for (const uint32_t every_layers : {2u, 5u, 7u}) {
    SCOPED_TRACE(every_layers);
    cleaning.set_every_layers(every_layers);

    EXPECT_EQ(service.Batch(request).layers.size(), 30u);
    EXPECT_EQ(service.Stream(request).layers.size(), 30u);
  }
}

TEST(Service, JobsWithoutLayersHaveASummary) {
  TestService service;

  const Answer batch = service.Batch({});
  const Answer stream = service.Stream({});

  for (const Answer& answer : {batch, stream}) {
    ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
    ASSERT_TRUE(answer.summary.has_value());
    EXPECT_EQ(answer.summary->layers(), 0u);
    EXPECT_FALSE(answer.summary->job_id().empty());
    EXPECT_EQ(answer.summary->lower_bound(), 0);
  }
}

TEST(Service, DegenerateGeometryIsNoError) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(0);
  request.add_layers();                 // empty
  request.add_layers()->add_islands();  // an island of nothing
  v1::Island& island = *request.add_layers()->add_islands();
  v1::Contour& point = *island.add_contours();
  for (const double c : {1.0, 1.0}) point.add_points(c);
  v1::Contour& repeated = *island.add_contours();
  for (const double c : {2.0, 2.0, 2.0, 2.0, 2.0, 2.0}) repeated.add_points(c);
  v1::OpenPath& nowhere = *island.add_rasters();
  for (const double c : {3.0, 3.0, 3.0, 3.0}) nowhere.add_points(c);
  request.add_layers()->mutable_plan();  // a plan of nothing

  const Answer answer = service.Batch(request);

  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  ASSERT_EQ(answer.layers.size(), 4u);
  EXPECT_EQ(answer.layers[2].visits_size(), 3);
}

TEST(Service, BuildOrderHoldsBackWhatIsEarly) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(200);
  request.mutable_options()->set_result_order(v1::RESULT_ORDER_BUILD);
  for (v1::Layer& layer : *request.mutable_layers()) {
    layer.mutable_start();  // each at (0, 0): no layer waits for another
  }

  const Answer answer = service.Batch(request);

  ASSERT_EQ(answer.layers.size(), 200u);
  for (size_t i = 0; i < 200; ++i) EXPECT_EQ(answer.layers[i].index(), i);
}

TEST(Service, CleaningCountsInTheSummary) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(5);
  v1::Cleaning& cleaning = *request.mutable_options()->mutable_cleaning();
  cleaning.mutable_point()->set_x_mm(-50);
  cleaning.set_every_layers(2);

  for (const Answer& answer : {service.Batch(request), service.Stream(request)}) {
    ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
    double cleaning_mm = 0;
    for (const v1::LayerResult& layer : answer.layers) cleaning_mm += layer.cleaning_mm();
    EXPECT_GT(cleaning_mm, 100);
    EXPECT_NEAR(answer.summary->cleaning_mm(), cleaning_mm, 1e-9);
  }
}

TEST(Service, WindowOfOneLayerStillFinishesJobsWithCleaning) {
  TestService service([](ServerOptions& options) {
    options.service.limits.window = {.layers = 1, .points = 1};
    options.service.admission.max_queued_points = 1;
  });
  v1::OptimizeBatchRequest request = MakeBatch(30);
  v1::Cleaning& cleaning = *request.mutable_options()->mutable_cleaning();
  cleaning.mutable_point();
  cleaning.set_every_layers(1);

  EXPECT_EQ(service.Batch(request).layers.size(), 30u);
  EXPECT_EQ(service.Stream(request).layers.size(), 30u);
}

TEST(Service, ListsStrategiesWithTheDefault) {
  TestService service;
  grpc::ClientContext context;
  v1::ListStrategiesResponse response;

  const grpc::Status status = service.stub().ListStrategies(&context, {}, &response);

  ASSERT_TRUE(status.ok()) << status.error_message();
  std::set<std::string> names;
  for (const v1::StrategyInfo& info : response.strategies()) {
    names.insert(info.name());
    EXPECT_FALSE(info.summary().empty());
  }
  EXPECT_EQ(names.count("none"), 1u);
  EXPECT_EQ(names.count(response.default_strategy()), 1u);
  EXPECT_FALSE(response.server_version().empty());
}

TEST(Service, MetricsCountWhatWasDone) {
  TestService service;
  service.Batch(MakeBatch(3));

  const std::string text = service.server().core().MetricsText();

  EXPECT_THAT(text, HasSubstr("traverse_jobs_total{code=\"OK\",strategy=\"none\"} 1"));
  EXPECT_THAT(text, HasSubstr("traverse_layers_total{stop=\"LOCAL_OPTIMUM\",strategy=\"none\"} 3"));
  EXPECT_THAT(text, HasSubstr("traverse_layer_solve_seconds_count{strategy=\"none\"} 3"));
  EXPECT_THAT(text, HasSubstr("traverse_job_seconds_count{strategy=\"none\"} 1"));
  EXPECT_THAT(text, HasSubstr("traverse_queue_layers 0"));
  EXPECT_THAT(text, HasSubstr("traverse_jobs_in_flight 0"));
  EXPECT_THAT(text, HasSubstr("traverse_workers_busy "));
  EXPECT_THAT(text, HasSubstr("traverse_travel_given_mm_total "));
  EXPECT_THAT(text, HasSubstr("traverse_travel_mm_total "));
  EXPECT_THAT(text, HasSubstr("traverse_idle_seconds_saved_total "));
  EXPECT_THAT(text, HasSubstr("traverse_optimality_gap_ratio_count "));
  EXPECT_THAT(text, HasSubstr("traverse_rejected_total{reason=\"queue\"} 0"));
  EXPECT_THAT(text, HasSubstr("traverse_invalid_routes_total 0"));
  EXPECT_THAT(text, HasSubstr("traverse_build_info{version=\""));
  EXPECT_THAT(text, HasSubstr("process_resident_memory_bytes "));
  EXPECT_THAT(text, HasSubstr("process_cpu_seconds_total "));
}

TEST(Service, MetricsTellWhetherTheServerTakesJobs) {
  TestService service;
  EXPECT_THAT(service.server().core().MetricsText(), HasSubstr("traverse_ready 1"));

  service.server().core().admission.StartDraining();

  EXPECT_THAT(service.server().core().MetricsText(), HasSubstr("traverse_ready 0"));
}

TEST(Service, GivesMemoryBackOnceItIsIdleForSomeSeconds) {
  TestService service;  // embedded: it does not do so by itself
  ServiceCore& core = service.server().core();
  const auto at = [begin = std::chrono::steady_clock::now()](int seconds) {
    return begin + std::chrono::seconds(seconds);
  };
  EXPECT_FALSE(core.TrimIfIdle(at(100)));  // nothing was used

  ASSERT_TRUE(service.Batch(MakeBatch(3)).status.ok());
  ASSERT_TRUE(service.Eventually([&core] { return core.calls() == 0; }));

  EXPECT_FALSE(core.TrimIfIdle(at(101)));
  EXPECT_FALSE(core.TrimIfIdle(at(104)));
  EXPECT_TRUE(core.TrimIfIdle(at(107)));
  EXPECT_FALSE(core.TrimIfIdle(at(120)));
}

// A large message is read in pieces between which others have their turns; read at one go, it keeps
// the only worker from a job of one layer until all of its layers are there.
TEST(Fairness, ASmallJobIsDoneWhileALargeOneIsStillBeingRead) {
  constexpr int kLayers = 60'000;
  TestService service([](ServerOptions& options) { options.service.threads = 1; });
  ServiceCore& core = service.server().core();
  const v1::OptimizeBatchRequest large = MakeBatch(kLayers);
  const v1::OptimizeBatchRequest small = MakeBatch(1);
  bool done_meanwhile = false;
  // The thread of this test may be kept from running while the large one is read.
  for (int attempt = 0; attempt < 10 && !done_meanwhile; ++attempt) {
    grpc::ClientContext context;
    const auto reader = service.stub().OptimizeBatch(&context, large);
    while (core.queue_layers == 0) std::this_thread::yield();
    EXPECT_TRUE(service.Batch(small).status.ok());
    done_meanwhile = core.queue_layers < kLayers;
    context.TryCancel();
    v1::OptimizeBatchResponse response;
    while (reader->Read(&response)) {
    }
    reader->Finish();
    ASSERT_TRUE(service.Eventually([&core] { return core.queue_layers == 0; }));
  }
  EXPECT_TRUE(done_meanwhile);
}

}  // namespace
}  // namespace traverse::testing
