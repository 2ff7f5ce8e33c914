#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdint>

#include "absl/strings/match.h"
#include "engine/validator.h"
#include "tests/support/problems/instances.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

// Three points in a row at 0, 1 and 2 mm, and a wall between the last two.
class ValidateMovesTest : public ::testing::Test {
 protected:
  ValidateMovesTest() {
    spec_.kind = CostSpec::Kind::kTime;
    spec_.speed_mm_s = 1;
    spec_.retraction_seconds = 10;
    spec_.retraction_threshold_mm = 100;
    spec_.crossing_seconds = 5;
    walls_.walls = {{{{1.5, -9}, {1.5, 9}}, false, -1}};
  }

  absl::Status Validate(const MoveClaims& claims) {
    return ValidateMoves(FlatPlan(3), walls_, spec_, {0, 0}, {{0, 0}, {1, 0}, {2, 0}}, claims);
  }

  CostSpec spec_;
  LayerWalls walls_;
};

TEST_F(ValidateMovesTest, AcceptsWhatIsTrue) { EXPECT_OK(Validate({17, {1, 1}, {}})); }

TEST_F(ValidateMovesTest, FindsAWrongCost) {
  EXPECT_EQ(Validate({16.9, {1, 1}, {}}).message(), "cost 16.9, computed anew 17 to 17");
}

TEST_F(ValidateMovesTest, FindsWrongCounts) {
  EXPECT_EQ(Validate({17, {0, 1}, {}}).message(), "crossings 0, computed anew 1 to 1");
  EXPECT_EQ(Validate({17, {1, 2}, {}}).message(), "retractions 2, computed anew 1 to 1");
}

TEST_F(ValidateMovesTest, KnowsTheMovesThatAreKnown) {
  walls_.known = {{1, 2, 3, true, false}};

  EXPECT_OK(Validate({1 + 3 + 5, {1, 0}, {}}));
  EXPECT_EQ(Validate({17, {1, 1}, {}}).message(), "cost 17, computed anew 9 to 9");
  EXPECT_EQ(Validate({9, {0, 0}, {}}).message(), "crossings 0, computed anew 1 to 1");
  EXPECT_EQ(Validate({9, {1, 1}, {}}).message(), "retractions 1, computed anew 0 to 0");
  EXPECT_EQ(Validate({9, {1, 0}, {{2, {{1.5, 20}}}}}).message(),
            "route[2]: it is a known move, so it does not lead around walls");
}

TEST_F(ValidateMovesTest, KnowsWhatIsRetractedInAnyCase) {
  walls_.retracted = {1};
  EXPECT_OK(Validate({12, {1, 1}, {}}));

  walls_.retracted = {1, 2};
  EXPECT_OK(Validate({7, {1, 1}, {}}));
}

int64_t PeakKilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// A wall that goes up and down all over the layer. Each line was noted in each of 300 stripes.
TEST_F(ValidateMovesTest, UprightWallsTakeNoMoreMemoryThanOthers) {
  constexpr int kLines = 100'000;
  Wall& upright = walls_.walls.emplace_back();
  for (int i = 0; i < kLines; ++i) upright.points.push_back({100 + 1e-3 * i, i % 2 * 200.0});
  const int64_t before = PeakKilobytes();

  EXPECT_OK(Validate({17, {1, 1}, {}}));

  EXPECT_LT(PeakKilobytes() - before, 200'000);
}

TEST_F(ValidateMovesTest, LetsRoundingDecideWhatTouches) {
  walls_.walls = {{{{1.5, 0}, {1.5, 9}}, false, -1}};

  EXPECT_OK(Validate({17, {1, 1}, {}}));
  EXPECT_OK(Validate({2, {0, 0}, {}}));
}

TEST_F(ValidateMovesTest, MeasuresWaysAroundAndFindsThoseThatCross) {
  walls_.walls = {{{{1.5, -2}, {1.5, 2}}, false, -1}};
  spec_.wall_slack_mm = 0;

  EXPECT_OK(Validate({1 + 3 + 1 + 3, {0, 0}, {{2, {{1, 3}, {2, 3}}}}}));
  EXPECT_EQ(Validate({1 + 1 + 1 + 1, {0, 0}, {{2, {{1, 1}, {2, 1}}}}}).message(),
            "route[2]: its way around walls crosses one");
  EXPECT_EQ(Validate({17, {1, 1}, {{3, {{1, 3}}}}}).message(), "detours[0]: belongs to no move");
}

}  // namespace
}  // namespace traverse
