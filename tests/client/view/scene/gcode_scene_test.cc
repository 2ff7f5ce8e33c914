// What is drawn of G-code is what the files do.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/api/embedded.h"
#include "client/api/optimizer_client.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/rewrite.h"
#include "client/view/scene/job_scene.h"
#include "tests/client/gcode/support/corpus.h"
#include "tests/client/gcode/support/stack.h"

namespace traverse::view {
namespace {

using ::testing::HasSubstr;

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
  // Any routes do; among many walls the best ones take minutes.
  options.mutable_layer_time_limit()->set_nanos(10'000'000);
  const auto service = EmbeddedService::Start(2);
  EXPECT_TRUE(service.ok());
  report::JobRun run;
  run.result = *OptimizerClient((*service)->channel()).Optimize(options, job.layers);
  return run;
}

class DrawnGcode : public ::testing::TestWithParam<std::string> {};

RewriteOptions Rewriting(const GcodeOptions& options) {
  RewriteOptions rewrite;
  static_cast<gcode::Liberties&>(rewrite) = options;
  rewrite.version = "1.0";
  rewrite.threads = 2;
  return rewrite;
}

// The meter that the figures come from shares no code with what draws the moves.
TEST_P(DrawnGcode, TravelsAsFarAsTheFileIsMeasuredTo) {
  GcodeOptions options;
  options.policy = gcode::Policy::kFree;
  const absl::StatusOr<InputJob> job =
      ReadGcodeJob(gcode::testing::TextOf(GetParam()), "part.gcode", options);
  ASSERT_TRUE(job.ok()) << job.status();
  const report::JobRun run = RunOf(*job, "greedy");
  gcode::FileOrder found;
  for (size_t i = 0; i < job->layers.size(); ++i) {
    found.push_back(OrderOf(*job->gcode, i, run.result.layers[i]));
  }
  const absl::StatusOr<GcodeRewrite> rewrite = RewriteGcode(*job->gcode, found, Rewriting(options));
  ASSERT_TRUE(rewrite.ok()) << rewrite.status();

  const absl::StatusOr<Scene> scene = GcodeScene(*job, "greedy", run, *rewrite);
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

// A loop of two half circles and two lines; from the line right of it the travel to its other side
// is shorter than to where it begins.
TEST(DrawnGcode, ArcsAreRound) {
  const std::string text =
      "M83\n;LAYER_CHANGE\nG1 Z.2 F600\n;TYPE:Perimeter\nG1 X30 Y14\nG1 X31 Y14 E.1\n"
      "G1 X10 Y10\nG3 X20 Y10 I5 J0 E1\nG1 X20 Y14 E.5\nG3 X10 Y14 I-5 J0 E1\nG1 X10 Y10 E.5\n"
      "G1 X60 Y12\n;TYPE:Internal infill\nG1 X40 Y12 E1\n";
  GcodeOptions options;
  options.policy = gcode::Policy::kFree;
  const absl::StatusOr<InputJob> job = ReadGcodeJob(text, "part.gcode", options);
  ASSERT_TRUE(job.ok()) << job.status();
  const std::vector<report::JobRun> runs = {RunOf(*job, "ni2opt")};
  const gcode::FileOrder found = {OrderOf(*job->gcode, 0, runs[0].result.layers[0])};
  const absl::StatusOr<GcodeRewrite> rewrite = RewriteGcode(*job->gcode, found, Rewriting(options));
  ASSERT_TRUE(rewrite.ok()) << rewrite.status();

  const absl::StatusOr<Scene> scene = GcodeScene(*job, "ni2opt", runs[0], *rewrite);
  ASSERT_TRUE(scene.ok()) << scene.status();
  const DrawnLayer layer = scene->layer(0);

  const DrawnPath& loop = layer.paths[1];
  ASSERT_TRUE(loop.closed);
  DrawnMove outline = loop.points;
  outline.push_back(loop.points.front());
  EXPECT_NEAR(LengthOf({outline}), 8 + 10 * std::numbers::pi, 0.1);
  for (const DrawnPoint& at : loop.points) {
    const double beyond = at.y < 10 ? 10 - at.y : std::max(at.y - 14, 0.0);
    EXPECT_NEAR(std::hypot(at.x - 15, beyond), 5, 0.001) << at.x << ", " << at.y;
  }
  // Routes begin it at the same corners as before it was bent.
  EXPECT_EQ(EntryOf(loop, layer.routes[0].visits[1]), (DrawnPoint{10, 10}));
  EXPECT_EQ(EntryOf(loop, layer.routes[1].visits[1]), (DrawnPoint{20, 14}));
}

// What a terminal shows line by line are sentences below a drawing.
TEST(DrawnGcode, WhatStaysIsToldInSentences) {
  const std::string text =
      "M83\n;LAYER_CHANGE\nG1 Z.2 F600\n;TYPE:Perimeter\nG1 X30 Y14\nG1 X31 Y14 E.1\n";
  const absl::StatusOr<InputJob> job = ReadGcodeJob(text, "part.gcode", {});
  ASSERT_TRUE(job.ok()) << job.status();
  const absl::StatusOr<GcodeRewrite> rewrite = RewriteGcode(*job->gcode, {}, Rewriting({}));
  ASSERT_TRUE(rewrite.ok()) << rewrite.status();
  ASSERT_EQ(rewrite->barriers.size(), 2u);

  const absl::StatusOr<Scene> scene = GcodeScene(*job, "greedy", {}, *rewrite);
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_THAT(scene->moves_note, HasSubstr("change places there. Of the rest, "));
}

// Three boxes one above the other: the travel between lines of the second one is seen by nobody.
TEST(DrawnGcode, TravelIsRetractedOpenOrHidden) {
  gcode::testing::Stack stack;
  for (const double z : {0.2, 0.4, 0.6}) stack.Layer(z).Box(0, 0, 20);
  GcodeOptions options;
  options.policy = gcode::Policy::kFast;
  const absl::StatusOr<InputJob> job = ReadGcodeJob(stack.Text(), "part.gcode", options);
  ASSERT_TRUE(job.ok()) << job.status();
  const std::vector<report::JobRun> runs = {RunOf(*job, "none")};
  RewriteOptions rewriting;
  rewriting.policy = options.policy;
  const absl::StatusOr<GcodeRewrite> rewrite = RewriteGcode(*job->gcode, {}, rewriting);
  ASSERT_TRUE(rewrite.ok()) << rewrite.status();

  const absl::StatusOr<Scene> scene = GcodeScene(*job, "fast", runs[0], *rewrite);
  ASSERT_TRUE(scene.ok()) << scene.status();

  const auto forms = [&](size_t layer, size_t route) {
    std::vector<DrawnForm> of_route;
    const DrawnLayer drawn = scene->layer(layer);
    for (const DrawnVisit& visit : drawn.routes[route].visits) {
      of_route.push_back(visit.form);
    }
    return of_route;
  };
  const std::vector<DrawnForm> retracted(4, DrawnForm::kRetracted);
  EXPECT_EQ(forms(1, 0), retracted);
  EXPECT_EQ(forms(2, 1), retracted);
  std::vector<DrawnForm> hidden(4, DrawnForm::kHidden);
  hidden[0] = DrawnForm::kRetracted;
  EXPECT_EQ(forms(1, 1), hidden);
  EXPECT_EQ(scene->routes[0].total.hidden_retractions, 3);
  EXPECT_EQ(scene->routes[0].layers[1].hidden_retractions, 3);
  EXPECT_EQ(scene->routes[1].total.hidden_retractions, 0);
}

INSTANTIATE_TEST_SUITE_P(Kept, DrawnGcode, ::testing::ValuesIn(gcode::testing::KeptFiles()),
                         [](const auto& info) { return gcode::testing::NameOf(info.param); });

}  // namespace
}  // namespace traverse::view
