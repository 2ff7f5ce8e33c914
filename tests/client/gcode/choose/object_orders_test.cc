// client/gcode/choose/object_orders.h

#include "client/gcode/choose/object_orders.h"

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_format.h"
#include "client/gcode/read/reader.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

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
