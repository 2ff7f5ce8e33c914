#include "engine/cost/entry_table.h"

#include <gtest/gtest.h>

namespace traverse {
namespace {

Plan ThreePaths() {
  return InterleavedPlan(
      {{{MakeContour({{0, 0}, {1, 0}, {1, 1}}), MakeContour({{5, 5}, {6, 6}, {7, 7}}, {2, 0})},
        {MakeOpenPath({2, 2}, {3, 3}), MakeOpenPath({4, 4}, {9, 9}, true)}}});
}

TEST(EntryTable, NumbersEveryEntryOfEveryPath) {
  const EntryTable table(ThreePaths());

  EXPECT_EQ(table.path_count(), 4);
  EXPECT_EQ(table.entry_count(), 3 + 2 + 2 + 1);
  EXPECT_EQ(table.count(1), 2);
  EXPECT_EQ(table.enter(table.first(1)), (Point{7, 7}));
  EXPECT_EQ(table.exit(table.first(2)), (Point{3, 3}));
  EXPECT_EQ(table.enter(table.first(2) + 1), (Point{3, 3}));
  EXPECT_EQ(table.count(3), 1);
}

TEST(EntryTable, VisitAndEntryAreInverse) {
  const EntryTable table(ThreePaths());

  for (int e = 0; e < table.entry_count(); ++e) EXPECT_EQ(table.EntryOf(table.VisitOf(e)), e);
}

}  // namespace
}  // namespace traverse
