// What `fast` would save is about what it then saves: client/gcode/choose/fast_forecast.h.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/gcode/rewrite.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/stack.h"

namespace traverse::gcode {
namespace {

using testing::Stack;

std::shared_ptr<GcodeFile> Print(int layers, bool boxes) {
  Stack stack;
  for (int i = 1; i <= layers; ++i) {
    stack.Layer(0.2 * i);
    for (const double x : {0.0, 30.0, 60.0}) {
      boxes ? stack.Box(x, 0, 20) : stack.Wall(x, 0, 20);
    }
  }
  return testing::Read(stack.Text() + "; slow_down_layer_time = 0\n");
}

// Each layer backwards but for its ends, which the search has to mend.
FileOrder Backwards(const GcodeFile& file) {
  FileOrder orders;
  for (const Layer& layer : file.layers) {
    LayerOrder& order = orders.emplace_back();
    for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
      order.push_back({b, 0, (b - layer.first_block) % 4 == 0});
    }
    std::reverse(order.begin() + 1, order.end() - 1);
  }
  return orders;
}

GcodeRewrite Rewritten(const GcodeFile& file, Policy policy, const FileOrder& orders) {
  RewriteOptions options;
  options.policy = policy;
  options.polish = PolishLimit{};
  options.forecast_fast = true;
  auto rewrite = RewriteGcode(file, orders, options);
  EXPECT_TRUE(rewrite.ok()) << rewrite.status();
  return *std::move(rewrite);
}

GcodeRewrite Rewritten(const GcodeFile& file, Policy policy) {
  return Rewritten(file, policy, Backwards(file));
}

TEST(FastForecast, IsAboutWhatFastSaves) {
  for (const int layers : {5, 40}) {
    const std::shared_ptr<GcodeFile> file = Print(layers, /*boxes=*/true);
    const GcodeRewrite fast = Rewritten(*file, Policy::kFast);
    const double saved = fast.before.seconds - fast.after.seconds;
    ASSERT_GT(saved, 0.01 * fast.before.seconds);
    const GcodeRewrite safe = Rewritten(*file, Policy::kSafe);
    EXPECT_NEAR(safe.fast_seconds / saved, 1, 0.12) << layers;
    EXPECT_NE(DescribeFast(safe).find("--policy=fast would save about "), std::string::npos);
    EXPECT_EQ(fast.fast_seconds, 0);
    EXPECT_EQ(DescribeFast(fast), "");
  }
}

// Pillars in a row, each second layer of which is best printed on the way back.
TEST(FastForecast, KnowsThatIslandsNeedNoRestThen) {
  Stack stack;
  for (int layer = 1; layer <= 12; ++layer) {
    stack.Layer(0.2 * layer);
    for (int i = 0; i < 5; ++i) stack.Wall(30 * i, 0, 5);
  }
  const auto file = testing::Read(stack.Text() + "; slow_down_layer_time = 60\n");
  FileOrder orders;
  for (const Layer& layer : file->layers) {
    LayerOrder& order = orders.emplace_back();
    for (uint32_t b = layer.first_block; b < layer.end_block; ++b) order.push_back({b});
    if (orders.size() % 2 == 0) std::reverse(order.begin(), order.end());
  }

  const GcodeRewrite safe = Rewritten(*file, Policy::kSafe, orders);
  const GcodeRewrite fast = Rewritten(*file, Policy::kFast, orders);

  const double saved = fast.before.seconds - fast.after.seconds;
  ASSERT_GT(saved, 2 * (safe.before.seconds - safe.after.seconds));
  EXPECT_NEAR(safe.fast_seconds / saved, 1, 0.3);
}

TEST(FastForecast, LooksAtThreeLayersOfAFewThatDiffer) {
  Stack stack;
  for (int layer = 1; layer <= 6; ++layer) {
    stack.Layer(0.2 * layer);
    for (const double x : {0.0, 30.0, 60.0}) {
      layer % 3 == 0 ? stack.Box(x, 0, 20) : stack.Wall(x, 0, 20).Wall(x + 5, 5, 10);
    }
  }
  const auto file = testing::Read(stack.Text() + "; slow_down_layer_time = 0\n");

  const GcodeRewrite safe = Rewritten(*file, Policy::kSafe);
  const GcodeRewrite fast = Rewritten(*file, Policy::kFast);

  const double saved = fast.before.seconds - fast.after.seconds;
  ASSERT_GT(saved, 0.01 * fast.before.seconds);
  EXPECT_NEAR(safe.fast_seconds / saved, 1, 0.3);
}

TEST(FastForecast, PromisesNothingWhereNothingIsHidden) {
  for (const int layers : {1, 2, 20}) {
    const GcodeRewrite safe = Rewritten(*Print(layers, /*boxes=*/layers < 3), Policy::kSafe);
    EXPECT_EQ(DescribeFast(safe), "") << layers << " " << safe.fast_seconds;
  }
}

TEST(FastForecast, PromisesNothingOfAPrintThatTakesNoTime) { EXPECT_EQ(DescribeFast({}), ""); }

}  // namespace
}  // namespace traverse::gcode
