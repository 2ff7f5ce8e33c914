// What is drawn of G-code is what the files do.

#include <gtest/gtest.h>

#include <cmath>

#include "client/gcode/gcode_job.h"
#include "client/gcode/rewrite.h"
#include "client/view/job_scene.h"
#include "engine/base/rng.h"
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

// A run whose routes turn every movable line of infill round, as far as the plan lets it.
report::JobRun RunOf(const InputJob& job, bool backwards) {
  report::JobRun run;
  for (const v1::Layer& layer : job.layers) {
    v1::LayerResult& result = run.result.layers.emplace_back();
    for (int i = 0; i < layer.plan().paths_size(); ++i) {
      v1::Visit& visit = *result.add_visits();
      visit.set_plan_path(static_cast<uint32_t>(i));
      const v1::PlanPath& path = layer.plan().paths(i);
      if (path.has_contour()) {
        visit.set_vertex(path.contour().entries_size() > 0 ? path.contour().entries(0) : 0);
      } else {
        visit.set_reversed(backwards && !path.open_path().one_way());
      }
    }
  }
  return run;
}

class DrawnGcode : public ::testing::TestWithParam<std::string> {};

// The meter that the figures come from shares no code with what draws the moves.
TEST_P(DrawnGcode, TravelsAsFarAsTheFileIsMeasuredTo) {
  const absl::StatusOr<InputJob> job =
      ReadGcodeJob(gcode::testing::TextOf(GetParam()), "part.gcode");
  ASSERT_TRUE(job.ok()) << job.status();
  const report::JobRun run = RunOf(*job, /*backwards=*/true);
  std::vector<gcode::LayerOrder> orders;
  for (size_t i = 0; i < job->layers.size(); ++i) {
    orders.push_back(OrderOf(*job->gcode, i, run.result.layers[i]));
  }
  const absl::StatusOr<GcodeRewrite> rewrite = RewriteGcode(*job->gcode, orders, {});
  ASSERT_TRUE(rewrite.ok()) << rewrite.status();

  const absl::StatusOr<Scene> scene = GcodeScene(*job, {"turned", &run}, *rewrite);
  ASSERT_TRUE(scene.ok()) << scene.status();

  ASSERT_EQ(scene->layers(), job->layers.size());
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
