// What pictures and the report are made of: client/view/scene/scene.h and job_scene.h.

#include "client/view/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/formats/read_input.h"
#include "client/view/scene/job_scene.h"
#include "tests/client/api/fake_service.h"
#include "tests/support/golden.h"

namespace traverse::view {
namespace {

using ::testing::ElementsAre;

// A square and a line above it.
DrawnLayer SquareAndLine() {
  DrawnLayer layer;
  layer.paths.push_back({0, true, {{0, 0}, {10, 0}, {10, 10}, {0, 10}}});
  layer.paths.push_back({2, false, {{0, 20}, {5, 21}, {10, 20}}});
  return layer;
}

DrawnVisit Visit(size_t path, size_t entry, std::vector<DrawnPoint> via = {}) {
  DrawnVisit visit;
  visit.path = path;
  visit.entry = entry;
  visit.via = std::move(via);
  return visit;
}

TEST(MovesOf, LeadFromExitToEntryOverTheCornersAndLeaveOutThoseOfNoLength) {
  const DrawnLayer layer = SquareAndLine();

  const DrawnRoute route{{0, 0}, {Visit(0, 0), Visit(1, 1, {{12, 5}, {12, 5}})}};

  const DrawnMove over_a_corner = {{0, 0}, {12, 5}, {10, 20}};
  EXPECT_THAT(MovesOf(layer, route), ElementsAre(over_a_corner));
  EXPECT_EQ(EndOf(layer, route), (DrawnPoint{0, 20}));
}

TEST(MovesOf, MayBeThoseOfOneForm) {
  DrawnLayer layer = SquareAndLine();
  DrawnRoute route{{3, 3}, {Visit(0, 0), Visit(1, 0)}};
  route.visits[0].form = DrawnForm::kHidden;
  route.visits[1].form = DrawnForm::kRetracted;
  layer.routes = {route};

  const DrawnMove hidden = {{3, 3}, {0, 0}};
  EXPECT_THAT(MovesOf(layer, route, DrawnForm::kHidden), ElementsAre(hidden));
  EXPECT_EQ(MovesOf(layer, route).size(), 2u);
  EXPECT_TRUE(MovesOf(layer, route, DrawnForm::kOpen).empty());
  EXPECT_THAT(FormsOf(layer), ElementsAre(DrawnForm::kRetracted, DrawnForm::kHidden));
}

TEST(MovesOf, RouteWithoutPathsEndsWhereItStarts) {
  EXPECT_TRUE(MovesOf({}, {{3, 4}, {}}).empty());
  EXPECT_EQ(EndOf({}, {{3, 4}, {}}), (DrawnPoint{3, 4}));
}

TEST(Vanished, CountsAMoveForBothDirectionsAndAsOftenAsItIsThere) {
  const DrawnMove there = {{0, 0}, {5, 5}};
  const DrawnMove back = {{5, 5}, {0, 0}};
  const DrawnMove other = {{0, 0}, {6, 5}};

  EXPECT_TRUE(Vanished({there}, {back}).empty());
  EXPECT_THAT(Vanished({there, other}, {back}), ElementsAre(other));
  EXPECT_THAT(Vanished({there, back, there}, {there, there}), ElementsAre(there));
}

TEST(LayerWithMostSaved, ComparesTheRouteShownWithTheOneGiven) {
  Scene scene;
  scene.layer_ids = {1, 2, 3};
  scene.routes.resize(3);
  scene.routes[0].layers = {{10, 0, {}}, {20, 0, {}}, {30, 0, {}}};
  scene.routes[1].layers = {{1, 0, {}}, {20, 0, {}}, {30, 0, {}}};
  scene.routes[2].layers = {{10, 0, {}}, {20, 0, {}}, {29, 0, {}}};

  EXPECT_EQ(LayerWithMostSaved(scene), 0u);

  scene.shown = 2;
  EXPECT_EQ(LayerWithMostSaved(scene), 2u);
}

// One run over a layer of two islands, in the order of the file, the second raster backwards.
TEST(JobScene, NamesTheFeaturesOfIslandsAndReadsVisits) {
  InputJob job = *ReadInput(testing::DataPath("damat/two_islands.damat"));
  job.layers.resize(1);
  report::JobRun run;
  v1::LayerResult& result = run.result.layers.emplace_back(testing::KeepOrder(job.layers[0], 0));
  result.mutable_visits(3)->set_reversed(true);
  result.mutable_travel()->set_total_mm(12);
  run.result.summary.mutable_travel()->set_total_mm(12);
  run.result.summary.set_idle_seconds(6);

  const Scene scene = JobScene(job, run, {{"auto", &run}});
  const DrawnLayer drawn = scene.layer(0);

  EXPECT_EQ(scene.title, "two_islands.damat");
  ASSERT_EQ(scene.routes.size(), 2u);
  EXPECT_EQ(scene.routes[1].layers[0].seconds, 6);
  ASSERT_EQ(drawn.routes.size(), 2u);
  std::vector<std::string> features;
  for (size_t i = 0; i < drawn.paths.size(); ++i) {
    EXPECT_EQ(drawn.routes[0].visits[i].path, i);
    features.push_back(scene.features[drawn.paths[i].feature]);
  }
  EXPECT_THAT(features,
              ElementsAre("outer contour", "inner contour", "raster", "raster", "outer contour"));
  EXPECT_EQ(drawn.routes[0].visits[3].entry, 1u);
}

}  // namespace
}  // namespace traverse::view
