#include "client/cli/progress.h"

#include <gtest/gtest.h>

namespace traverse::cli {
namespace {

v1::LayerResult Layer(double given, double travel) {
  v1::LayerResult layer;
  layer.mutable_given()->set_total_mm(given);
  layer.mutable_travel()->set_total_mm(travel);
  return layer;
}

// So many layers alike, and nothing behind them.
SearchWork Alike(size_t layers) { return {std::vector<double>(layers, 1)}; }

TEST(Progress, BarShowsLayersGainAndTimeLeft) {
  Progress progress(Progress::Style::kBar, "tabu", Alike(4));
  EXPECT_EQ(progress.Text(absl::Seconds(1), 40), "tabu  [---------------------] 0/4 layers");
  progress.Take(Layer(100, 70), absl::Seconds(4));
  EXPECT_EQ(progress.Text(absl::Seconds(4), 70),
            "tabu  [#######------------------------] 1/4 layers, travel 30.0 % less");
  progress.Take(Layer(100, 70), absl::Seconds(7));

  EXPECT_EQ(progress.Text(absl::Seconds(7), 70),
            "tabu  [#########----------] 2/4 layers, travel 30.0 % less, 6.0 s left");
  EXPECT_EQ(progress.Text(absl::Seconds(7), 30), "tabu  2/4 layers, travel 30.0 ");
}

// Layers are searched side by side until the first one is done, here for 20 s; then a tenth of the
// work takes 2 s. So the search takes 38 s, and two stages behind it as long again.
TEST(Progress, TimeLeftGoesByWorkSinceTheFirstLayerAndByWhatFollows) {
  Progress progress(Progress::Style::kLines, "auto", {{10, 10, 80}, 2});
  progress.Take(Layer(0, 0), absl::Seconds(20));
  progress.Take(Layer(0, 0), absl::Seconds(22));
  EXPECT_EQ(progress.Text(absl::Seconds(22), 80), "auto: 2/3 layers, 1 min 32 s left");
}

// The same, and what follows takes a minute more.
TEST(Progress, WhatFollowsMayTakeSomeTimeWhateverSearchesTake) {
  Progress progress(Progress::Style::kLines, "auto", {{10, 10, 80}, 0.5, 60});
  progress.Take(Layer(0, 0), absl::Seconds(20));
  progress.Take(Layer(0, 0), absl::Seconds(22));
  EXPECT_EQ(progress.Text(absl::Seconds(22), 80), "auto: 2/3 layers, 1 min 35 s left");
}

TEST(Progress, TellsNoTimeLeftAfterASmallLayerAlone) {
  Progress progress(Progress::Style::kLines, "auto", {{500, 1, 499}, 2});
  progress.Take(Layer(0, 0), absl::Seconds(12));
  v1::LayerResult small = Layer(0, 0);
  small.set_index(1);
  progress.Take(small, absl::Seconds(13));

  EXPECT_EQ(progress.Text(absl::Seconds(13), 80), "auto: 2/3 layers");
}

TEST(Progress, LinesHaveNoBar) {
  Progress progress(Progress::Style::kLines, "tabu", Alike(3));
  progress.Take(Layer(0, 0), absl::ZeroDuration());
  progress.Take(Layer(0, 0), absl::Seconds(10));

  EXPECT_EQ(progress.Text(absl::Seconds(10), 80), "tabu: 2/3 layers, 10 s left");
}

}  // namespace
}  // namespace traverse::cli
