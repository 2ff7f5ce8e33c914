// Layer.initial_route: what is translated, and what is refused, with the first visit at fault.

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "server/translate/translate.h"
#include "tests/server/support/service_fixture.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::Answer;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::StatusIs;
using testing::TestService;

v1::Layer ParseLayer(const std::string& text) {
  v1::Layer layer;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &layer)) << text;
  return layer;
}

// Two islands: a contour and two rasters, of which the second is one-way; two contours.
constexpr char kIslands[] = R"(
  islands { contours { points: [0, 0, 9, 0, 9, 9] }
            rasters { points: [1, 1, 8, 1] } rasters { points: [1, 2, 8, 2] one_way: true } }
  islands { contours { points: [20, 0, 29, 0, 29, 9] entries: [2] } contours { points: [25, 1] } } )";

// A fixed order, then three paths of which the second comes before the first.
constexpr char kPlan[] = R"(
  plan { paths { contour { points: [0, 0, 9, 0] } } paths { open_path { points: [1, 1, 8, 1] } }
         paths { contour { points: [5, 5] } } paths { open_path { points: [2, 2, 3, 3] one_way: true } }
         nodes { in_order { children: [1, 2] } } nodes { path: 0 }
         nodes { any_order { children: [3, 4, 5] before { first: 1 second: 0 } } }
         nodes { path: 1 } nodes { path: 2 } nodes { path: 3 } } )";

std::string InIsland(int island, const char* path, const char* entry) {
  return absl::StrCat("initial_route { island: ", island, " ", path, " ", entry, " } ");
}

std::string OfPlan(const char* visit) { return absl::StrCat("initial_route { ", visit, " } "); }

const std::string& LegalIslandRoute() {
  static const auto& route = *new std::string(
      InIsland(1, "contour: 1", "vertex: 0") + InIsland(0, "contour: 0", "vertex: 2") +
      InIsland(1, "contour: 0", "vertex: 2") + InIsland(0, "raster: 1", "reversed: false") +
      InIsland(0, "raster: 0", "reversed: true"));
  return route;
}

TEST(InitialRoute, OfIslandsArrives) {
  ASSERT_OK_AND_ASSIGN(const LabelledLayer layer,
                       LayerFromProto(ParseLayer(kIslands + LegalIslandRoute()), 0, false));

  // Island by island the contours, then the rasters.
  EXPECT_THAT(layer.layer.initial_route,
              ElementsAre(Visit{4, 0}, Visit{0, 2}, Visit{3, 2}, Visit{2, 0}, Visit{1, 1}));
}

TEST(InitialRoute, OfAPlanArrives) {
  const std::string route =
      OfPlan("plan_path: 0 vertex: 1") + OfPlan("plan_path: 3 reversed: false") +
      OfPlan("plan_path: 2 vertex: 0") + OfPlan("plan_path: 1 reversed: true");
  ASSERT_OK_AND_ASSIGN(const LabelledLayer layer,
                       LayerFromProto(ParseLayer(kPlan + route), 0, false));

  EXPECT_THAT(layer.layer.initial_route,
              ElementsAre(Visit{0, 1}, Visit{3, 0}, Visit{2, 0}, Visit{1, 1}));
}

TEST(InitialRoute, MayBeMissing) {
  for (const char* text : {kIslands, kPlan, "", "plan {}"}) {
    ASSERT_OK_AND_ASSIGN(const LabelledLayer layer, LayerFromProto(ParseLayer(text), 0, false));
    EXPECT_TRUE(layer.layer.initial_route.empty());
  }
}

struct BadRoute {
  std::string route;
  std::string error;  // behind layers[3].initial_route
  absl::StatusCode code = absl::StatusCode::kInvalidArgument;
};

void ExpectRefused(const std::string& layer, const BadRoute& bad, bool interleaved = false) {
  EXPECT_THAT(LayerFromProto(ParseLayer(layer + bad.route), 3, interleaved),
              StatusIs(bad.code, "layers[3].initial_route" + bad.error))
      << bad.route;
}

TEST(InitialRoute, IllegalOnesOfIslandsAreRefused) {
  const std::string first = InIsland(0, "contour: 0", "vertex: 0");
  const BadRoute cases[] = {
      {"initial_route { contour: 0 vertex: 0 }", "[0].island: not set"},
      {InIsland(2, "contour: 0", "vertex: 0"), "[0].island: 2, but the layer has 2"},
      {InIsland(0, "", "vertex: 0"), "[0]: set contour or raster"},
      {InIsland(0, "plan_path: 0", "vertex: 0"), "[0].plan_path: set, but the layer has islands"},
      {first + InIsland(1, "contour: 2", "vertex: 0"), "[1].contour: 2, but there are 2"},
      {first + InIsland(1, "raster: 0", "reversed: true"), "[1].raster: 0, but there are 0"},
      {InIsland(0, "raster: 4000000000", "reversed: true"),
       "[0].raster: 4000000000, but there are 2"},
      {InIsland(0, "contour: 0", ""), "[0].vertex: not set"},
      {InIsland(0, "contour: 0", "reversed: false"),
       "[0].reversed: set, but the path is a contour"},
      {InIsland(0, "raster: 0", ""), "[0].reversed: not set"},
      {InIsland(0, "raster: 0", "vertex: 0"), "[0].vertex: set, but the path is open"},
      {InIsland(0, "contour: 0", "vertex: 3"), "[0].vertex: 3 is not a vertex of a contour of 3"},
      {InIsland(0, "contour: 0", "vertex: 4000000000"),
       "[0].vertex: 4000000000 is not a vertex of a contour of 3"},
      {first + InIsland(1, "contour: 0", "vertex: 0"),
       "[1].vertex: 0 is not among the contour's entries"},
      {first + first, "[1]: contour 0 of island 0 is visited before, by initial_route[0]"},
      {first + InIsland(0, "raster: 0", "reversed: false"),
       "[1]: raster 0 of island 0 comes too early: contour 0 of island 1 must come before it"},
      {first, ": raster 0 of island 0 is not visited"},
      {LegalIslandRoute() + first,
       "[5]: contour 0 of island 0 is visited before, by initial_route[1]"},
  };
  for (const BadRoute& bad : cases) ExpectRefused(kIslands, bad);
  ExpectRefused("", {first, "[0].island: 0, but the layer has 0"});
}

