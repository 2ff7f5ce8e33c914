// Two characters a byte: client/containers/bgcode/meatpack.

#include "client/containers/bgcode/meatpack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/client/containers/sliced_text.h"
#include "tests/support/status_matchers.h"

namespace traverse::containers {
namespace {

using ::testing::HasSubstr;
using namespace std::string_literals;
using testing::StatusIs;

constexpr size_t kPlenty = size_t{1} << 24;

TEST(MeatPack, PacksTwoCharactersInAByte) {
  std::string out;
  MeatPack("G1 X10 Y2\n", out);
  EXPECT_EQ(out, "\xff\xff\xfb\xff\xff\xf7\x1d\x1e\xf0\x59\xc2"s);
}

TEST(MeatPack, EndsEachLineWithAByte) {
  std::string out;
  MeatPack("G28\nM84 E\n", out);
  EXPECT_EQ(out, "\xff\xff\xfb\xff\xff\xf7\x2d\xc8\x8fM\xf4\x20\xcb"s);
  out.clear();
  MeatPack("M107\n", out);  // five characters: the line end is there twice
  EXPECT_EQ(out.substr(6), "\x1fM\x70\xcc"s);
}

TEST(MeatPack, WritesCommentsAsTheyAre) {
  std::string out;
  MeatPack(";a\n;b\nG1\n", out);
  EXPECT_EQ(out, "\xff\xff\xfb\xff\xff\xf7\xff\xff\xfa;a\n;b\n\xff\xff\xfb\x1d\xcc"s);
}

TEST(MeatPack, PutsSpacesBackBeforeLettersOfMoves) {
  std::string out;
  std::string packed;
  MeatPack("G1X1Y-2E.5\nG28 XY\nM862.6 P\"Input shaper\"\nG1 X1 ;to the left\n", packed);
  ASSERT_OK(MeatUnpack(packed, kPlenty, out));
  EXPECT_EQ(out, "G1 X1 Y-2 E.5\nG28 X Y\nM862.6 P\"Input shaper\"\nG1 X1 ;to the left\n");
}

TEST(MeatPack, KeepsSpacesThatCount) {
  const std::string text =
      "G1 X1 Y2*71\nG21 \nG28 X ; c d\nG1 X1 Y1 \r\nG10 P\"a b\"\nM117 G 1\n G1 X1\n;G1 X1\nG1 X9 "
      "Y9";
  std::string packed;
  std::string out;
  MeatPack(text, packed);
  ASSERT_OK(MeatUnpack(packed, kPlenty, out));
  EXPECT_EQ(out, text);
}

TEST(MeatPack, GivesBackWhatWasPacked) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string text = SlicedText(random, 200);
    // Some of it spoiled, down to lines that are no G-code.
    for (int i = 0; i < 20 && seed % 2 == 1; ++i) {
      text[random() % text.size()] = static_cast<char>(random() % 255);
    }
    if (seed % 5 == 0) text.pop_back();
    std::string packed;
    std::string out;
    MeatPack(text, packed);
    ASSERT_OK(MeatUnpack(packed, kPlenty, out));
    ASSERT_TRUE(EqualToAPrinter(out, text)) << out;
    if (seed % 2 == 0) {
      EXPECT_EQ(out, text);
    }
  }
}

TEST(MeatPack, RefusesWhatEndsEarlyOrIsNotKnown) {
  std::string out;
  EXPECT_THAT(MeatUnpack("\xff\xff\xfb\x1f"s, kPlenty, out),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("too early")));
  EXPECT_THAT(MeatUnpack("\xff\xff"s, kPlenty, out),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("too early")));
  EXPECT_THAT(MeatUnpack("\xff\xff\x10"s, kPlenty, out),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("command 16 is unknown")));
  EXPECT_THAT(MeatUnpack("plain text", 5, out),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("too much")));
}

TEST(MeatPack, LacksOneByte) {
  EXPECT_TRUE(CanMeatPack("G1 X1 ; caf\xc3\xa9\n"));
  EXPECT_FALSE(CanMeatPack("G1 X1 ; \xff\n"));
}

TEST(EqualToAPrinter, LooksAwayFromSpacesInMovesAlone) {
  EXPECT_TRUE(EqualToAPrinter("G1 X1 Y2\n", "G1X1Y2\n"));
  EXPECT_TRUE(EqualToAPrinter("G1 X1 Y2 ;a b\n", "G1X1Y2 ;a b\n"));
  EXPECT_FALSE(EqualToAPrinter("G1 X1 Y2 ;a b\n", "G1X1Y2 ;ab\n"));
  EXPECT_FALSE(EqualToAPrinter("M117 a b\n", "M117 ab\n"));
  EXPECT_FALSE(EqualToAPrinter("G1 X1 Y2\n", "G1 X1 Y3\n"));
  EXPECT_FALSE(EqualToAPrinter("G1 X1\n", "G1 X1\nG1 X1\n"));
  EXPECT_FALSE(EqualToAPrinter("G1 X1\n", "G1 X12\n"));
}

}  // namespace
}  // namespace traverse::containers
