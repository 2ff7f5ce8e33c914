#include "tests/support/problems/random_plan.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "tests/support/status_matchers.h"

namespace traverse::testing {
namespace {

TEST(RandomPlan, PassesTheCheckAndKeepsItsSize) {
  for (uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));

    const Plan plan = RandomPlan(seed, {.max_paths = 12});

    EXPECT_OK(CheckPlan(plan));
    EXPECT_LE(plan.paths.size(), 12u);
  }
}

TEST(RandomPlan, CoversWhatIsSpecial) {
  int empty = 0, pathless_nodes = 0, before = 0, one_way = 0, limited = 0, one_point = 0, deep = 0;
  for (uint64_t seed = 1; seed <= 500; ++seed) {
    const Plan plan = RandomPlan(seed);
    empty += plan.paths.empty();
    deep += plan.nodes.size() > plan.paths.size() + 4;
    for (const PlanNode& node : plan.nodes) {
      pathless_nodes += node.kind != PlanNode::Kind::kPath && node.children.empty();
      before += !node.before.empty();
    }
    for (const Path& path : plan.paths) {
      one_way += path.one_way;
      limited += !path.allowed.empty();
      one_point += path.points.size() == 1;
    }
  }

  for (const int count : {empty, pathless_nodes, before, one_way, limited, one_point, deep}) {
    EXPECT_GE(count, 10);
  }
}

TEST(RandomProblem, IsTheSameForTheSameSeed) {
  const OwnedProblem first = RandomProblem(7, {.min_paths = 5});
  const OwnedProblem second = RandomProblem(7, {.min_paths = 5});

  EXPECT_EQ(first.problem.start, second.problem.start);
  EXPECT_EQ(first.problem.cost, second.problem.cost);
  ASSERT_EQ(first.plan().paths.size(), second.plan().paths.size());
  EXPECT_EQ(first.plan().paths[0].points, second.plan().paths[0].points);
}

}  // namespace
}  // namespace traverse::testing
