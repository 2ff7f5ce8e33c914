#include "client/gtsp/tour.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace traverse::gtsp {
namespace {

using ::testing::ElementsAre;

int64_t LengthOf(const Instance& instance, const std::vector<uint32_t>& points) {
  int64_t sum = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    sum += RoundedDistance(instance.points[points[i]],
                           instance.points[points[(i + 1) % points.size()]]);
  }
  return sum;
}

// The answer that visits the sets of `order`, none of them the first one, and returns.
v1::LayerResult Answer(const Instance& instance, const std::vector<uint32_t>& order,
                       double travel_mm) {
  v1::LayerResult result;
  result.mutable_travel()->set_total_mm(travel_mm);
  for (const uint32_t set : order) {
    result.add_visits()->set_plan_path(set < instance.first_set ? set : set - 1);
  }
  result.add_visits()->set_plan_path(static_cast<uint32_t>(instance.sets.size()) - 1);
  return result;
}

TEST(RoundedDistance, RoundsHalvesUp) {
  EXPECT_EQ(RoundedDistance({0, 0}, {3, 4}), 5);
  EXPECT_EQ(RoundedDistance({0, 0}, {1.49, 0}), 1);
  EXPECT_EQ(RoundedDistance({0, 0}, {0, -1.5}), 2);
}

TEST(BestTour, ChoosesThePointsForRoundedDistancesOfTheShortestLayer) {
  std::mt19937 random(7);
  for (int round = 0; round < 50; ++round) {
    Instance instance;
    instance.sets = {{0, 1, 2}, {3, 4}, {5, 6, 7}, {8, 9, 10}};
    instance.first_set = 1;
    for (int i = 0; i < 11; ++i) {
      const auto draw = [&] { return static_cast<double>(random() % 100) / 10; };
      instance.points.push_back({draw(), draw()});
    }
    const std::vector<v1::LayerResult> layers = {Answer(instance, {0, 2, 3}, 9),
                                                 Answer(instance, {3, 0, 2}, 8)};

    const Tour tour = BestTour(instance, layers);

    int64_t least = std::numeric_limits<int64_t>::max();
    for (const uint32_t a : instance.sets[1]) {
      for (const uint32_t b : instance.sets[3]) {
        for (const uint32_t c : instance.sets[0]) {
          for (const uint32_t d : instance.sets[2]) {
            least = std::min(least, LengthOf(instance, {a, b, c, d}));
          }
        }
      }
    }
    EXPECT_EQ(tour.rounded_length, least);
    ASSERT_EQ(tour.points.size(), 4u);
    EXPECT_EQ(LengthOf(instance, tour.points), least);
    EXPECT_LE(3u, tour.points[0]);
    EXPECT_LE(8u, tour.points[1]);
  }
}

TEST(BestTour, OfOneSetIsOnePoint) {
  Instance instance;
  instance.points = {{1, 2}};
  instance.sets = {{0}};

  const Tour tour = BestTour(instance, {Answer(instance, {}, 0)});

  EXPECT_EQ(tour.rounded_length, 0);
  EXPECT_THAT(tour.points, ElementsAre(0));
}

}  // namespace
}  // namespace traverse::gtsp
