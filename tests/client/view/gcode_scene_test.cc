// What is drawn of G-code is what the files do.

#include <gtest/gtest.h>

#include <cmath>

#include "client/api/embedded.h"
#include "client/api/optimizer_client.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/rewrite.h"
#include "client/view/job_scene.h"
#include "tests/client/gcode/corpus.h"

namespace traverse::view {
namespace {

double LengthOf(const std::vector<DrawnMove>& moves) {
  double sum = 0;
  for (const DrawnMove& move : moves) {
    for (size_t i = 1; i < move.size(); ++i) {
      sum += std::hypot(move[i].x - move[i - 1].x, move[i].y - move[i - 1].y);
    }
  }
  return sum;
}

// A run by the service.
report::JobRun RunOf(const InputJob& job, const std::string& strategy) {
  v1::JobOptions options = job.options;
  options.clear_strategy();
  options.mutable_strategy()->set_name(strategy);
  const auto service = EmbeddedService::Start(2);
  EXPECT_TRUE(service.ok());
  report::JobRun run;
  run.result = *OptimizerClient((*service)->channel()).Optimize(options, job.layers);
  return run;
}

class DrawnGcode : public ::testing::TestWithParam<std::string> {};

// The meter that the figures come from shares no code with what draws the moves.
TEST_P(DrawnGcode, TravelsAsFarAsTheFileIsMeasuredTo) {
  GcodeOptions options;
  options.policy = gcode::Policy::kFree;
  const absl::StatusOr<InputJob> job =
      ReadGcodeJob(gcode::testing::TextOf(GetParam()), "part.gcode", options);
  ASSERT_TRUE(job.ok()) << job.status();
  // The writer takes some layers from the one and some from the other.
  const std::vector<report::JobRun> runs = {RunOf(*job, "greedy"), RunOf(*job, "ni2opt")};
  std::vector<gcode::FileOrder> tries;
  for (const report::JobRun& run : runs) {
    gcode::FileOrder& orders = tries.emplace_back();
    for (size_t i = 0; i < job->layers.size(); ++i) {
      orders.push_back(OrderOf(*job->gcode, i, run.result.layers[i]));
    }
  }
  const absl::StatusOr<GcodeRewrite> rewrite =
      RewriteGcode(*job->gcode, tries, {options.policy, "1.0", 2});
  ASSERT_TRUE(rewrite.ok()) << rewrite.status();

  const absl::StatusOr<Scene> scene = GcodeScene(*job, "ni2opt", runs, *rewrite);
  ASSERT_TRUE(scene.ok()) << scene.status();

  ASSERT_EQ(scene->layers(), job->layers.size());
  EXPECT_FALSE(scene->routes[1].gap) << "a bound on routes is none on files";
  for (size_t i = 0; i < scene->layers(); ++i) {
    const DrawnLayer layer = scene->layer(i);
    for (size_t route = 0; route < 2; ++route) {
      const double measured = scene->routes[route].layers[i].travel_mm;
      EXPECT_NEAR(LengthOf(MovesOf(layer, layer.routes[route])), measured, 0.01 * measured + 0.5)
          << "layer " << i + 1 << ", route " << route;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kept, DrawnGcode, ::testing::ValuesIn(gcode::testing::KeptFiles()),
                         [](const auto& info) { return gcode::testing::NameOf(info.param); });

}  // namespace
}  // namespace traverse::view
