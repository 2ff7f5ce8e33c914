// A job whose layers are ended in view of the next ones is never longer than the same layers one
// after the other.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/schedule/layer_chain.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/recording_sink.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using testing::RandomPlan;

// Rings on a grid, hexagonal or square, if wanted with a raster each. So many routes are equally
// long. No layer is like another: each has its own radius.
struct Grid {
  int columns = 4;
  int rows = 4;
  bool hexagonal = false;
  bool rasters = false;
};

Plan GridLayer(const Grid& grid, int layer) {
  std::vector<IslandPaths> islands;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double x = 10 + 10 * column + (grid.hexagonal && row % 2 == 1 ? 5 : 0);
      const double y = 10 + (grid.hexagonal ? 8.66 : 10) * row;
      const double radius = 3 - 0.1 * layer;
      std::vector<Point> corners;
      for (int k = 0; k < 8; ++k)
        corners.push_back(
            {x + radius * std::cos(k * M_PI / 4), y + radius * std::sin(k * M_PI / 4)});
      IslandPaths island;
      island.contours.push_back(MakeContour(std::move(corners)));
      const double height = y + layer % 2;
      if (grid.rasters) island.rasters.push_back(MakeOpenPath({x - 2, height}, {x + 2, height}));
      islands.push_back(std::move(island));
    }
  }
  return SequentialPlan(std::move(islands));
}

std::vector<JobLayer> GridLayers(const Grid& grid, int count) {
  std::vector<JobLayer> layers;
  for (int i = 0; i < count; ++i) layers.push_back({GridLayer(grid, i), {}, {}});
  return layers;
}

using AutoSettingsByName = std::map<std::string, std::string>;

struct ChainRun {
  double total = 0;
  std::vector<Route> routes;
};

ChainRun RunChain(const std::vector<JobLayer>& layers, const JobSpec& spec,
                  const AutoSettingsByName& options, bool look_ahead, int threads = 2) {
  RecordingSink sink;
  TestExecutor executor(threads);
  auto job = Job::Start(spec, *MakeStrategy("auto", options), executor, sink);
  for (JobLayer layer : layers) {
    layer.more_follows = look_ahead;
    job->Add(std::move(layer));
  }
  job->Close();
  sink.Wait();
  ChainRun run;

  for (const auto& [index, outcome] : sink.ByIndex()) {
    EXPECT_TRUE(outcome.invalid_route.empty()) << outcome.invalid_route;
    EXPECT_TRUE(ValidateRoute(outcome.plan, outcome.route).ok());
    run.total += outcome.cost + outcome.cleaning_mm;
    run.routes.push_back(outcome.route);
  }
  EXPECT_EQ(run.routes.size(), layers.size());
  return run;
}

// Returns how much longer the layers one after the other are, as a share.
double ExpectNeverLonger(const std::vector<JobLayer>& layers, const JobSpec& spec = {},
                         AutoSettingsByName options = {}) {
  options["bound"] = "false";
  const ChainRun seeing = RunChain(layers, spec, options, true);
  const ChainRun blind = RunChain(layers, spec, options, false);
  EXPECT_LE(seeing.total, blind.total * (1 + 1e-9));
  EXPECT_EQ(seeing.routes, RunChain(layers, spec, options, true, 1).routes);
  return blind.total / seeing.total - 1;
}

TEST(NeverLonger, OnGridsWhereManyRoutesAreEquallyLong) {
  for (const Grid& grid :
       {Grid{3, 3, true}, Grid{3, 3, false, true}, Grid{4, 2, true, true}, Grid{7, 5}}) {
    for (const auto& [effort, seed] : {std::pair("0.05", uint64_t{21}), {"0.3", uint64_t{22}}}) {
      SCOPED_TRACE(absl::StrCat(grid.columns, " x ", grid.rows, grid.hexagonal ? " hexagonal" : "",
                                grid.rasters ? " with rasters" : "", ", effort ", effort, ", seed ",
                                seed));
      JobSpec spec;
      spec.seed = seed;
      ExpectNeverLonger(GridLayers(grid, 5), spec, {{"effort", effort}});
    }
  }
}

// Layers that repeat start from routes found before. Those that come more often are answered with
// these, and nothing is promised.
TEST(NeverLonger, InLongJobsWhereLayersComeTwice) {
  double saved = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    std::vector<JobLayer> layers;
    for (uint64_t i = 0; i < 45; ++i) {
      const uint64_t plan = i % 4 < 2 ? i : i - 2;
      layers.push_back({RandomPlan(100 * seed + plan, {.max_paths = 8}), {}, {}});
    }
    JobSpec spec;
    spec.seed = seed;
    if (seed % 2 == 0) spec.cleaning = CleaningSpec{{50, 50}, 7, 3};
    saved += ExpectNeverLonger(layers, spec, {{"effort", "0.1"}});
  }
  EXPECT_GT(saved, 4 * 0.02);
}

// Where the next layer is out of view, by its size or its cost, the one before it must not end
// where only the layers before it are the better for it.
TEST(NeverLonger, WhereLayersInViewAreFollowedByOthers) {
  for (uint64_t seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    std::vector<JobLayer> layers;
    Rng rng(seed);
    for (uint64_t i = 0; i < 12; ++i) {
      const int most = rng.Below(4) == 0 ? 66 : 10;
      layers.push_back(
          {RandomPlan(100 * seed + i, {.min_paths = most / 2, .max_paths = most}), {}, {}});
      if (rng.Below(6) == 0) layers.back().start = Point{10, 10};
    }
    JobSpec spec;
    spec.seed = seed;
    ExpectNeverLonger(layers, spec, {{"least_gain_each", "0.001"}});
  }
}

Plan DotsOnALine(const std::vector<double>& places) {
  IslandPaths island;
  for (const double x : places) island.contours.push_back(MakeContour({{x, 0}}));
  return SequentialPlan({std::move(island)});
}

// From 0 the first layer costs least if it ends on the right. All in view cost less if it ends on
// the left, as then each begins closer. But then the last one in view ends on the left too, and the
// layer behind it is far away on the right.
TEST(NeverLonger, WhereAllInViewIsAsGoodAsItLooksAndNoMore) {
  std::vector<JobLayer> layers;
  for (const std::vector<double>& places :
       {std::vector<double>{-10, 10.5}, {-11, 12.4}, {-14, 14}, {-15, 15}, {-16, 16}, {300}}) {
    layers.push_back({DotsOnALine(places), {}, {}});
  }
  ExpectNeverLonger(layers);
}

// The same with one layer in view.
TEST(NeverLonger, WhereOneLayerInViewIsAsGoodAsItLooksAndNoMore) {
  std::vector<JobLayer> layers;
  for (const std::vector<double>& places :
       {std::vector<double>{-10, 10.5}, {-11, 12.4}, {-50}, {-51}}) {
    layers.push_back({DotsOnALine(places), {}, {}});
  }
  ExpectNeverLonger(layers, {}, {{"least_gain_each", "0.001"}});
}

}  // namespace
}  // namespace traverse
