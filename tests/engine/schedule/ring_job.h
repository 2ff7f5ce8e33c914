// A job of small layers, for tests of the chain.

#ifndef TRAVERSE_TESTS_ENGINE_SCHEDULE_RING_JOB_H_
#define TRAVERSE_TESTS_ENGINE_SCHEDULE_RING_JOB_H_

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "engine/engine.h"
#include "engine/strategy/registry.h"
#include "tests/support/recording_sink.h"
#include "tests/support/test_executor.h"

namespace traverse::testing {

// `count` contours of four vertices each on a ring, and a raster; every layer is turned a bit.
inline Plan RingLayer(int count, double turn) {
  IslandPaths island;
  for (int i = 0; i < count; ++i) {
    const double angle = turn + 2.4 * i;
    const Point c{50 + 30 * std::cos(angle), 50 + (20 + i) * std::sin(angle)};
    island.contours.push_back(
        MakeContour({{c.x, c.y}, {c.x + 3, c.y}, {c.x + 3, c.y + 3}, {c.x, c.y + 3}}));
    island.rasters.push_back(MakeOpenPath({c.x + 1, c.y + 1}, {c.x + 2, c.y + 2}));
  }
  return SequentialPlan({std::move(island)});
}

struct RunOptions {
  JobSpec spec;
  std::string strategy = "ni2opt";
  int layers = 12;
  int threads = 4;
  TestExecutor::Order order = TestExecutor::Order::kOldestFirst;
  std::map<int, Point> starts;
  bool extruded = false;  // two layers in turn, each a bit to the right of the last one
};

inline Plan Moved(Plan plan, double dx_mm) {
  for (Path& path : plan.paths) {
    for (Point& point : path.points) point.x += dx_mm;
  }
  return plan;
}

inline std::map<uint64_t, LayerOutcome> RunJob(const RunOptions& options) {
  RecordingSink sink;
  TestExecutor executor(options.threads, options.order);
  auto strategy = MakeStrategy(options.strategy, {});
  EXPECT_TRUE(strategy.ok()) << strategy.status();
  auto job = Job::Start(options.spec, *std::move(strategy), executor, sink);
  for (int i = 0; i < options.layers; ++i) {
    JobLayer layer;
    layer.plan =
        options.extruded ? Moved(RingLayer(12, i % 2), 0.01 * i) : RingLayer(3 + i % 4, 0.3 * i);
    const auto start = options.starts.find(i);
    if (start != options.starts.end()) layer.start = start->second;
    job->Add(std::move(layer));
  }
  job->Close();
  sink.Wait();
  EXPECT_EQ(job->pending(), 0);
  return sink.ByIndex();
}

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_ENGINE_SCHEDULE_RING_JOB_H_
