// The worked example of engine/README.md keeps what strategies promise.

#include "tests/engine/strategy/entries_example.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/source_dir.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

std::unique_ptr<Strategy> Make(const std::map<std::string, std::string>& options) {
  const StrategyEntry entry = EntriesEntry();
  return entry.make(*StrategyOptions::Parse(entry.options, options));
}

TEST(EntriesExample, IsValidNotBehindGreedyAndNotBelowTheOptimum) {
  const auto strategy = Make({});
  const auto greedy = *MakeStrategy("greedy", {});
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 6});
    Budget budget;

    const Solution solution = strategy->Solve(owned.problem, budget);
    const Solution resumed = strategy->Resume(owned.problem, GivenRoute(owned.plan()), budget);

    ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
    ASSERT_OK(ValidateRoute(owned.plan(), resumed.route));
    const double cost = RouteCost(owned.problem, solution.route);
    EXPECT_LE(cost, RouteCost(owned.problem, greedy->Solve(owned.problem, budget).route) +
                        kCostTolerance);
    EXPECT_GE(cost, BruteForce(owned.problem).cost - kCostTolerance);
    EXPECT_LE(RouteCost(owned.problem, resumed.route),
              RouteCost(owned.problem, GivenRoute(owned.plan())) + kCostTolerance);
  }
}

TEST(EntriesExample, KeepsTheOrderGivenWhereAsked) {
  const OwnedProblem owned = RandomProblem(3, {.min_paths = 5, .max_paths = 5});
  Budget budget;

  const Route route = Make({{"order", "given"}})->Solve(owned.problem, budget).route;

  const Route given = GivenRoute(owned.plan());
  ASSERT_EQ(route.size(), given.size());
  for (size_t i = 0; i < route.size(); ++i) EXPECT_EQ(route[i].path, given[i].path);
}

std::string Read(const std::string& name) {
  std::ifstream file(absl::StrCat(TRAVERSE_SOURCE_DIR, "/", name));
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// What the guide shows is what is compiled here.
TEST(EntriesExample, IsTheOneInTheGuide) {
  const std::string guide = Read("engine/README.md");
  const std::string code = Read("tests/engine/strategy/entries_example.cc");
  const size_t begin = code.find("class Entries");
  ASSERT_NE(begin, std::string::npos);

  const std::string shown = code.substr(begin, code.rfind("\n}  // namespace traverse") - begin);

  EXPECT_NE(guide.find("```cpp\n" + shown + "```"), std::string::npos);
}

}  // namespace
}  // namespace traverse
