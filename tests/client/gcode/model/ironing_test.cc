// Ironing that is named as skin: client/gcode/model/ironing.h.

#include "client/gcode/model/ironing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/gcode/model/loops.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

// A layer of 0.2 mm with a long wall that is 0.4 mm wide, and then skin; paths that part by travel.
class CuraLayer {
 public:
  explicit CuraLayer(double wall_share = 1) {
    Path({{0, 50}, {1000, 50}}, wall_share);
    text_ += ";TYPE:SKIN\n";
  }

  // A path through the points, with `share` of the flow of a wall.
  CuraLayer& Path(const std::vector<Point>& points, double share) {
    constexpr double kFlow = 0.4 * 0.2 / 2.40528;  // of filament of 1.75 mm
    absl::StrAppend(&text_, "G0 F9000 X", points[0].x, " Y", points[0].y, "\nG1 F1800");
    for (size_t k = 1; k < points.size(); ++k) {
      absl::StrAppendFormat(&text_, "%s X%.3f Y%.3f E%.7f\n", k > 1 ? "G1" : "", points[k].x,
                            points[k].y, kFlow * share * Distance(points[k - 1], points[k]));
    }
    return *this;
  }

  CuraLayer& Line(double y, double share) { return Path({{0, y}, {10, y}}, share); }

  // Lines as long as `size`, each as far from the one before it as `spacing`, and how they join.
  CuraLayer& Zigzag(double size, double spacing, double share) {
    std::vector<Point> points;
    for (int k = 0; k * spacing < size; ++k) {
      points.push_back({20 + (k % 2 == 0 ? 0 : size), 20 + k * spacing});
      points.push_back({20 + (k % 2 == 0 ? size : 0), 20 + k * spacing});
    }
    return Path(points, share);
  }

  // The features behind the first wall.
  std::vector<Feature> Features() const {
    const auto file = testing::Read(text_);
    std::vector<Feature> features;
    for (const Outline& outline : OutlinesOf(*file, file->layers.front())) {
      features.push_back(outline.feature);
    }
    features.erase(features.begin());
    return features;
  }

 private:
  std::string text_ =
      ";Generated with Cura_SteamEngine 5.13.0\nM83\n;LAYER:0\nG0 F9000 Z0.2\n;TYPE:WALL-OUTER\n";
};

TEST(Ironing, IsToldByHowLittleOfItsRoomItFills) {
  for (const double size : {0.5, 1.0, 3.0, 20.0}) {
    for (const double spacing : {0.1, 0.2, 0.4}) {
      // Of the lines of 0.4 mm that fill the layer, lines at 0.1 mm have a quarter.
      const double whole = spacing / 0.4;
      for (const double flow : {0.03, 0.1, 0.3, 0.5}) {
        EXPECT_THAT(CuraLayer().Zigzag(size, spacing, flow * whole).Features(),
                    ElementsAre(Feature::kIroning))
            << size << " " << spacing << " " << flow;
      }
      if (size < 3) continue;
      EXPECT_THAT(CuraLayer().Zigzag(size, spacing, whole).Features(),
                  ElementsAre(Feature::kSolidInfill))
          << size << " " << spacing;
    }
  }
}

TEST(Ironing, OfOneLineIsToldToo) {
  EXPECT_THAT(CuraLayer().Line(0, 1).Line(0.4, 1).Line(0.2, 0.025).Features(),
              ElementsAre(Feature::kSolidInfill, Feature::kSolidInfill, Feature::kIroning));
}

// Each on a travel move of its own.
TEST(Ironing, OfLinesByThemselvesIsToldByThoseBesideThem) {
  CuraLayer thin;
  CuraLayer iron;
  for (int k = 0; k < 8; ++k) {
    thin.Line(0.2 * k, 0.5);
    iron.Line(0.4 * k, 0.5);
  }
  EXPECT_THAT(thin.Features(), Each(Feature::kSolidInfill));
  EXPECT_THAT(iron.Features(), Each(Feature::kIroning));
}

TEST(Ironing, IsNoSkinWhoseLinesAreAlmostAsWideAsWalls) {
  EXPECT_THAT(CuraLayer().Line(0, 0.7).Line(5, 1.3).Line(9, 1).Features(),
              Each(Feature::kSolidInfill));
}

// A wall of so much filament that lines as thick would be far apart: a number of the file.
TEST(Ironing, IsLookedForNoFartherThanLinesAreWide) {
  const auto mark = [](int size) {
    CuraLayer layer(std::pow(size, 4));
    for (int line = 0; line < 1400; ++line) layer.Line(20 * line, 0.1);
    EXPECT_EQ(layer.Features().size(), 1400u);
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(2, mark), traverse::testing::kSlowGrowth);
}

}  // namespace
}  // namespace traverse::gcode
