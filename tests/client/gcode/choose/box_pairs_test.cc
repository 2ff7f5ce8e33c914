#include "client/gcode/choose/box_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace traverse::gcode {
namespace {

using Pairs = std::vector<std::pair<uint32_t, uint32_t>>;

BoundingBox Box(double x, double y, double width, double height) {
  BoundingBox box;
  box.Add(Point{x, y});
  box.Add(Point{x + width, y + height});
  return box;
}

Pairs Sorted(Pairs pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

Pairs EachWithEach(const std::vector<BoundingBox>& a, const std::vector<BoundingBox>& b) {
  Pairs pairs;
  for (uint32_t i = 0; i < a.size(); ++i) {
    for (uint32_t j = 0; j < b.size(); ++j) {
      if (!a[i].empty() && !b[j].empty() && a[i].DistanceTo(b[j]) == 0) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

TEST(OverlappingBoxes, AreThoseOfEachWithEach) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> place(0, 40);
  for (const int most : {0, 3, 60}) {
    std::uniform_int_distribution<int> size(0, most);
    const auto boxes = [&](int count) {
      std::vector<BoundingBox> made(3);  // empty ones
      for (int i = 0; i < count; ++i) {
        made.push_back(Box(place(random), place(random), size(random), size(random)));
      }
      return made;
    };
    for (const int count : {0, 1, 50, 200}) {
      const std::vector<BoundingBox> a = boxes(count);
      const std::vector<BoundingBox> b = boxes(100);
      EXPECT_EQ(Sorted(OverlappingBoxes(a, b)), EachWithEach(a, b)) << most << " " << count;
      EXPECT_EQ(Sorted(OverlappingBoxes(b, a)), EachWithEach(b, a)) << most << " " << count;
    }
  }
}

TEST(OverlappingBoxes, TouchingIsEnough) {
  EXPECT_EQ(OverlappingBoxes({Box(0, 0, 1, 1)}, {Box(1, 1, 1, 1)}), (Pairs{{0, 0}}));
  EXPECT_TRUE(OverlappingBoxes({Box(0, 0, 1, 1)}, {Box(1.001, 1, 1, 1)}).empty());
}

// Each with each of these would take minutes.
TEST(OverlappingBoxes, LargeLayersTakeNoTimeWorthSpeakingOf) {
  constexpr int kBoxes = 200'000;
  const int side = static_cast<int>(std::sqrt(kBoxes));
  std::vector<BoundingBox> plate;   // beside each other, and one around them
  std::vector<BoundingBox> column;  // one above the other, as wide as the plate
  for (int i = 0; i < kBoxes; ++i) {
    plate.push_back(Box(i % side, i / side, 0.9, 0.9));
    column.push_back(Box(0, i * 0.001, side, 0.0009));
  }
  plate.push_back(Box(0, 0, side, side));

  EXPECT_EQ(OverlappingBoxes(plate, plate).size(), 3 * kBoxes + 1);
  EXPECT_EQ(OverlappingBoxes(column, column).size(), kBoxes);
}

}  // namespace
}  // namespace traverse::gcode
