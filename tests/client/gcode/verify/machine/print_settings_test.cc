#include "client/gcode/verify/machine/print_settings.h"

#include <gtest/gtest.h>

#include <string>

namespace traverse::gcode {
namespace {

struct Digests {
  uint64_t print;
  uint64_t acceleration;
};

// After `M<number> <words>`, which has to be known.
Digests After(int number, const std::string& words) {
  PrintSettings settings;
  EXPECT_TRUE(settings.SetByM(number, CommandWords(words))) << "M" << number << " " << words;
  return {settings.Digest(), settings.AccelerationDigest()};
}

TEST(VerifyPrintSettings, EachAccelerationAndLimitCountsForDeposits) {
  PrintSettings none;
  for (const int number : {201, 202, 205}) {
    for (const std::string axis : {"X", "Y"}) {
      const Digests digests = After(number, axis + "800");
      EXPECT_NE(digests.print, none.Digest()) << "M" << number << " " << axis;
      EXPECT_NE(digests.acceleration, none.AccelerationDigest()) << "M" << number << " " << axis;
      EXPECT_NE(digests.print, After(number, axis + "900").print) << "M" << number << " " << axis;
    }
    EXPECT_NE(After(number, "X800").print, After(number, "Y800").print) << "M" << number;
  }
  EXPECT_NE(After(204, "P800").print, none.Digest());
}

TEST(VerifyPrintSettings, NamesOfFeaturesCountForDeposits) {
  for (const std::string name : {";TYPE:Perimeter", "; outer perimeter", "; 'Loop Path', 1"}) {
    PrintSettings settings;
    EXPECT_TRUE(settings.SetByComment(name)) << name;
    EXPECT_NE(settings.Digest(), PrintSettings().Digest()) << name;
  }
  PrintSettings none;
  EXPECT_FALSE(none.SetByComment("; a remark"));
  EXPECT_EQ(none.Digest(), PrintSettings().Digest());
}

TEST(VerifyPrintSettings, AccelerationOfTravelAndRetractionsCountsForNoDeposit) {
  PrintSettings none;
  EXPECT_EQ(After(204, "T800").print, none.Digest());
  EXPECT_EQ(After(204, "R800").print, none.Digest());
  EXPECT_NE(After(204, "T800").acceleration, none.AccelerationDigest());
}

uint64_t KlipperDigestAfter(const std::string& text) {
  PrintSettings settings;
  EXPECT_TRUE(settings.SetByKlipper(text)) << text;
  return settings.Digest();
}

TEST(VerifyPrintSettings, LimitsOfKlipperEndWhereAComment) {
  const std::string set = "SET_VELOCITY_LIMIT ACCEL=800 SQUARE_CORNER_VELOCITY=5";
  EXPECT_NE(KlipperDigestAfter(set), PrintSettings().Digest());
  EXPECT_EQ(KlipperDigestAfter(set + " ; as slow as that"), KlipperDigestAfter(set));
  EXPECT_EQ(KlipperDigestAfter(set + ";slow"), KlipperDigestAfter(set));
  EXPECT_NE(KlipperDigestAfter("SET_VELOCITY_LIMIT ACCEL=900 SQUARE_CORNER_VELOCITY=5"),
            KlipperDigestAfter(set));
  PrintSettings none;
  EXPECT_FALSE(none.SetByKlipper("SET_VELOCITY_LIMIT ACCEL=800 NEW=1"));
  EXPECT_EQ(none.Digest(), PrintSettings().Digest());
}

uint64_t DigestAfter(const std::string& comment) {
  PrintSettings settings;
  EXPECT_TRUE(settings.SetByComment(comment)) << comment;
  return settings.Digest();
}

TEST(VerifyPrintSettings, TypeWidthAndHeightCountInTheWordsOfEachSlicer) {
  const char* const marks[][2] = {
      {";TYPE:", "; FEATURE: "}, {";WIDTH:", "; LINE_WIDTH: "}, {";HEIGHT:", "; LAYER_HEIGHT: "}};
  for (const auto& [one, other] : marks) {
    const std::string mark = one;
    EXPECT_NE(DigestAfter(mark + "0.2"), PrintSettings().Digest()) << mark;
    EXPECT_NE(DigestAfter(mark + "0.2"), DigestAfter(mark + "0.3")) << mark;
    EXPECT_EQ(DigestAfter(mark + "0.2"), DigestAfter(other + std::string("0.2"))) << mark;
  }
  EXPECT_NE(DigestAfter(";WIDTH:0.2"), DigestAfter(";HEIGHT:0.2"));
  PrintSettings none;
  EXPECT_FALSE(none.SetByComment("; layer 7"));
  EXPECT_EQ(none.Digest(), PrintSettings().Digest());
}

}  // namespace
}  // namespace traverse::gcode
