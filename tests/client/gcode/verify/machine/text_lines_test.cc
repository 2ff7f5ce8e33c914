#include "client/gcode/verify/machine/text_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace traverse::gcode {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> LinesOf(TextLines& lines) {
  std::vector<std::string> all;
  for (std::string_view line; lines.Next(line);) all.emplace_back(line);
  return all;
}

TEST(TextLines, EndWhereFirmwareEndsThem) {
  TextLines lines("a\nb\r\nc\r\r\n\nd\re\rf\r\ng");

  EXPECT_THAT(LinesOf(lines), ElementsAre("a", "b", "c", "", "d", "e", "f", "g"));
  EXPECT_EQ(lines.number(), 8u);
  EXPECT_TRUE(lines.rest().empty());
}

TEST(TextLines, NoteTheFirstLineOfEachEnd) {
  TextLines lines("a\nb\r\nc\r\r\nd\re\nf\r\n");
  LinesOf(lines);

  EXPECT_EQ(lines.ends(), 1u | 1u << 1 | 1u << 2 | TextLines::kLoneReturn);
  EXPECT_EQ(lines.FirstWithEnds(1u << 1), 2u);
  EXPECT_EQ(lines.FirstWithEnds(1u << 2 | TextLines::kLoneReturn), 3u);
  EXPECT_EQ(lines.FirstWithEnds(TextLines::kLoneReturn), 4u);
  EXPECT_EQ(lines.FirstWithEnds(1u << 3), 0u);
}

TEST(TextLines, HaveNoEndWhereTheFileEnds) {
  TextLines lines("a");

  EXPECT_THAT(LinesOf(lines), ElementsAre("a"));
  EXPECT_EQ(lines.ends(), 0u);
}

}  // namespace
}  // namespace traverse::gcode
