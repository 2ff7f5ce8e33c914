#include "server/translate/translate.h"

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "absl/strings/str_cat.h"
#include "tests/support/status_matchers.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;
using testing::StatusIs;

template <typename Message>
Message Parse(const std::string& text) {
  Message message;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &message)) << text;
  return message;
}

// A message in text format and the beginning of the status that it has to be refused with.
struct BadCase {
  const char* text;
  const char* error;
  absl::StatusCode code = absl::StatusCode::kInvalidArgument;
};

TEST(TranslateOptions, EmptyOptionsAreTheDefaults) {
  ASSERT_OK_AND_ASSIGN(const JobSetup setup, JobFromProto({}));

  EXPECT_EQ(setup.job_id, "");
  EXPECT_NE(setup.strategy, nullptr);
  EXPECT_EQ(setup.spec.start, (Point{0, 0}));
  EXPECT_FALSE(setup.spec.cleaning.has_value());
  EXPECT_EQ(setup.spec.cost, CostSpec());
  EXPECT_EQ(setup.spec.seed, 1u);
  EXPECT_EQ(setup.spec.layer_time_limit, absl::InfiniteDuration());
  EXPECT_EQ(setup.time_limit, absl::InfiniteDuration());
  EXPECT_FALSE(setup.interleaved);
  EXPECT_FALSE(setup.build_order);
  EXPECT_DOUBLE_EQ(setup.idle_speed_mm_s, 20.32);
}

