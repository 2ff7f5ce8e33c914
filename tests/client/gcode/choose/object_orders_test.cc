// client/gcode/choose/object_orders.h

#include "client/gcode/choose/object_orders.h"

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_format.h"
#include "client/gcode/read/reader.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

// The label of the last object of a layer holds in the next one, unless it ends first.
TEST(ObjectOrders, OneThatGoesOnInAnotherLayerStays) {
  for (const std::string& between : {std::string(), std::string(";MESH:NONMESH\n;MESH:b\n")}) {
    std::string text = "M83\nG1 Z.2 F9000\n;MESH:a\nG1 X0 Y0\nG1 X.5 E1\n;MESH:NONMESH\nG1 Z.4\n";
    for (const char* x : {"1", "9", "5"}) {
      text += absl::StrFormat(";MESH:%c\nG1 X%s Y0\nG1 X%s.5 E1\n", 'a' + (x[0] - '1') / 4, x, x);
    }
    text += between + "G1 Z.6\nG1 X6\nG1 X5 E1\n;MESH:c\nG1 X9\nG1 X8 E1\n;MESH:NONMESH\n";
    const auto file = ReadGcode(text, "part.gcode");
    ASSERT_TRUE(file.ok()) << file.status();
    LayerFreedom freedom;
    freedom.island = {0, 1, 2};
    freedom.rules.resize(3);

    const LayerObjects found = ObjectOrders(**file).ObjectsOf((*file)->layers[1], freedom);

    ASSERT_EQ(found.runs.size(), 1u);
    EXPECT_EQ(found.runs[0].size(), between.empty() ? 2u : 3u);
    EXPECT_EQ(found.barrier.empty(), !between.empty());
  }
}

// A row of objects, every third of which touches the one three before it.
TEST(ObjectOrders, ThousandsThatTouchTakeNoLongerEach) {
  const auto move = [](int objects) {
    std::string text = "M83\nG1 Z.2 F9000\n";
    LayerFreedom freedom;
    for (int i = 0; i < objects; ++i) {
      const int x = i * 7919 % objects;
      text += absl::StrFormat(
          "EXCLUDE_OBJECT_START NAME=part_%d\nG1 X%d Y9\nG1 X%d.5 E1\n"
          "EXCLUDE_OBJECT_END NAME=part_%d\n",
          i, x, x, i);
      freedom.island.push_back(i % 3 == 0 ? 0u : static_cast<uint32_t>(i));
    }
    freedom.rules.resize(freedom.island.size());
    freedom.rules.front().pinned = freedom.rules.back().pinned = true;  // beside scripts
    const auto file = ReadGcode(text, "part.gcode");
    ASSERT_TRUE(file.ok()) << file.status();
    const Layer& layer = (*file)->layers.front();
    LayerOrder order;
    for (uint32_t i = layer.first_block; i < layer.end_block; ++i) order.push_back({i, 0, false});
    const ObjectOrders orders(**file);

    const std::vector<LayerOrder> moved =
        orders.Moved(layer, orders.ObjectsOf(layer, freedom), order, false);

    ASSERT_FALSE(moved.empty());
    uint32_t last = 0;
    for (const auto& visit : moved.front()) {
      const uint32_t path = visit.block - layer.first_block;
      if (freedom.island[path] != 0) continue;
      ASSERT_LE(last, path);
      last = path;
    }
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(1000, move), traverse::testing::kSlowGrowth);
}

}  // namespace
}  // namespace traverse::gcode
