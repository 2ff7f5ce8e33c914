#include "client/gcode/plan/loop_starts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace traverse::gcode {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<Point> Circle(size_t vertices) {
  std::vector<Point> loop;
  for (size_t k = 0; k < vertices; ++k) {
    const double turn =
        2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(vertices);
    loop.push_back({10 * std::cos(turn), 10 * std::sin(turn)});
  }
  return loop;
}

std::vector<uint32_t> All(size_t vertices) {
  std::vector<uint32_t> starts;
  for (uint32_t k = 0; k < vertices; ++k) starts.push_back(k);
  return starts;
}

TEST(LoopStarts, AFewStayAsTheyAre) {
  EXPECT_THAT(ThinnedStarts(Circle(kMostStarts), {}), IsEmpty());
  EXPECT_THAT(ThinnedStarts(Circle(5000), {0, 7, 4000}), ElementsAre(0, 7, 4000));
}

TEST(LoopStarts, ManyAreThinnedEvenlyAlongTheLoop) {
  for (const size_t vertices : {kMostStarts + 1, size_t{1000}, size_t{20'000}}) {
    const std::vector<Point> loop = Circle(vertices);
    const std::vector<uint32_t> kept = ThinnedStarts(loop, {});
    EXPECT_EQ(kept.front(), 0);
    EXPECT_LE(kept.size(), kMostStarts + 1);
    EXPECT_GE(kept.size(), kMostStarts / 2);
    const size_t most = vertices / kMostStarts + 1;
    for (size_t k = 0; k < kept.size(); ++k) {
      const size_t next = k + 1 < kept.size() ? kept[k + 1] : vertices;
      EXPECT_LE(next - kept[k], 2 * most) << vertices << " vertices, start " << k;
    }
    EXPECT_EQ(ThinnedStarts(loop, All(vertices)), kept);
  }
}

// What counts is the length between them, not their number.
TEST(LoopStarts, LongSidesKeepTheirEnds) {
  std::vector<Point> loop = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  for (int k = 1; k < 1000; ++k) loop.push_back({0, 100 - 0.001 * k});
  EXPECT_THAT(ThinnedStarts(loop, {}), ElementsAre(0, 1, 2, 3));
}

TEST(LoopStarts, OneOfManyAtOnePointStays) {
  const std::vector<Point> loop(1000, Point{3, 4});
  EXPECT_THAT(ThinnedStarts(loop, {}), SizeIs(1));
}

}  // namespace
}  // namespace traverse::gcode