TEST(InitialRoute, IsBoundByTheDeposition) {
  const std::string first = InIsland(0, "contour: 0", "vertex: 0");
  ExpectRefused(
      kIslands,
      {LegalIslandRoute(),
       "[0]: contour 1 of island 1 comes too early: contour 0 of island 1 must come before it"},
      /*interleaved=*/true);
  ExpectRefused(
      kIslands,
      {first + InIsland(1, "contour: 0", "vertex: 2"),
       "[1]: contour 0 of island 1 comes too early: raster 0 of island 0 must come before it"},
      /*interleaved=*/true);
  ExpectRefused(
      kIslands,
      {first + InIsland(0, "raster: 1", "reversed: true"), "[1].reversed: the path is one-way"},
      /*interleaved=*/true);
}

TEST(InitialRoute, IllegalOnesOfPlansAreRefused) {
  const std::string first = OfPlan("plan_path: 0 vertex: 0");
  const BadRoute cases[] = {
      {OfPlan("island: 0 contour: 0 vertex: 0"), "[0].island: set, but the layer has a plan"},
      {OfPlan("contour: 0 vertex: 0"), "[0].contour: set, but the layer has a plan"},
      {first + OfPlan("raster: 0 reversed: true"), "[1].raster: set, but the layer has a plan"},
      {OfPlan("vertex: 0"), "[0]: set plan_path"},
      {OfPlan("plan_path: 4 vertex: 0"), "[0].plan_path: 4, but there are 4"},
      {OfPlan("plan_path: 1 reversed: false"),
       "[0]: plan_path 1 comes too early: plan_path 2 must come before it"},
      {OfPlan("plan_path: 3 reversed: false"),
       "[0]: plan_path 3 comes too early: plan_path 0 must come before it"},
      {first + OfPlan("plan_path: 1 reversed: false"),
       "[1]: plan_path 1 comes too early: plan_path 2 must come before it"},
      {first + OfPlan("plan_path: 3 reversed: true"), "[1].reversed: the path is one-way"},
      {first + OfPlan("plan_path: 3 reversed: false") + OfPlan("plan_path: 3 reversed: false"),
       "[2]: plan_path 3 is visited before, by initial_route[1]"},
      // What can be said of one visit alone does not come before what is wrong with an earlier one.
      {OfPlan("plan_path: 2 vertex: 0") + OfPlan("plan_path: 9 vertex: 0"),
       "[0]: plan_path 2 comes too early: plan_path 0 must come before it"},
      {first + OfPlan("plan_path: 9 vertex: 0"), "[1].plan_path: 9, but there are 4"},
  };
  for (const BadRoute& bad : cases) ExpectRefused(kPlan, bad);
  ExpectRefused("plan {} ", {first, "[0].plan_path: 0, but there are 0"});
}

TEST(InitialRoute, OfALaterVersionIsUnimplemented) {
  v1::Layer layer = ParseLayer(kPlan + OfPlan("plan_path: 0 vertex: 0"));
  layer.mutable_initial_route(0)
      ->GetReflection()
      ->MutableUnknownFields(layer.mutable_initial_route(0))
      ->AddVarint(99, 1);

  EXPECT_THAT(LayerFromProto(layer, 3, false),
              StatusIs(absl::StatusCode::kUnimplemented,
                       HasSubstr("layers[3].initial_route[0]: field number 99")));
}

v1::OptimizeBatchRequest BatchWithRoutes() {
  v1::OptimizeBatchRequest request;
  request.mutable_options()->mutable_strategy()->set_name("none");
  request.mutable_options()->set_result_order(v1::RESULT_ORDER_BUILD);
  *request.add_layers() = ParseLayer(kIslands + LegalIslandRoute());
  *request.add_layers() = ParseLayer(kIslands + InIsland(0, "contour: 0", "vertex: 7"));
  *request.add_layers() = ParseLayer(kIslands + LegalIslandRoute());
  return request;
}

TEST(InitialRoute, AtFaultCostsTheJobUnlessPartialAnswersAreAskedFor) {
  TestService service;
  const char* fault = "layers[1].initial_route[0].vertex: 7 is not a vertex of a contour of 3";
  v1::OptimizeBatchRequest request = BatchWithRoutes();
  for (const Answer& answer : {service.Batch(request), service.Stream(request)}) {
    EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(answer.status.error_message(), fault);
  }
  request.mutable_options()->set_partial_answers(true);

  const Answer answer = service.Batch(request);

  ASSERT_TRUE(answer.status.ok()) << answer.status.error_message();
  ASSERT_EQ(answer.layers.size(), 3u);
  EXPECT_EQ(answer.layers[1].fault(), fault);
  for (const size_t good : {size_t{0}, size_t{2}}) {
    const auto& visits = answer.layers[good].visits();
    ASSERT_EQ(visits.size(), 5);
    for (int i = 0; i < visits.size(); ++i) {
      EXPECT_EQ(visits[i].ShortDebugString(),
                request.layers(0).initial_route(i).ShortDebugString());
    }
  }
}

}  // namespace
}  // namespace traverse
