// What was meant: client/cli/flags/nearest.

#include "client/cli/flags/nearest.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace traverse::cli {
namespace {

TEST(Nearest, KnowsSlipsAndSwaps) {
  const std::vector<std::string> words = {"optimize", "compare", "inspect", "convert", "none"};

  EXPECT_EQ(Nearest("optimise", words), "optimize");
  EXPECT_EQ(Nearest("cmopare", words), "compare");
  EXPECT_EQ(Nearest("opt", words), "optimize");
  EXPECT_EQ(Nearest("nonee", words), "none");
  EXPECT_EQ(Nearest("xyz", words), "");
  EXPECT_EQ(Nearest("", words), "");
  EXPECT_EQ(Nearest(std::string(10'000, 'x'), words), "");
}

}  // namespace
}  // namespace traverse::cli
