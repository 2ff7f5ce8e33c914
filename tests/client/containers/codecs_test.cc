// The codecs of containers: known vectors, and that all comes out as it went in.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "client/containers/bgcode/heatshrink.h"
#include "client/containers/bgcode/meatpack.h"
#include "client/containers/deflate.h"
#include "client/containers/zip/md5.h"
#include "tests/support/status_matchers.h"

namespace traverse::containers {
namespace {

using namespace std::string_literals;
using ::testing::HasSubstr;
using testing::StatusIs;

constexpr size_t kPlenty = size_t{1} << 24;

// Text of a few letters, so that it repeats itself, or of all bytes.
std::string RandomBytes(std::mt19937& random, size_t size, int letters) {
  std::string out;
  for (size_t i = 0; i < size; ++i) {
    out += static_cast<char>(static_cast<int>(random() % static_cast<unsigned>(letters)));
  }
  return out;
}

std::string SlicedText(std::mt19937& random, int lines) {
  std::string out;
  const auto number = [&] {
    return std::to_string(random() % 200) + "." + std::to_string(random() % 1000);
  };
  for (int i = 0; i < lines; ++i) {
    switch (random() % 8) {
      case 0:
        out += ";TYPE:Perimeter\n";
        break;
      case 1:
        out += "M204 S" + std::to_string(random() % 5000) + "\n";
        break;
      case 2:
        out += "M117 Layer \"" + std::to_string(i) + "\" ; caf\u00e9\n";
        break;
      case 3:
        out += "\n";
        break;
      default:
        out +=
            "G1 X" + number() + " Y" + number() + " E." + std::to_string(random() % 10000) + "\n";
    }
  }
  return out;
}

TEST(Heatshrink, WritesLettersAsNineBits) {
  EXPECT_EQ(HeatshrinkCompress("abc", {12, 4}), "\xb0\xd8\xac\x60");
}

TEST(Heatshrink, WritesARepeatAsDistanceAndLength) {
  // a, then 7 bytes from 1 back: 0, twelve bits of 0, four bits of 6.
  EXPECT_EQ(HeatshrinkCompress("aaaaaaaa", {12, 4}), "\xb0\x80\x01\x80"s);
}

TEST(Heatshrink, TakesZerosForWhatIsBeforeTheBeginning) {
  // 3 bytes from 5 back.
  const auto bytes = HeatshrinkDecompress("\x00\x21\x00"s, {12, 4}, 3);

  ASSERT_OK(bytes);
  EXPECT_EQ(*bytes, "\0\0\0"s);
}

TEST(Heatshrink, GivesBackWhatWasCompressed) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::string bytes = seed % 3 == 0
                                  ? SlicedText(random, 2000)
                                  : RandomBytes(random, random() % 9000, seed % 3 == 1 ? 3 : 256);
    for (const int window : {11, 12}) {
      const std::string packed = HeatshrinkCompress(bytes, {window, 4});
      const auto back = HeatshrinkDecompress(packed, {window, 4}, bytes.size());
      ASSERT_OK(back);
      ASSERT_EQ(*back, bytes);
    }
  }
}

TEST(Heatshrink, RefusesDataThatEndEarlyOrGoOn) {
  const std::string packed = HeatshrinkCompress("some text, some text, some other text", {12, 4});

  EXPECT_THAT(HeatshrinkDecompress(packed.substr(0, 20), {12, 4}, 37),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("too early")));
  EXPECT_THAT(HeatshrinkDecompress(packed + "more", {12, 4}, 37),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("behind their end")));
}

TEST(Heatshrink, TakesNoMemoryForASizeThatCannotBe) {
  EXPECT_THAT(
      HeatshrinkDecompress("abc", {12, 4}, UINT32_MAX),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("cannot be 4294967295 bytes")));
}

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
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("command 16 is not known")));
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

TEST(Deflate, GivesTheSameBytesOnAnyNumberOfThreads) {
  std::mt19937 random(1);
  const std::string text = SlicedText(random, 150000);  // three pieces
  for (const DeflateForm form : {DeflateForm::kRaw, DeflateForm::kZlib}) {
    const auto one = Deflate(text, form, 6, 1);
    const auto four = Deflate(text, form, 6, 4);
    ASSERT_OK(one);
    ASSERT_OK(four);
    EXPECT_EQ(*one, *four);
    const auto back = Inflate(*one, form, text.size());
    ASSERT_OK(back);
    EXPECT_EQ(*back, text);
  }
}

TEST(Deflate, GivesBackEmptyText) {
  const auto bytes = Deflate("", DeflateForm::kZlib, 6, 2);
  ASSERT_OK(bytes);
  const auto back = Inflate(*bytes, DeflateForm::kZlib, 0);
  ASSERT_OK(back);
  EXPECT_EQ(*back, "");
}

TEST(Inflate, RefusesAnotherSizeThanIsAnnounced) {
  const auto bytes = Deflate("some text", DeflateForm::kRaw, 6, 1);
  ASSERT_OK(bytes);

  EXPECT_THAT(Inflate(*bytes, DeflateForm::kRaw, 8),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("more than the 8 bytes")));
  EXPECT_THAT(Inflate(*bytes, DeflateForm::kRaw, 10),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("are 9 bytes, and 10")));
  EXPECT_THAT(Inflate(*bytes + "x", DeflateForm::kRaw, 9),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("behind their end")));
  EXPECT_THAT(Inflate(bytes->substr(0, 5), DeflateForm::kRaw, 9),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("too early")));
  EXPECT_THAT(Inflate(*bytes, DeflateForm::kRaw, UINT32_MAX - 1),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("cannot be")));
}

TEST(Crc32, IsTheOneOfZip) { EXPECT_EQ(Crc32("123456789"), 0xcbf43926u); }

TEST(Md5, IsThatOfItsStandard) {
  EXPECT_EQ(Md5Hex("message digest"), "F96B697D7CB7938D525A2F31AAF161D0");
}

TEST(Md5, IsWrittenAsTheOneBefore) {
  const std::string digest = "F96B697D7CB7938D525A2F31AAF161D0";

  EXPECT_EQ(WithMd5("3deb4d98d9e0dd55959de96bbc65d76f", digest),
            "f96b697d7cb7938d525a2f31aaf161d0");
  EXPECT_EQ(WithMd5("3DEB4D98D9E0DD55959DE96BBC65D76F\r\n", digest), digest + "\r\n");
  EXPECT_EQ(FindMd5("3deb4d98d9e0dd55959de96bbc65d76f\n"), "3DEB4D98D9E0DD55959DE96BBC65D76F");
  EXPECT_EQ(FindMd5("3deb4d98d9e0dd55959de96bbc65d76"), std::nullopt);
  EXPECT_EQ(FindMd5("3deb4d98d9e0dd55959de96bbc65d76f0"), std::nullopt);
}

}  // namespace
}  // namespace traverse::containers
