// Columns of text: client/report/table.

#include "client/report/table.h"

#include <gtest/gtest.h>

#include "client/report/numbers.h"

namespace traverse::report {
namespace {

TEST(Table, SetsTheFirstColumnLeftAndTheOthersRight) {
  Table table({"name", "µm"});
  table.Add({{"a"}, {"1"}});
  table.Add({{"bcdefg"}, {"1000"}});

  EXPECT_EQ(table.Text(), "name      µm\n------  ----\na          1\nbcdefg  1000\n");
}

}  // namespace
}  // namespace traverse::report
