#include "client/damat/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "client/files/read_file.h"
#include "client/formats/api_format.h"
#include "tests/support/golden.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

InputJob Read(const std::string& text) {
  absl::StatusOr<InputJob> job = ReadDamat(text, "part.damat");
  EXPECT_TRUE(job.ok()) << job.status();
  return job.ok() ? *std::move(job) : InputJob{};
}

std::string ErrorOf(const std::string& text) {
  const absl::StatusOr<InputJob> job = ReadDamat(text, "part.damat");
  EXPECT_EQ(job.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(job.status().message());
}

// A layer of one island around `records`, whose first line is number 4.
std::string Island(int contours, int rasters, const std::string& records) {
  return absl::StrCat("nF,1\nF1,1\nI1,", contours, ",", rasters, "\n", records);
}

TEST(DamatReader, GoodFileMatchesItsGolden) {
  const absl::StatusOr<std::string> text =
      ReadWholeFile(testing::DataPath("damat/two_islands.damat"));
  ASSERT_TRUE(text.ok()) << text.status();

  const absl::StatusOr<std::string> json = WriteApiJson(Read(*text));

  ASSERT_TRUE(json.ok()) << json.status();
  EXPECT_TRUE(testing::MatchesGolden("damat/two_islands.json", *json));
}

TEST(DamatReader, GoldenComparisonCanFail) {
  if (testing::RenewsGoldens()) GTEST_SKIP() << "goldens are being renewed";
  EXPECT_FALSE(testing::MatchesGolden("damat/two_islands.damat", "// something else\n"));
}

TEST(DamatReader, KeepsEnvelope) {
  const InputJob job = Read("M,179.468,117.567\nnF,0\n");

  ASSERT_TRUE(job.envelope.has_value());
  EXPECT_EQ(job.envelope->x_mm(), 179.468);
  EXPECT_EQ(job.envelope->y_mm(), 117.567);
  EXPECT_THAT(job.layers, IsEmpty());
}

TEST(DamatReader, AcceptsCrlfByteOrderMarkAndNoLastNewline) {
  const InputJob job = Read("\xEF\xBB\xBF// a\r\nnF,1\r\n\r\nF1,1\r\nI1,1,0\r\nC1,X1,Y2\r\n");
  const InputJob same = Read("nF,1\nF1,1\nI1,1,0\nC1,X1,Y2");

  ASSERT_THAT(job.layers, SizeIs(1));
  EXPECT_THAT(job.layers[0].islands(0).contours(0).points(), ElementsAre(1, 2));
  EXPECT_EQ(job.layers[0].SerializeAsString(), same.layers.at(0).SerializeAsString());
}

TEST(DamatReader, DropsRepeatedClosingVertexOnce) {
  const InputJob job = Read(Island(2, 0, "C1,X1,Y1,X2,Y2,X1,Y1,X1,Y1\nC2,X3,Y3,X3,Y3\n"));

  const v1::Island& island = job.layers.at(0).islands(0);
  EXPECT_THAT(island.contours(0).points(), ElementsAre(1, 1, 2, 2, 1, 1));
  EXPECT_THAT(island.contours(1).points(), ElementsAre(3, 3));
}

TEST(DamatReader, AcceptsDegenerateGeometry) {
  const InputJob job = Read(
      "nF,3\nF1,0\nF2,2\nI1,0,0\nI2,2,1\nC1,X1,Y1\nC2,X2,Y2,X2,Y2,X2,Y2,X3,Y3\n"
      "R1,X4,Y4,X4,Y4\nF3,1\nI1,0,1\nR1,X0,Y0,X1,Y1\n");

  ASSERT_THAT(job.layers, SizeIs(3));
  EXPECT_THAT(job.layers[0].islands(), IsEmpty());
  EXPECT_THAT(job.layers[1].islands(1).contours(1).points(), SizeIs(8));
  EXPECT_THAT(job.layers[1].islands(1).rasters(0).points(), ElementsAre(4, 4, 4, 4));
}

// Figure 3.3 as it is printed: C1,X96.5621,Y98.1351, the next vertex on the next line.
TEST(DamatReader, ReadsAVertexALine) {
  const InputJob one = Read(
      "nF,1\nF1,2\nI1,2,1\nC1,X0,Y0\nC1,X9,Y0\nC1,X9,Y9\nC1,X0,Y9\nC1,X0,Y0\nC2,X1,Y1\nC2,X2,Y1\n"
      "C2,X2,Y2\nR1,X3,Y3,X4,Y4\nI2,2,0\nC1,X20,Y20\nC2,X20,Y20\n");
  const InputJob same = Read(
      "nF,1\nF1,2\nI1,2,1\nC1,X0,Y0,X9,Y0,X9,Y9,X0,Y9,X0,Y0\nC2,X1,Y1,X2,Y1,X2,Y2\n"
      "R1,X3,Y3,X4,Y4\nI2,2,0\nC1,X20,Y20\nC2,X20,Y20\n");

  ASSERT_THAT(one.layers, SizeIs(1));
  EXPECT_EQ(one.layers[0].DebugString(), same.layers.at(0).DebugString());
}

TEST(DamatReader, ThicknessSaysWhereLayersAre) {
  for (const char* head : {"E,0.25\nnF,2\n", "nF,2,0.25\n"}) {
    const InputJob job = Read(absl::StrCat(head, "F1,0\nF2,0\n"));
    ASSERT_THAT(job.layers, SizeIs(2));
    EXPECT_EQ(job.layers[0].z_mm(), 0.25);
    EXPECT_EQ(job.layers[1].z_mm(), 0.5);
  }
  EXPECT_EQ(Read("nF,1\nF1,0\n").layers.at(0).z_mm(), 0);
}

// The outer contour is known by where it lies, not by where it stands.
TEST(DamatReader, FindsTheOuterContourWhereverItStands) {
  const char* outer = "C7,X0,Y0,X9,Y0,X9,Y9,X0,Y9\n";
  const char* a = "C1,X1,Y1,X2,Y1,X2,Y2\n";
  const char* b = "C2,X5,Y5,X6,Y5,X6,Y9\n";  // touches it
  const std::string first = Read(Island(3, 0, absl::StrCat(outer, a, b))).layers[0].DebugString();

  EXPECT_EQ(Read(Island(3, 0, absl::StrCat(a, outer, b))).layers.at(0).DebugString(), first);
  EXPECT_EQ(Read(Island(3, 0, absl::StrCat(a, b, outer))).layers.at(0).DebugString(), first);
}

TEST(DamatReader, IdsAreLabelsPerScope) {
  const InputJob job =
      Read("nF,2\nF7,2\nI4,1,1\nC2,X1,Y1\nR2,X1,Y1,X2,Y2\nI2,1,0\nC2,X1,Y1\nF3,1\nI4,0,0\n");

  EXPECT_EQ(job.layers.at(0).id(), 7u);
  EXPECT_EQ(job.layers.at(0).islands(0).id(), 4u);
  EXPECT_EQ(job.layers.at(1).islands(0).id(), 4u);
}

struct BadFile {
  const char* name;
  std::string text;
  std::string error;
};

class DamatReaderErrors : public ::testing::TestWithParam<BadFile> {};

TEST_P(DamatReaderErrors, NameTheLine) { EXPECT_EQ(ErrorOf(GetParam().text), GetParam().error); }

const std::string kHuge(100, '9');

INSTANTIATE_TEST_SUITE_P(
    , DamatReaderErrors,
    ::testing::Values(
        BadFile{"Empty", "", "part.damat:0: the file ends without nF, the number of layers"},
        BadFile{"Comments", "// a\n\n",
                "part.damat:2: the file ends without nF, the number of layers"},
        BadFile{"Text", "hello\n", "part.damat:1: not a DAMAT record: \"hello\""},
        BadFile{"Binary", std::string("nF,1\nF\x01\x00\xff,2\n", 12),
                "part.damat:2: not a DAMAT record: \"F???,2\""},
        BadFile{
            "LongLine", std::string(1000, 'z'),
            absl::StrCat("part.damat:1: not a DAMAT record: \"", std::string(32, 'z'), "...\"")},
        BadFile{"LeadingComma", ",1,2\n", "part.damat:1: not a DAMAT record: \",1,2\""},
        BadFile{"UnknownRecord", "nF,0\nQ1,2\n", "part.damat:2: not a DAMAT record: \"Q1,2\""},
        BadFile{"NegativeId", "nF,1\nF-1,2\n", "part.damat:2: not a DAMAT record: \"F-1,2\""},
        BadFile{
            "HugeId", absl::StrCat("nF,1\nF", kHuge, ",2\n"),
            absl::StrCat("part.damat:2: not a DAMAT record: \"F", std::string(31, '9'), "...\"")},
        BadFile{"LayerCountMissing", "M,1,1\nF1,0\n",
                "part.damat:2: a layer before nF, the number of layers"},
        BadFile{"LayerCountBad", "nF,many\n", "part.damat:1: nF needs the number of layers"},
        BadFile{"LayerCountTwice", "nF,0\nnF,0\n", "part.damat:2: second nF"},
        BadFile{"EnvelopeTwice", "M,1,1\nM,1,1\nnF,0\n", "part.damat:2: second M"},
        BadFile{"EnvelopeLate", "nF,0\nM,1,1\n", "part.damat:2: M comes after nF"},
        BadFile{"EnvelopeBad", "M,1,nan\nnF,0\n",
                "part.damat:1: M needs two coordinates within +-1e6 mm"},
        BadFile{"TooFewLayers", "// x\nnF,3\nF1,0\nF2,0\n",
                "part.damat:2: nF states 3 layers, but the file has 2"},
        BadFile{"TooManyLayers", "nF,1\nF1,0\nF2,0\n",
                "part.damat:1: nF states 1 layers, but the file has 2"},
        BadFile{"Islands", "nF,2\nF1,2\nI1,0,0\nF2,0\n",
                "part.damat:2: F1 states 2 islands, but the file has 1"},
        BadFile{"Contours", "nF,1\nF1,2\nI1,2,0\nC1,X1,Y1\nI2,0,0\n",
                "part.damat:3: I1 states 2 contours, but the file has 1"},
        BadFile{"Rasters", Island(0, 0, "R1,X1,Y1,X2,Y2\n"),
                "part.damat:3: I1 states 0 rasters, but the file has 1"},
        BadFile{"HugeCount", "nF,18446744073709551615\nF1,0\n",
                "part.damat:1: nF states 18446744073709551615 layers, but the file has 1"},
        BadFile{"LayerTwice", "nF,2\nF1,0\nF1,0\n", "part.damat:3: second layer with id 1"},
        BadFile{"IslandTwice", "nF,1\nF3,2\nI1,0,0\nI1,0,0\n",
                "part.damat:4: second island with id 1 in layer 3"},
        BadFile{"ContourTwice", Island(2, 0, "C1,X1,Y1,X2,Y2\nC1,X2,Y2,X1,Y1\n"),
                "part.damat:5: second contour with id 1 in island 1"},
        BadFile{"ContourComesAgain", Island(3, 0, "C1,X1,Y1\nC2,X1,Y1\nC1,X2,Y2\n"),
                "part.damat:6: second contour with id 1 in island 1"},
        BadFile{"LongAfterVertexALine", Island(2, 0, "C1,X1,Y1\nC1,X2,Y2\nC2,X1,Y1,X2,Y2\n"),
                "part.damat:6: two spellings in one file: line 5 continues a contour, one vertex a "
                "line, but line 6 has all vertices of one"},
        BadFile{"VertexALineAfterLong", Island(2, 0, "C1,X1,Y1,X2,Y2\nC2,X1,Y1\nC2,X2,Y2\n"),
                "part.damat:6: two spellings in one file: line 6 continues a contour, one vertex a "
                "line, but line 4 has all vertices of one"},
        BadFile{"LongGoesOn", Island(1, 0, "C1,X1,Y1\nC1,X2,Y2,X3,Y3\n"),
                "part.damat:5: two spellings in one file: line 5 continues a contour, one vertex a "
                "line, but line 5 has all vertices of one"},
        BadFile{"VertexALineCounted", Island(2, 0, "C1,X1,Y1\nC1,X2,Y2\n"),
                "part.damat:3: I1 states 2 contours, but the file has 1"},
        BadFile{"ThicknessMissing", "E\nnF,0\n",
                "part.damat:1: \"\" is not a layer thickness in mm, above 0 and up to 1e6"},
        BadFile{"ThicknessWord", "M,1,1\nE,thin\nnF,0\n",
                "part.damat:2: \"thin\" is not a layer thickness in mm, above 0 and up to 1e6"},
        BadFile{"ThicknessZero", "E,0\nnF,0\n",
                "part.damat:1: \"0\" is not a layer thickness in mm, above 0 and up to 1e6"},
        BadFile{"ThicknessNan", "nF,1,nan\nF1,0\n",
                "part.damat:1: \"nan\" is not a layer thickness in mm, above 0 and up to 1e6"},
        BadFile{"ThicknessTwice", "E,0.25\nnF,1,0.25\nF1,0\n",
                "part.damat:2: second thickness of a layer"},
        BadFile{"ThicknessLate", "nF,1\nE,0.25\nF1,0\n", "part.damat:2: E comes after nF"},
        BadFile{"ThicknessAndMore", "E,0.25,1\nnF,0\n",
                "part.damat:1: E has one number, the thickness of a layer"},
        BadFile{"LayerCountAndMore", "nF,0,0.25,1\n",
                "part.damat:1: nF has two numbers at most: layers, and their thickness"},
        BadFile{
            "TwoOuterContours",
            Island(2, 0, "C1,X0,Y0,X9,Y0,X9,Y9,X0,Y9\nC2,X10,Y0,X19,Y0,X19,Y8,X10,Y8\n"),
            "part.damat:5: C2 and C1 (line 4) are two outer contours of I1: neither lies within "
            "the other"},
        BadFile{
            "TwoOuterContoursTheLargerLast",
            Island(2, 0, "C1,X10,Y0,X19,Y0,X19,Y8,X10,Y8\nC2,X0,Y0,X9,Y0,X9,Y9,X0,Y9\n"),
            "part.damat:5: C2 and C1 (line 4) are two outer contours of I1: neither lies within "
            "the other"},
        BadFile{"InnerOutside",
                Island(3, 0,
                       "C4,X0,Y0,X9,Y0,X9,Y9,X0,Y9\nC5,X1,Y1,X2,Y1,X2,Y2\n"
                       "C6,X11,Y1,X12,Y1,X12,Y2\n"),
                "part.damat:6: C6 lies outside C4 (line 4), the outer contour of I1"},
        BadFile{"InnerInTheNotch",
                Island(3, 0,
                       "C4,X0,Y0,X9,Y0,X9,Y9,X5,Y9,X5,Y1,X4,Y1,X4,Y9,X0,Y9\n"
                       "C5,X1,Y1,X2,Y1,X2,Y2\nC6,X4.2,Y5,X4.8,Y5,X4.8,Y6\n"),
                "part.damat:6: C6 lies outside C4 (line 4), the outer contour of I1"},
        BadFile{"RasterTwice", Island(0, 2, "R1,X1,Y1,X2,Y2\nR1,X1,Y1,X2,Y2\n"),
                "part.damat:5: second raster with id 1 in island 1"},
        BadFile{"IslandOutside", "nF,1\nI1,0,0\n",
                "part.damat:2: an island before the first layer"},
        BadFile{"ContourOutside", "nF,1\nF1,1\nC1,X1,Y1\n",
                "part.damat:3: a contour outside an island"},
        BadFile{"RasterOutside", "nF,1\nR1,X1,Y1,X2,Y2\n",
                "part.damat:2: a raster outside an island"},
        BadFile{"NoPoints", Island(1, 0, "C1\n"), "part.damat:4: a contour without points"},
        BadFile{"CutAfterX", Island(1, 0, "C1,X1,Y1,X96.5"),
                "part.damat:4: the last X has no Y: is the file cut short?"},
        BadFile{"CutAfterComma", Island(1, 0, "C1,X1,Y1,X"),
                "part.damat:4: \"X\" is not a coordinate within +-1e6 mm"},
        BadFile{"Swapped", Island(1, 0, "C1,Y1,X1\n"),
                "part.damat:4: \"Y1\" found, but X of a point expected"},
        BadFile{"TwoX", Island(1, 0, "C1,X1,X1\n"),
                "part.damat:4: \"X1\" found, but Y of a point expected"},
        BadFile{"NaN", Island(1, 0, "C1,Xnan,Y1\n"),
                "part.damat:4: \"Xnan\" is not a coordinate within +-1e6 mm"},
        BadFile{"Infinite", Island(1, 0, "C1,X1,Y-inf\n"),
                "part.damat:4: \"Y-inf\" is not a coordinate within +-1e6 mm"},
        BadFile{"TooFar", Island(1, 0, "C1,X1,Y1e300\n"),
                "part.damat:4: \"Y1e300\" is not a coordinate within +-1e6 mm"},
        BadFile{"OutOfDouble", Island(1, 0, "C1,X1,Y1e999\n"),
                "part.damat:4: \"Y1e999\" is not a coordinate within +-1e6 mm"},
        BadFile{"DecimalComma", Island(1, 0, "C1,X1,5,Y2\n"),
                "part.damat:4: \"5\" found, but Y of a point expected"},
        BadFile{"RasterOneEnd", Island(0, 1, "R1,X1,Y1\n"),
                "part.damat:4: a raster has two ends, not 1"},
        BadFile{"RasterThreeEnds", Island(0, 1, "R1,X1,Y1,X2,Y2,X3,Y3\n"),
                "part.damat:4: a raster has two ends, not 3"},
        BadFile{"LayerWords", "nF,1\nF1,two\n",
                "part.damat:2: F needs an id and the number of islands"},
        BadFile{"IslandShort", "nF,1\nF1,1\nI1,1\n",
                "part.damat:3: I needs an id, the number of contours and the number of rasters"}),
    [](const ::testing::TestParamInfo<BadFile>& info) { return std::string(info.param.name); });

// A file cut anywhere either still holds whole records that its headers do not cover, or ends in a
// broken one; only a cut inside the last number goes unseen.
TEST(DamatReader, CutFilesAreRefused) {
  const absl::StatusOr<std::string> text =
      ReadWholeFile(testing::DataPath("damat/two_islands.damat"));
  ASSERT_TRUE(text.ok()) << text.status();
  const size_t last_number = text->rfind('Y') + 2;

  for (size_t length = 0; length < last_number; ++length) {
    EXPECT_FALSE(ReadDamat(text->substr(0, length), "part.damat").ok()) << length;
  }
}

}  // namespace
}  // namespace traverse
