// What is said of plates: client/containers/zip/slice_info.

#include "client/containers/zip/slice_info.h"

#include <gtest/gtest.h>

#include <string>

namespace traverse::containers {
namespace {

// Each of the tags once went through all that follows: minutes for these.
TEST(SliceInfo, IsReadInLinearTime) {
  std::string open = "<plate>";
  while (open.size() < (size_t{4} << 20)) open += "<metadata ";
  for (const char* end : {"", ">", " key=\"index\" value=\"1\">"}) {
    EXPECT_EQ(PlateValue(open + end, 1, "prediction"), "");
  }
}

}  // namespace
}  // namespace traverse::containers
