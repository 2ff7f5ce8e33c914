#include "client/gtsp/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/files/read_file.h"
#include "client/formats/api_format.h"
#include "client/formats/read_input.h"
#include "client/gtsp/instance.h"
#include "tests/support/golden.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;

constexpr char kSmall[] =
    "NAME : two\r\nTYPE : GTSP\r\nDIMENSION : 3\r\nGTSP_SETS : 2\r\nEDGE_WEIGHT_TYPE : EUC_2D\r\n"
    "NODE_COORD_SECTION\r\n1 0 0\r\n2 3 4\r\n3 6 8\r\nGTSP_SET_SECTION\r\n1 1 -1\r\n2 2 3 -1\r\n"
    "EOF\r\nwhat follows is not read\r\n";

std::string SmallText() { return absl::StrReplaceAll(kSmall, {{"\r", ""}}); }

std::string ErrorOf(const std::string& text) {
  const absl::StatusOr<InputJob> job = ReadGtsp(text, "a.gtsp");
  EXPECT_EQ(job.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(job.status().message());
}

// The fault of the small file with `from` replaced.
std::string ErrorWith(const std::string& from, const std::string& to) {
  const std::string text = SmallText();
  EXPECT_NE(text.find(from), std::string::npos) << from;
  return ErrorOf(absl::StrReplaceAll(text, {{from, to}}));
}

TEST(GtspReader, GoodFileMatchesItsGolden) {
  const absl::StatusOr<InputJob> job = ReadInput(testing::DataPath("gtsp/4small10.gtsp"));
  ASSERT_TRUE(job.ok()) << job.status();

  const absl::StatusOr<std::string> json = WriteApiJson(*job);

  ASSERT_TRUE(json.ok()) << json.status();
  EXPECT_TRUE(testing::MatchesGolden("gtsp/4small10.json", *json));
}

TEST(GtspReader, ALayerForEachPointOfTheSmallestSet) {
  const InputJob job = *ReadInput(testing::DataPath("gtsp/4small10.gtsp"));

  EXPECT_EQ(job.format, InputFormat::kGtsp);
  ASSERT_EQ(job.layers.size(), 2u);
  EXPECT_EQ(job.layers[1].id(), 2u);
  EXPECT_EQ(job.layers[1].start().x_mm(), 3.5);
  const v1::Plan& plan = job.layers[1].plan();
  ASSERT_EQ(plan.paths_size(), 4);
  EXPECT_EQ(plan.paths(0).contour().id(), 2u);
  EXPECT_THAT(plan.paths(0).contour().points(), ElementsAre(10, 0, 12, 2, 9, 3.5));
  EXPECT_EQ(plan.paths(3).contour().id(), 1u);
  EXPECT_THAT(plan.paths(3).contour().points(), ElementsAre(3.5, 1));
  EXPECT_THAT(plan.nodes(0).in_order().children(), ElementsAre(1, 5));
  EXPECT_THAT(plan.nodes(1).any_order().children(), ElementsAre(2, 3, 4));
}

TEST(GtspReader, TakesSpacesBeforeColonsAndCrlfAndIgnoresWhatFollowsTheEnd) {
  const absl::StatusOr<InputJob> job = ReadGtsp(kSmall, "a.gtsp");

  ASSERT_TRUE(job.ok()) << job.status();
  EXPECT_THAT(job->gtsp->sets, ElementsAre(ElementsAre(0), ElementsAre(1, 2)));
  EXPECT_EQ(job->gtsp->points[1].y, 4);
}

TEST(GtspReader, TakesPointsInThePlaneAndNoOthers) {
  EXPECT_TRUE(ReadGtsp("NODE_COORD_TYPE: TWOD_COORDS\n" + SmallText(), "a.gtsp").ok());
  EXPECT_EQ(ErrorOf("NODE_COORD_TYPE: THREED_COORDS\n" + SmallText()),
            "a.gtsp:1: NODE_COORD_TYPE is \"THREED_COORDS\", but only TWOD_COORDS is supported");
}

TEST(GtspReader, OneSetIsATourOfOnePoint) {
  const absl::StatusOr<InputJob> job = ReadGtsp(
      "TYPE: GTSP\nDIMENSION: 1\nGTSP_SETS: 1\nEDGE_WEIGHT_TYPE: EUC_2D\nNODE_COORD_SECTION\n1 2 "
      "3\n"
      "GTSP_SET_SECTION\n1 1 -1\n",
      "a.gtsp");

  ASSERT_TRUE(job.ok()) << job.status();
  ASSERT_EQ(job->layers.size(), 1u);
  EXPECT_EQ(job->layers[0].plan().paths_size(), 1);
}

TEST(GtspReader, NamesTheLineOfEachFaultInTheHead) {
  EXPECT_EQ(ErrorWith("TYPE : GTSP", "TYPE : AGTSP"),
            "a.gtsp:2: TYPE is \"AGTSP\", but only GTSP is supported");
  EXPECT_EQ(ErrorWith("EUC_2D", "EXPLICIT"),
            "a.gtsp:5: EDGE_WEIGHT_TYPE is \"EXPLICIT\", but only EUC_2D is supported");
  EXPECT_EQ(ErrorWith("DIMENSION : 3", "DIMENSION : -3"),
            "a.gtsp:3: DIMENSION is \"-3\", but must be a whole number of at least 1");
  EXPECT_EQ(ErrorWith("DIMENSION : 3", "DIMENSION : 3000000000"),
            "a.gtsp:3: DIMENSION is 3000000000, but the file is too short for so many");
  EXPECT_EQ(ErrorWith("NAME : two\n", "NAME : two\nNAME : three\n"),
            "a.gtsp:2: second \"NAME\", after line 1");
  EXPECT_EQ(ErrorWith("GTSP_SETS : 2\n", ""), "a.gtsp:5: NODE_COORD_SECTION before GTSP_SETS");
  EXPECT_EQ(ErrorWith("NAME :", "EDGE_WEIGHT_SECTION"),
            "a.gtsp:1: \"EDGE_WEIGHT_SECTION\" is not a supported key of a GTSPLIB file");
  EXPECT_EQ(ErrorWith("NAME : two", "1 2 3"), "a.gtsp:1: a number outside a section");
}

TEST(GtspReader, NamesTheLineOfEachFaultInThePoints) {
  EXPECT_EQ(ErrorWith("2 3 4\n", "2 3\n"), "a.gtsp:8: a point needs a number, x and y");
  EXPECT_EQ(ErrorWith("2 3 4\n", "2 3 4 5\n"), "a.gtsp:8: a point needs a number, x and y");
  EXPECT_EQ(ErrorWith("2 3 4\n", "1 3 4\n"), "a.gtsp:8: second point 1");
  EXPECT_EQ(ErrorWith("2 3 4\n", "4 3 4\n"), "a.gtsp:8: point 4 is not among 1 to DIMENSION, 3");
  EXPECT_EQ(ErrorWith("2 3 4\n", "2 nan 4\n"), "a.gtsp:8: point 2 is not within +-1e6");
  EXPECT_EQ(ErrorWith("2 3 4\n", "2 3 inf\n"), "a.gtsp:8: point 2 is not within +-1e6");
  EXPECT_EQ(ErrorWith("2 3 4\n", ""),
            "a.gtsp:12: DIMENSION is 3, but there are 2 points: is the file cut short?");
}

TEST(GtspReader, NamesTheLineOfEachFaultInTheSets) {
  EXPECT_EQ(ErrorWith("2 2 3 -1", "2 1 2 3 -1"), "a.gtsp:12: point 1 is in set 1 and in set 2");
  EXPECT_EQ(ErrorWith("2 2 3 -1", "2 2 2 3 -1"), "a.gtsp:12: point 2 is in set 2 twice");
  EXPECT_EQ(ErrorWith("2 2 3 -1", "2 2 -1"), "a.gtsp:13: point 3 is in no set");
  EXPECT_EQ(ErrorWith("2 2 3 -1", "3 2 3 -1"), "a.gtsp:12: set 3 is not among 1 to GTSP_SETS, 2");
  EXPECT_EQ(ErrorWith("2 2 3 -1", "0 2 3 -1"), "a.gtsp:12: set 0 is not among 1 to GTSP_SETS, 2");
  EXPECT_EQ(ErrorWith("2 2 3 -1", "1 2 3 -1"), "a.gtsp:12: second set 1");
  EXPECT_EQ(ErrorWith("2 2 3 -1", "2 -1"), "a.gtsp:12: set 2 has no point");
  EXPECT_EQ(ErrorWith("2 2 3 -1", "2 2 4 -1"),
            "a.gtsp:12: point 4 of set 2 is not among 1 to DIMENSION, 3");
  EXPECT_EQ(ErrorWith("2 2 3 -1", "2 2 3.5 -1"), "a.gtsp:12: \"3.5\" is not a whole number");
  EXPECT_EQ(ErrorWith("2 2 3 -1", "2 2 3"), "a.gtsp:13: set 2 does not end with -1");
  EXPECT_EQ(ErrorWith("1 1 -1\n", "1 1\n"),
            "a.gtsp:12: point 2 is in set 1 twice (line 11 has no -1)");
}

TEST(GtspReader, RefusesEveryCutOfWhatIsNeeded) {
  const std::string text = SmallText();
  const size_t whole = text.find("\nEOF");

  for (size_t length = 0; length < whole; ++length) {
    const absl::StatusOr<InputJob> job = ReadGtsp(text.substr(0, length), "a.gtsp");
    EXPECT_FALSE(job.ok()) << length;
  }
  EXPECT_TRUE(ReadGtsp(text.substr(0, whole), "a.gtsp").ok());
}

TEST(GtspReader, RefusesInstancesWithoutASmallSet) {
  std::string text =
      "TYPE: GTSP\nDIMENSION: 2002\nGTSP_SETS: 2\nEDGE_WEIGHT_TYPE: EUC_2D\nNODE_COORD_SECTION\n";
  for (int i = 1; i <= 2002; ++i) absl::StrAppend(&text, i, " 0 0\n");
  text += "GTSP_SET_SECTION\n1";
  for (int i = 1; i <= 1001; ++i) absl::StrAppend(&text, " ", i);
  text += " -1\n2";
  for (int i = 1002; i <= 2002; ++i) absl::StrAppend(&text, " ", i);
  text += " -1\n";

  EXPECT_EQ(ErrorOf(text),
            "a.gtsp:2010: too large: the smallest set has 1001 points, which times all 2002 is "
            "more than 1000000");
}

}  // namespace
}  // namespace traverse