TEST(TranslateOptions, EveryFieldArrives) {
  ASSERT_OK_AND_ASSIGN(const JobSetup setup, JobFromProto(Parse<v1::JobOptions>(R"(
    job_id: "a" strategy { name: "none" } deposition: DEPOSITION_INTERLEAVED
    start { x_mm: 1 y_mm: 2 }
    cleaning { point { x_mm: 3 y_mm: 4 } every_layers: 5 layers_since_cleaning: 4 }
    cost { time { speed_mm_s: 150 accel_mm_s2: 1000 retraction_seconds: 0.1
                  retraction_threshold_mm: 2 } }
    idle_speed_mm_s: 30 seed: 0 time_limit { seconds: 1 nanos: 500000000 }
    layer_time_limit { nanos: 1000000 } result_order: RESULT_ORDER_BUILD)")));

  EXPECT_EQ(setup.job_id, "a");
  EXPECT_EQ(setup.strategy_name, "none");
  EXPECT_TRUE(setup.interleaved);
  EXPECT_EQ(setup.spec.start, (Point{1, 2}));
  EXPECT_EQ(setup.spec.cleaning->point, (Point{3, 4}));
  EXPECT_EQ(setup.spec.cleaning->every_layers, 5);
  EXPECT_EQ(setup.spec.cleaning->layers_since_cleaning, 4);
  EXPECT_EQ(setup.spec.cost, (CostSpec{CostSpec::Kind::kTime, 150, 1000, 0.1, 2}));
  EXPECT_DOUBLE_EQ(setup.idle_speed_mm_s, 30);
  EXPECT_EQ(setup.spec.seed, 0u);
  EXPECT_EQ(setup.time_limit, absl::Milliseconds(1500));
  EXPECT_EQ(setup.spec.layer_time_limit, absl::Milliseconds(1));
  EXPECT_TRUE(setup.build_order);
}

TEST(TranslateOptions, FaultsAreNamedByTheirPlace) {
  const BadCase cases[] = {
      {"strategy { name: \"best\" }", "options.strategy.name: no strategy \"best\""},
      {"strategy { name: \"none\" options { key: \"x\" value: \"1\" } }",
       "options.strategy.options[\"x\"]: "},
      {"deposition: 7", "options.deposition: 7 "},
      {"result_order: 9", "options.result_order: 9 "},
      {"start { x_mm: nan }", "options.start.x_mm: not finite"},
      {"start { y_mm: 1e300 }", "options.start.y_mm: 1e+300 is not from -1000000 to 1000000"},
      {"start { y_mm: -inf }", "options.start.y_mm: not finite"},
      {"cleaning { every_layers: 1 }", "options.cleaning.point: missing"},
      {"cleaning { point {} }", "options.cleaning.every_layers: 0 is not from 1 to 2147483647"},
      {"cleaning { point {} every_layers: 4294967295 }", "options.cleaning.every_layers: "},
      {"cleaning { point { x_mm: inf } every_layers: 1 }",
       "options.cleaning.point.x_mm: not finite"},
      {"cleaning { point {} every_layers: 3 layers_since_cleaning: 3 }",
       "options.cleaning.layers_since_cleaning: 3 is not less than every_layers, 3"},
      {"cost { time {} }", "options.cost.time.speed_mm_s: 0 is not from 0.001 to 100000"},
      {"cost { time { speed_mm_s: -1 } }",
       "options.cost.time.speed_mm_s: -1 is not from 0.001 to 100000"},
      {"cost { time { speed_mm_s: nan } }", "options.cost.time.speed_mm_s: not finite"},
      {"cost { time { speed_mm_s: 1e300 } }", "options.cost.time.speed_mm_s: 1e+300 is not from"},
      {"cost { time { speed_mm_s: 1 accel_mm_s2: inf } }",
       "options.cost.time.accel_mm_s2: not finite"},
      {"cost { time { speed_mm_s: 1 retraction_seconds: -0.5 } }",
       "options.cost.time.retraction_seconds: -0.5 is not from 0 to 10000"},
      {"cost { time { speed_mm_s: 1 retraction_threshold_mm: nan } }",
       "options.cost.time.retraction_threshold_mm: not finite"},
      {"idle_speed_mm_s: 0", "options.idle_speed_mm_s: 0 is not from 0.001 to 100000"},
      {"idle_speed_mm_s: nan", "options.idle_speed_mm_s: not finite"},
      {"idle_speed_mm_s: 1e6", "options.idle_speed_mm_s: 1e+06"},
      {"time_limit {}", "options.time_limit: 0 is not from 1e-09 to 315576000000"},
      {"time_limit { seconds: -1 }", "options.time_limit: -1 is not from 1e-09"},
      {"time_limit { seconds: 1 nanos: -1 }", "options.time_limit: not a valid duration"},
      {"time_limit { nanos: 2000000000 }", "options.time_limit: not a valid duration"},
      {"time_limit { seconds: 9000000000000000000 }", "options.time_limit: not a valid duration"},
      {"time_limit { seconds: 315576000000 nanos: 1 }", "options.time_limit: not a valid duration"},
      {"layer_time_limit { nanos: -5 }", "options.layer_time_limit: "},
  };
  for (const BadCase& bad : cases) {
    EXPECT_THAT(JobFromProto(Parse<v1::JobOptions>(bad.text)),
                StatusIs(bad.code, StartsWith(bad.error)))
        << bad.text;
  }
}

TEST(TranslateOptions, JobIdIsBounded) {
  v1::JobOptions options;
  options.set_job_id(std::string(256, 'x'));
  EXPECT_OK(JobFromProto(options));

  options.set_job_id(std::string(257, 'x'));
  EXPECT_THAT(JobFromProto(options), StatusIs(absl::StatusCode::kInvalidArgument,
                                              StartsWith("options.job_id: 257 bytes")));
}

TEST(TranslateOptions, FieldsOfLaterVersionsAreRefused) {
  v1::JobOptions options;
  options.GetReflection()->MutableUnknownFields(&options)->AddVarint(99, 1);

  EXPECT_THAT(JobFromProto(options),
              StatusIs(absl::StatusCode::kUnimplemented, StartsWith("options: field number 99 ")));
}

TEST(TranslateLayer, IslandsBecomeAPlanThatKnowsThem) {
  ASSERT_OK_AND_ASSIGN(const LabelledLayer result, LayerFromProto(Parse<v1::Layer>(R"(
    id: 12 z_mm: 0.3 start { x_mm: 7 }
    cost { time { speed_mm_s: 10 } }
    islands { contours { points: [1, 2, 3, 4] entries: [1] }
              rasters { points: [5, 6, 0, 0, 7, 8] one_way: true } }
    islands { contours { points: [9, 9] } })"),
                                                                  0, false));

  EXPECT_EQ(result.label.id, 12u);
  EXPECT_EQ(result.label.points, 6);
  EXPECT_EQ(*result.layer.start, (Point{7, 0}));
  EXPECT_DOUBLE_EQ(result.layer.cost->speed_mm_s, 10);
  const Plan& plan = result.layer.plan;
  EXPECT_OK(CheckPlan(plan));
  ASSERT_EQ(plan.paths.size(), 3u);
  EXPECT_THAT(plan.paths[0].points, ElementsAre(Point{1, 2}, Point{3, 4}));
  EXPECT_THAT(plan.paths[0].allowed, ElementsAre(1));
  EXPECT_THAT(plan.paths[1].points, ElementsAre(Point{5, 6}, Point{7, 8}));
  EXPECT_TRUE(plan.paths[1].one_way);
  EXPECT_EQ(plan.paths[0].island, 0);
  EXPECT_EQ(plan.paths[1].island, 0);
  EXPECT_EQ(plan.paths[2].island, 1);
}

TEST(TranslateLayer, DepositionShapesThePlan) {
  const auto layer = Parse<v1::Layer>(R"(
    islands { contours { points: [0, 0] } rasters { points: [1, 1, 2, 2] } }
    islands { contours { points: [5, 5] } })");

  ASSERT_OK_AND_ASSIGN(const LabelledLayer sequential, LayerFromProto(layer, 0, false));
  ASSERT_OK_AND_ASSIGN(const LabelledLayer interleaved, LayerFromProto(layer, 0, true));

  EXPECT_EQ(sequential.layer.plan.nodes[0].kind, PlanNode::Kind::kInOrder);
  EXPECT_EQ(interleaved.layer.plan.nodes[0].kind, PlanNode::Kind::kAnyOrder);
}

TEST(TranslateLayer, FaultsAreNamedByTheirPlace) {
  // clang-format off
  const BadCase cases[] = {
      {"z_mm: nan", "layers[3].z_mm: not finite"},
      {"islands {} plan {}", "layers[3]: has both islands and a plan"},
      {"islands { contours { points: [1, 2, 3] } }",
       "layers[3].islands[0].contours[0].points: 3 coordinates"},
      {"islands { contours {} }",
       "layers[3].islands[0].contours[0].points: a contour needs at least one point"},
      {"islands {} islands { contours { points: [1, 2] } contours { points: [0, 0, 0, inf] } }",
       "layers[3].islands[1].contours[1].points[1].y: not finite"},
      {"islands { contours { points: [1e300, 0] } }",
       "layers[3].islands[0].contours[0].points[0].x: "},
      {"islands { contours { points: [1, 2] entries: [1] } }",
       "layers[3].islands[0].contours[0].entries[0]: 1 is not a vertex of a contour of 1"},
      {"islands { contours { points: [1, 2] entries: [4294967295] } }",
       "layers[3].islands[0].contours[0].entries[0]: 4294967295 is not a vertex"},
      {"islands { contours { points: [1, 2] entries: [0, 0] } }",
       "layers[3].islands[0].contours[0].entries[1]: 0 is repeated"},
      {"islands { rasters { points: [1, 2] } }",
       "layers[3].islands[0].rasters[0].points: an open path needs at least two points, not 1"},
      {"islands { rasters { points: [1, 2, nan, 0, 3, 4] } }",
       "layers[3].islands[0].rasters[0].points[1].x: not finite"},
      {"start { y_mm: nan }", "layers[3].start.y_mm: not finite"},
      {"cost { time { speed_mm_s: 0 } }", "layers[3].cost.time.speed_mm_s: 0 is not from 0.001 to 100000"},
      {"plan { paths {} }", "layers[3].plan.paths[0]: set contour or open_path"},
      {"plan { nodes {} }", "layers[3].plan.nodes[0]: set one of path, in_order and any_order"},
      {"plan { paths { contour { points: [1, 1] } } }", "layers[3].plan.nodes: empty"},
      {"plan { nodes { path: 0 } }", "layers[3].plan.nodes[0].path: 0 is not the index of a path"},
      {"plan { nodes { path: 4294967295 } }",
       "layers[3].plan.nodes[0].path: 4294967295 is too large"},
      {"plan { nodes { in_order { children: [0] } } }", "layers[3].plan.nodes[0].in_order.children[0]: "},
      {"plan { nodes { in_order { children: [3000000000] } } }",
       "layers[3].plan.nodes[0].in_order.children[0]: 3000000000 is too large"},
      {"plan { nodes { any_order { children: [1] before { first: 0 second: 4 } } } nodes { in_order {} } }",
       "layers[3].plan.nodes[0].any_order.before[0].second: 4 is not the position"},
      {"plan { nodes { any_order { children: [1, 2] before { second: 1 } before { first: 1 } } }"
       " nodes { in_order {} } nodes { in_order {} } }",
       "layers[3].plan.nodes[0].any_order.before: the pairs form a cycle"},
      {"plan { nodes { any_order { before { first: 4294967295 } } } }",
       "layers[3].plan.nodes[0].any_order.before[0].first: 4294967295 is too large"},
      {"plan { paths { open_path { points: [0, 0, 1, 1, nan, 2] } } nodes { path: 0 } }",
       "layers[3].plan.paths[0].points[2].x: not finite"},
  };
  // clang-format on
  for (const BadCase& bad : cases) {
    EXPECT_THAT(LayerFromProto(Parse<v1::Layer>(bad.text), 3, false),
                StatusIs(bad.code, StartsWith(bad.error)))
        << bad.text;
  }
}

TEST(TranslateLayer, DeepPlansAreRefusedWithTheNode) {
  v1::Layer layer;
  for (uint32_t i = 0; i < 10'000; ++i) {
    layer.mutable_plan()->add_nodes()->mutable_in_order()->add_children(i + 1);
  }
  layer.mutable_plan()->add_nodes()->set_path(0);
  for (const double c : {1.0, 1.0}) {
    if (layer.plan().paths().empty()) layer.mutable_plan()->add_paths();
    layer.mutable_plan()->mutable_paths(0)->mutable_contour()->add_points(c);
  }

  EXPECT_THAT(LayerFromProto(layer, 0, false),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       StartsWith("layers[0].plan.nodes[99].in_order.children[0]: nested deeper")));
}

TEST(TranslateLayer, FieldsOfLaterVersionsAreRefusedWhereverTheyAre) {
  v1::Layer layer = Parse<v1::Layer>("islands {} islands { contours { points: [1, 1] } }");
  v1::Contour& contour = *layer.mutable_islands(1)->mutable_contours(0);
  contour.GetReflection()->MutableUnknownFields(&contour)->AddVarint(77, 1);

  EXPECT_THAT(LayerFromProto(layer, 3, false),
              StatusIs(absl::StatusCode::kUnimplemented,
                       StartsWith("layers[3].islands[1].contours[0]: field number 77 ")));
}

TEST(TranslateLayer, WallsArriveAndMayBeContours) {
  ASSERT_OK_AND_ASSIGN(const LabelledLayer result, LayerFromProto(Parse<v1::Layer>(R"(
    islands { contours { points: [0, 0, 5, 0, 5, 5] } rasters { points: [1, 1, 2, 2] } }
    walls { points: [7, 8, 9, 10, 11, 12] closed: true } walls { path: 0 }
    walls { points: [1, 1, 2, 2] path: 1 } exposed_paths: [1])"),
                                                                  0, false));

  const LayerWalls& walls = result.layer.walls;
  ASSERT_EQ(walls.walls.size(), 3u);
  EXPECT_THAT(walls.walls[0].points, ElementsAre(Point{7, 8}, Point{9, 10}, Point{11, 12}));
  EXPECT_TRUE(walls.walls[0].closed);
  EXPECT_EQ(walls.walls[0].path, -1);
  EXPECT_THAT(walls.walls[1].points, ElementsAre(Point{0, 0}, Point{5, 0}, Point{5, 5}));
  EXPECT_TRUE(walls.walls[1].closed);
  EXPECT_EQ(walls.walls[1].path, 0);
  EXPECT_FALSE(walls.walls[2].closed);
  EXPECT_THAT(walls.exposed, ElementsAre(1));
  EXPECT_EQ(result.label.points, 10);
}

TEST(TranslateLayer, MovesThatAreKnownArrive) {
  ASSERT_OK_AND_ASSIGN(const LabelledLayer result, LayerFromProto(Parse<v1::Layer>(R"(
    islands { contours { points: [0, 0, 5, 0, 5, 5] } rasters { points: [1, 1, 2, 2] } }
    retracted_paths: [1, 0, 1]
    known_moves { from: 1 seconds: 2.5 crosses: true } known_moves { to: 1 retracts: true })"),
                                                                  0, false));

  const LayerWalls& walls = result.layer.walls;
  EXPECT_THAT(walls.retracted, ElementsAre(0, 1));
  ASSERT_EQ(walls.known.size(), 2u);
  EXPECT_EQ(walls.known[0].from, 1);
  EXPECT_EQ(walls.known[0].to, 0);
  EXPECT_EQ(walls.known[0].seconds, 2.5);
  EXPECT_TRUE(walls.known[0].crosses);
  EXPECT_FALSE(walls.known[0].retracts);
  EXPECT_EQ(walls.known[1].to, 1);
  EXPECT_TRUE(walls.known[1].retracts);
}

// Four bytes for a copy of a contour of any size: a stranger would send a million of them.
TEST(TranslateLayer, WallsNameEachContourAboutOnce) {
  v1::Layer layer;
  v1::Contour& contour = *layer.add_islands()->add_contours();
  for (int i = 0; i < 1000; ++i) {
    contour.add_points(i);
    contour.add_points(i % 2);
  }
  layer.add_walls()->set_path(0);
  ASSERT_OK(LayerFromProto(layer, 0, false));

  layer.add_walls()->set_path(0);
  EXPECT_THAT(LayerFromProto(layer, 0, false),
              StatusIs(absl::StatusCode::kInvalidArgument, StartsWith("layers[0].walls[1].path")));
}

TEST(TranslateLayer, PathsThatAreExposedAreSoOnce) {
  v1::Layer layer = Parse<v1::Layer>("islands { contours { points: [0, 0, 5, 0, 5, 5] } }");
  for (int i = 0; i < 1000; ++i) layer.add_exposed_paths(0);

  ASSERT_OK_AND_ASSIGN(const LabelledLayer result, LayerFromProto(layer, 0, false));

  EXPECT_THAT(result.layer.walls.exposed, ElementsAre(0));
}

TEST(TranslateLayer, FaultsOfWallsAreNamedByTheirPlace) {
  const BadCase cases[] = {
      {"walls { points: [1, 2] }", "layers[3].walls[0].points: a wall needs at least two points"},
      {"walls { }", "layers[3].walls[0].points: a wall needs at least two points, not 0"},
      {"walls { points: [1, 2, 3] }", "layers[3].walls[0].points: 3 coordinates"},
      {"walls { points: [1, 2, nan, 4] }", "layers[3].walls[0].points[1].x: not finite"},
      {"walls { points: [1, 2, 3, 1e7] }", "layers[3].walls[0].points[1].y: 1e+07 is not from"},
      {"walls { path: 2 }", "layers[3].walls[0].path: there is no path 2"},
      {"walls { path: 4000000000 }", "layers[3].walls[0].path: 4"},
      {"walls { path: 1 }", "layers[3].walls[0].points: none, and the named path is not a contour"},
      {"exposed_paths: [0, 2]", "layers[3].exposed_paths[1]: there is no path 2"},
      {"retracted_paths: [2]", "layers[3].retracted_paths[0]: there is no path 2"},
      {"retracted_paths: [4000000000]", "layers[3].retracted_paths[0]: 4"},
      {"known_moves { from: 2 }", "layers[3].known_moves[0].from: there is no path 2"},
      {"known_moves { to: 2 }", "layers[3].known_moves[0].to: there is no path 2"},
      {"known_moves { to: 4000000000 }", "layers[3].known_moves[0].to: 4"},
      {"known_moves { seconds: -1 }", "layers[3].known_moves[0].seconds: -1 is not from 0 to 1"},
      {"known_moves { seconds: nan }", "layers[3].known_moves[0].seconds: not finite"},
      {"known_moves {} known_moves {} known_moves {}",
       "layers[3].known_moves: 3 are more than the plan has paths"},
  };
  for (const BadCase& bad : cases) {
    const std::string layer = absl::StrCat(
        "plan { paths { contour { points: [0, 0] } } paths { open_path { points: [0, 0, 1, 1] } }"
        " nodes { any_order { children: [1, 2] } } nodes { path: 0 } nodes { path: 1 } } ",
        bad.text);
    EXPECT_THAT(LayerFromProto(Parse<v1::Layer>(layer), 3, false),
                StatusIs(bad.code, StartsWith(bad.error)))
        << bad.text;
  }
}

TEST(TranslateOptions, PricesOfWallsArriveAndAreBounded) {
  const auto with = [](const std::string& fields) {
    return JobFromProto(Parse<v1::JobOptions>("cost { time { speed_mm_s: 100 " + fields + " } }"));
  };
  ASSERT_OK_AND_ASSIGN(const JobSetup none, with(""));
  EXPECT_EQ(none.spec.cost.wall_slack_mm, 0.25);
  ASSERT_OK_AND_ASSIGN(const JobSetup setup,
                       with("wall_retraction_threshold_mm: 1 exposed_retraction_threshold_mm: 5 "
                            "lift_seconds: 2 crossing_seconds: 3 "
                            "wall_slack_mm: 0 wall_clearance_mm: 4"));
  EXPECT_EQ(setup.spec.cost.wall_retraction_threshold_mm, 1);
  EXPECT_EQ(setup.spec.cost.exposed_retraction_threshold_mm, 5);
  EXPECT_EQ(setup.spec.cost.lift_seconds, 2);
  EXPECT_EQ(setup.spec.cost.crossing_seconds, 3);
  EXPECT_EQ(setup.spec.cost.wall_slack_mm, 0);
  EXPECT_EQ(setup.spec.cost.wall_clearance_mm, 4);
  for (const char* bad :
       {"wall_retraction_threshold_mm: -1", "lift_seconds: 1e5", "crossing_seconds: 1e9",
        "crossing_seconds: nan", "wall_slack_mm: -0.1", "wall_clearance_mm: 1001"}) {
    const std::string field(bad, std::string(bad).find(':'));
    EXPECT_THAT(with(bad), StatusIs(absl::StatusCode::kInvalidArgument,
                                    StartsWith("options.cost.time." + field + ": ")));
  }
}

TEST(CountPoints, CountsPathsOfIslandsAndPlans) {
  EXPECT_EQ(CountPoints(Parse<v1::Layer>(R"(islands { contours { points: [1, 2, 3, 4] }
                                                      rasters { points: [1, 2, 3, 4] } })")),
            4);
  EXPECT_EQ(CountPoints(Parse<v1::Layer>(R"(plan { paths { contour { points: [1, 2] } }
                                                   paths { open_path { points: [1, 2] } } })")),
            2);
}

}  // namespace
}  // namespace traverse
