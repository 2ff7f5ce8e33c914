#include "server/ops/metrics/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace traverse {
namespace {

using ::testing::HasSubstr;

// 20 mm of travel given, 3 of them to the cleaning point, and 14 found, 2 of them to it.
LayerOutcome Outcome() {
  LayerOutcome outcome;
  outcome.given.contours_mm = 17;
  outcome.cleaning_given_mm = 3;
  outcome.travel.contours_mm = 12;
  outcome.cleaning_mm = 2;
  outcome.cost = 12;
  outcome.lower_bound = 11.4;  // 5 % below
  outcome.solve_seconds = 0.003;
  return outcome;
}

TEST(Metrics, CountsTravelWithTheWaysToTheCleaningPoint) {
  Metrics metrics;
  metrics.CountLayer(metrics.ForStrategy("greedy"), Outcome(), 2);
  metrics.CountLayer(metrics.ForStrategy("greedy"), Outcome(), 2);

  const std::string text = metrics.Text({});
  EXPECT_THAT(text, HasSubstr("traverse_travel_given_mm_total 40\n"));
  EXPECT_THAT(text, HasSubstr("traverse_travel_mm_total 28\n"));
  EXPECT_THAT(text, HasSubstr("traverse_idle_seconds_saved_total 6\n"));
}

TEST(Metrics, ALayerThatCameOutLongerSavesNothing) {
  LayerOutcome outcome = Outcome();
  outcome.travel.contours_mm = 100;
  Metrics metrics;
  metrics.CountLayer(metrics.ForStrategy("greedy"), outcome, 2);

  EXPECT_THAT(metrics.Text({}), HasSubstr("traverse_idle_seconds_saved_total 0\n"));
}

TEST(Metrics, TheGapIsToldOfLayersWithABound) {
  Metrics metrics;
  metrics.CountLayer(metrics.ForStrategy("exact"), Outcome(), 2);
  LayerOutcome without = Outcome();
  without.lower_bound.reset();
  metrics.CountLayer(metrics.ForStrategy("exact"), without, 2);

  const std::string text = metrics.Text({});
  EXPECT_THAT(text, HasSubstr("traverse_optimality_gap_ratio_count 1\n"));
  EXPECT_THAT(text, HasSubstr("traverse_optimality_gap_ratio_bucket{le=\"0.02\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("traverse_optimality_gap_ratio_bucket{le=\"0.1\"} 1\n"));
}

TEST(Metrics, LayersAreCountedByHowTheyEnded) {
  Metrics metrics;
  LayerOutcome outcome = Outcome();
  outcome.stop = StopReason::kTimeLimit;
  outcome.invalid_route = "route[0]: path 3 was visited before";
  metrics.CountLayer(metrics.ForStrategy("tabu"), outcome, 2);

  const std::string text = metrics.Text({});
  EXPECT_THAT(text, HasSubstr("traverse_layers_total{stop=\"TIME_LIMIT\",strategy=\"tabu\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("traverse_invalid_routes_total 1\n"));
  EXPECT_THAT(text,
              HasSubstr("traverse_layer_solve_seconds_bucket{strategy=\"tabu\",le=\"0.005\"} 1"));
}

}  // namespace
}  // namespace traverse
