// The slicers of today, each in a small file of our own: tests/data/gcode/dialects/NAME.gcode.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "client/gcode/gcode_job.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/plan/layer_plan.h"
#include "client/gcode/read/reader.h"
#include "tests/client/gcode/support/corpus.h"
#include "tests/client/gcode/support/random_order.h"
#include "tests/client/gcode/support/verified.h"
#include "tests/support/golden.h"

namespace traverse::gcode {
namespace {

using ::testing::UnorderedElementsAreArray;

struct Expected {
  std::string file;
  std::string slicer;
  std::set<Feature> features;
  double movable = 0.7;  // share of paths, under safe
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.file; }

const std::set<Feature> kWallsAndInfill = {Feature::kOuterWall, Feature::kInnerWall,
                                           Feature::kSparseInfill};
const std::set<Feature> kWallsAndSkin = {Feature::kOuterWall, Feature::kInnerWall,
                                         Feature::kSolidInfill};
const std::set<Feature> kUnnamed = {Feature::kLoop, Feature::kInnerWall, Feature::kLine};

const Expected kDialects[] = {
    {"prusaslicer", "PrusaSlicer 2.9.2", kWallsAndInfill},
    {"superslicer", "SuperSlicer 2.3.56", kWallsAndInfill},
    {"orcaslicer", "OrcaSlicer 2.3.1", kWallsAndInfill},
    {"bambustudio", "BambuStudio 02.04.00.70", kWallsAndSkin, 0.6},
    {"cura5", "Cura_SteamEngine 5.13.0", kWallsAndSkin},
    {"ideamaker", "ideaMaker 4.2.0.5250", kWallsAndSkin},
    {"simplify3d", "Simplify3D(R) Version 4.0.0", kWallsAndInfill},
    {"kisslicer", "KISSlicer - FREE", kWallsAndInfill},
    {"flashprint",
     "ffslicer 1.30.3 03/01/26 10:00:00",
     {Feature::kLoop, Feature::kInnerWall, Feature::kSparseInfill}},
    {"icesl", "IceSL Sep  8 2021 17:53:41", kUnnamed},
    {"kirimoto", "Kiri:Moto 3.7", kUnnamed},
    {"canvas", "Canvas 1.4.2", kWallsAndInfill},
};

class DialectFile : public ::testing::TestWithParam<Expected> {
 protected:
  void SetUp() override {
    text_ = testing::TextOf(
        traverse::testing::DataPath("gcode/dialects/" + GetParam().file + ".gcode"));
    const auto file = ReadGcode(text_, GetParam().file);
    ASSERT_TRUE(file.ok()) << file.status();
    file_ = *file;
  }

  // Height of travel in XY with filament pulled back above what is printed next to it; the least.
  static double LeastLift(const std::string& text);

  std::string text_;
  std::shared_ptr<GcodeFile> file_;
};

double DialectFile::LeastLift(const std::string& text) {
  const auto file = *ReadGcode(text, "x");
  double least = 1e9;
  for (size_t i = 1; i < file->blocks.size(); ++i) {
    const Block& block = file->blocks[i];
    const bool inside = block.first.z == file->blocks[i - 1].last.z;
    if (!inside || (block.link & kLinkRetracts) == 0) continue;
    least = std::min(least, ToDouble(block.lift));
  }
  return least;
}

TEST_P(DialectFile, IsKnownByNameWithItsFeatures) {
  std::set<Feature> features;
  for (const Layer& layer : file_->layers) {
    for (const Outline& outline : OutlinesOf(*file_, layer)) features.insert(outline.feature);
  }
  features.erase(Feature::kLine);
  std::set<Feature> expected = GetParam().features;
  expected.erase(Feature::kLine);

  EXPECT_EQ(file_->slicer.name, GetParam().slicer);
  EXPECT_THAT(features, UnorderedElementsAreArray(expected));
}

TEST_P(DialectFile, MostPathsMayMove) {
  int64_t movable = 0;
  for (const Layer& layer : file_->layers) {
    movable += MakeLayerPlan(*file_, layer, Policy::kSafe).movable;
  }

  EXPECT_GE(static_cast<double>(movable),
            GetParam().movable * static_cast<double>(file_->blocks.size()));
}

TEST_P(DialectFile, PrintsTheSameInOtherOrders) {
  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    for (uint64_t seed = 1; seed <= 5; ++seed) {
      const std::string shuffled = testing::Shuffled(*file_, policy, seed);
      EXPECT_EQ(VerifyGcode(text_, "original", shuffled, "shuffled", OnlySamePrint()).message(), "")
          << PolicyName(policy) << " seed " << seed;
    }
  }
}

// Whether it lifts by a move of Z, a slope, or a spiral: new travel moves are as high above the
// layer.
TEST_P(DialectFile, LiftsAsHighInOtherOrders) {
  const double least = LeastLift(text_);
  if (!(least > 0) || least > 1e6) GTEST_SKIP() << "does not lift";
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_GE(LeastLift(testing::Shuffled(*file_, Policy::kFree, seed)), least) << "seed " << seed;
  }
}

// Nothing of a start script is copied, and nothing is set and set back without a move.
TEST_P(DialectFile, TravelsComeFromThePartItself) {
  const auto count = [](const std::string& text, const std::string& what) {
    size_t n = 0;
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++n;
    return n;
  };
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    const std::string shuffled = testing::Shuffled(*file_, Policy::kFree, seed);
    EXPECT_EQ(count(shuffled, "E0.2\n"), count(text_, "E0.2\n")) << "seed " << seed;
    EXPECT_EQ(count(shuffled, "M204 S1500\nM204 S900\n"), 0u) << "seed " << seed;
    // CuraEngine's wipe of outer walls.
    EXPECT_EQ(count(shuffled, "G0 F9000 "), count(text_, "G0 F9000 ")) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Today, DialectFile, ::testing::ValuesIn(kDialects),
                         [](const auto& info) { return info.param.file; });

}  // namespace
}  // namespace traverse::gcode
