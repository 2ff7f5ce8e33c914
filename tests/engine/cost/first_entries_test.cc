#include "engine/cost/first_entries.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;
using namespace traverse::testing;  // NOLINT

std::vector<int> FirstPaths(const OwnedProblem& owned, int node, size_t limit) {
  const LayerView layer(owned.problem);
  std::vector<int> paths;
  ForEachFirstEntry(layer, node, limit, [&](int e) { paths.push_back(layer.table.path_of(e)); });
  return paths;
}

TEST(FirstEntries, AreAllOfALeafWhateverTheLimit) {
  const OwnedProblem owned(InterleavedPlan(SquareGrid(1, 1)));

  EXPECT_THAT(FirstPaths(owned, 1, 2), ElementsAre(0, 0, 0, 0));
}

TEST(FirstEntries, OfManyChildrenAreSpreadEvenly) {
  const OwnedProblem owned(FlatPlan(100));

  EXPECT_THAT(FirstPaths(owned, 0, 1000), SizeIs(100));
  EXPECT_THAT(FirstPaths(owned, 0, 4), ElementsAre(0, 25, 50, 75));
}

TEST(FirstEntries, AreThoseOfPathsThatALegalOrderBeginsWith) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.min_paths = 1, .max_paths = 6});
    std::vector<bool> expected(owned.plan().paths.size()), found(expected.size());
    for (const std::vector<int>& order : LegalOrders(owned.plan())) {
      expected[static_cast<size_t>(order[0])] = true;
    }

    for (const int path : FirstPaths(owned, 0, 1000)) found[static_cast<size_t>(path)] = true;

    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace traverse
