#include "engine/schedule/layer_fingerprint.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/schedule/end_history.h"
#include "tests/engine/schedule/ring_job.h"

namespace traverse {
namespace {

using testing::Moved;
using testing::RingLayer;

// Two lines and a contour, in any order but for one pair.
Plan SmallPlan() {
  Plan plan;
  plan.paths = {MakeOpenPath({1, 1}, {5, 1}), MakeOpenPath({1, 3}, {5, 3}),
                MakeContour({{0, 0}, {9, 0}, {9, 9}})};
  PlanNode root;
  root.kind = PlanNode::Kind::kAnyOrder;
  root.children = {1, 2, 3};
  plan.nodes = {root};
  for (int p = 0; p < 3; ++p) {
    PlanNode leaf;
    leaf.path = p;
    plan.nodes.push_back(leaf);
  }
  return plan;
}

TEST(FingerprintOf, ShiftedPlansAreOfOneShapeAndNotInOnePlace) {
  const Plan plan = SmallPlan();
  Plan moved = plan;
  for (Path& path : moved.paths) {
    for (Point& point : path.points) point = {point.x + 20, point.y - 3};
  }

  EXPECT_EQ(FingerprintOf(moved, {}).shape, FingerprintOf(plan, {}).shape);
  EXPECT_NE(FingerprintOf(moved, {}).exact, FingerprintOf(plan, {}).exact);
  EXPECT_EQ(FingerprintOf(plan, {}).exact, FingerprintOf(SmallPlan(), {}).exact);
}

TEST(FingerprintOf, WhateverChangesTheProblemChangesTheShape) {
  const std::vector<std::pair<std::string, std::function<void(Plan&, CostSpec&)>>> changes = {
      {"one way", [](Plan& plan, CostSpec&) { plan.paths[0].one_way = true; }},
      {"kind of path", [](Plan& plan, CostSpec&) { plan.paths[2].kind = Path::Kind::kOpen; }},
      {"point", [](Plan& plan, CostSpec&) { plan.paths[1].points[1].y += 0.001; }},
      {"allowed entries", [](Plan& plan, CostSpec&) { plan.paths[2].allowed = {1}; }},
      {"order of children",
       [](Plan& plan, CostSpec&) {
         std::swap(plan.nodes[0].children[0], plan.nodes[0].children[1]);
       }},
      {"path of a node",
       [](Plan& plan, CostSpec&) { std::swap(plan.nodes[1].path, plan.nodes[2].path); }},
      {"kind of node",
       [](Plan& plan, CostSpec&) { plan.nodes[0].kind = PlanNode::Kind::kInOrder; }},
      {"pair",
       [](Plan& plan, CostSpec&) {
         plan.nodes[0].before = {{0, 1}};
       }},
      {"kind of cost", [](Plan&, CostSpec& cost) { cost.kind = CostSpec::Kind::kTime; }},
      {"speed", [](Plan&, CostSpec& cost) { cost.speed_mm_s += 1; }},
      {"acceleration", [](Plan&, CostSpec& cost) { cost.accel_mm_s2 += 1; }},
      {"retraction", [](Plan&, CostSpec& cost) { cost.retraction_seconds += 1; }},
      {"threshold", [](Plan&, CostSpec& cost) { cost.retraction_threshold_mm += 1; }},
  };
  for (const auto& [what, change] : changes) {
    Plan plan = SmallPlan();
    CostSpec cost;
    change(plan, cost);

    EXPECT_NE(FingerprintOf(plan, cost).shape, FingerprintOf(SmallPlan(), {}).shape) << what;
  }
}

TEST(FingerprintOf, PlansWithoutPathsBeginAtTheOrigin) {
  Plan empty;
  empty.nodes.emplace_back().kind = PlanNode::Kind::kAnyOrder;

  EXPECT_EQ(PlanOrigin(empty), (Point{0, 0}));
  EXPECT_EQ(FingerprintOf(empty, {}).shape, FingerprintOf(empty, {}).shape);
  EXPECT_NE(FingerprintOf(empty, {}).shape, FingerprintOf(SmallPlan(), {}).shape);
}

TEST(ProblemKey, DependsOnStartAndFinishFromTheOrigin) {
  const uint64_t key = ProblemKey(1, {0, 0}, {5, 5}, std::nullopt);

  EXPECT_EQ(ProblemKey(1, {10, 0}, {15, 5}, std::nullopt), key);
  EXPECT_NE(ProblemKey(2, {0, 0}, {5, 5}, std::nullopt), key);
  EXPECT_NE(ProblemKey(1, {0, 0}, {5, 6}, std::nullopt), key);
  EXPECT_NE(ProblemKey(1, {0, 0}, {5, 5}, Point{0, 0}), key);
  EXPECT_EQ(ProblemKey(1, {0, 0}, {5, 5}, Point{3, 4}), ProblemKey(1, {1, 2}, {6, 7}, Point{4, 6}));
  EXPECT_NE(ProblemKey(1, {0, 0}, {5, 5}, Point{0, 0}), ProblemKey(1, {0, 0}, {5, 5}, Point{0, 1}));
}

TEST(EndHistory, PrefersTheProblemToTheShapeAndTheLastToTheFirst) {
  EndHistory history;
  EXPECT_FALSE(history.EndOf(1, 10));

  history.Learn(1, 10, {1, 1});
  history.Learn(1, 11, {2, 2});

  EXPECT_EQ(history.EndOf(1, 10), (Point{1, 1}));
  EXPECT_EQ(history.EndOf(1, 11), (Point{2, 2}));
  EXPECT_EQ(history.EndOf(1, 12), (Point{2, 2}));
  EXPECT_FALSE(history.EndOf(2, 12));
}

TEST(EndHistory, GivesTheLastEndOfAnEqualLayerAboveAllFromTheSameStart) {
  const auto make = [](const Plan& plan) { return FingerprintOf(plan, {}).shape; };
  const uint64_t ring = make(RingLayer(3, 0.1));
  const uint64_t other = make(RingLayer(3, 0.2));
  EndHistory history;
  history.Learn(ring, 11, {1, 1});
  history.Learn(other, 12, {2, 2});
  history.Learn(ring, 13, {3, 3});

  EXPECT_EQ(history.EndOf(ring, 11), (Point{1, 1}));
  EXPECT_EQ(history.EndOf(ring, 14), (Point{3, 3}));
  EXPECT_EQ(history.EndOf(make(RingLayer(4, 0.1)), 14), std::nullopt);
  EXPECT_EQ(history.EndOf(make(Moved(RingLayer(3, 0.2), 5)), 14), (Point{2, 2}));
}

TEST(LayerFingerprint, TellsLayersThatWereMovedFromOthers) {
  const LayerFingerprint ring = FingerprintOf(RingLayer(3, 0.1), {});
  const LayerFingerprint moved = FingerprintOf(Moved(RingLayer(3, 0.1), 5), {});

  EXPECT_EQ(FingerprintOf(RingLayer(3, 0.1), {}).exact, ring.exact);
  EXPECT_EQ(moved.shape, ring.shape);
  CostSpec time;
  time.kind = CostSpec::Kind::kTime;
  EXPECT_NE(FingerprintOf(RingLayer(3, 0.1), time).shape, ring.shape);
  EXPECT_NE(moved.exact, ring.exact);
  EXPECT_EQ(ProblemKey(7, {0, 0}, {1, 2}, std::nullopt),
            ProblemKey(7, {5, 5}, {6, 7}, std::nullopt));
  EXPECT_NE(ProblemKey(7, {0, 0}, {1, 2}, std::nullopt),
            ProblemKey(7, {0, 0}, {1, 2.1}, std::nullopt));
  EXPECT_NE(ProblemKey(7, {0, 0}, {1, 2}, Point{0, 0}),
            ProblemKey(7, {0, 0}, {1, 2}, std::nullopt));
}

TEST(LayerFingerprint, TellsLayersApartByWhatIsSaidOfTheirMoves) {
  const Plan plan = RingLayer(3, 0.1);
  const auto shape = [&plan](const LayerWalls& walls) {
    return FingerprintOf(plan, {}, walls).shape;
  };
  const KnownMove known{0, 1, 2};
  const std::vector<LayerWalls> different = {
      {},
      {{}, {1}},
      {{}, {}, {1}},
      {{}, {1}, {1}},
      {{}, {1, 1}},
      {{}, {}, {}, {known}},
      {{}, {}, {}, {{1, 0, 2}}},
      {{}, {}, {}, {{0, 1, 3}}},
      {{}, {}, {}, {{0, 1, 2, true}}},
      {{}, {}, {}, {{0, 1, 2, false, true}}},
      {{}, {}, {}, {known, known}},
      {{{{{0, 0}, {9, 0}, {9, 9}}, false}}},
      {{{{{0, 0}, {9, 0}, {9, 9}}, true}}},
      {{{{{0, 0}, {9, 0}, {9, 8}}, true}}},
      {{{{{0, 0}, {9, 0}}, true}}},
  };
  for (size_t i = 0; i < different.size(); ++i) {
    for (size_t j = 0; j < i; ++j) EXPECT_NE(shape(different[i]), shape(different[j])) << i << j;
    EXPECT_EQ(shape(different[i]), shape(LayerWalls(different[i])));
  }
}

}  // namespace
}  // namespace traverse
