#include "engine/model/sub_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;

TEST(StagesOf, AreContoursThenRasters) {
  const Plan plan = SequentialPlan(testing::PlateWithHoles());

  const std::vector<SubPlan> stages = StagesOf(plan);

  ASSERT_EQ(stages.size(), 2u);
  EXPECT_THAT(stages[0].path_of, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(stages[1].path_of, ElementsAre(5, 6, 7));
  Route whole;
  AppendRoute(stages[1], {{2, 1}, {0, 0}}, whole);
  EXPECT_EQ(whole, (Route{{7, 1}, {5, 0}}));
}

TEST(StagesOf, AreValidPlansWithEveryPathOnce) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = testing::RandomPlan(seed, {.max_paths = 20});
    std::vector<bool> seen(plan.paths.size());
    for (const SubPlan& stage : StagesOf(plan)) {
      EXPECT_OK(CheckPlan(stage.plan));
      ASSERT_EQ(stage.path_of.size(), stage.plan.paths.size());
      for (size_t p = 0; p < stage.path_of.size(); ++p) {
        const size_t path = static_cast<size_t>(stage.path_of[p]);
        EXPECT_FALSE(seen[path]);
        seen[path] = true;
        EXPECT_EQ(stage.plan.paths[p].points, plan.paths[path].points);
      }
    }
    EXPECT_THAT(seen, ::testing::Each(true));
  }
}

}  // namespace
}  // namespace traverse
