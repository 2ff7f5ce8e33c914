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

TEST(Progress, BarShowsLayersGainAndTimeLeft) {
  Progress progress(Progress::Style::kBar, "tabu", 4);
  EXPECT_EQ(progress.Text(absl::Seconds(1), 40), "tabu  [---------------------] 0/4 layers");
  progress.Take(Layer(100, 70));

  EXPECT_EQ(progress.Text(absl::Seconds(10), 70),
            "tabu  [#####---------------] 1/4 layers, travel 30.0 % less, 30 s left");
  EXPECT_EQ(progress.Text(absl::Seconds(10), 30), "tabu  1/4 layers, travel 30.0 ");
}

TEST(Progress, TimeLeftGoesByWorkAndByWhatFollows) {
  Progress progress(Progress::Style::kLines, "auto", 3);
  progress.Expect({{10, 10, 80}, 2});
  v1::LayerResult layer = Layer(0, 0);
  progress.Take(layer);
  // A tenth in 2 s: 20 s in all, and two stages as long.
  EXPECT_EQ(progress.Text(absl::Seconds(2), 80), "auto: 1/3 layers, 58 s left");
}

TEST(Progress, TellsNoTimeLeftAfterASmallLayerAlone) {
  Progress progress(Progress::Style::kLines, "auto", 3);
  progress.Expect({{1, 500, 499}, 2});
  progress.Take(Layer(0, 0));

  EXPECT_EQ(progress.Text(absl::Seconds(13), 80), "auto: 1/3 layers");
}

TEST(Progress, LinesHaveNoBar) {
  Progress progress(Progress::Style::kLines, "tabu", 2);
  progress.Take(Layer(0, 0));

  EXPECT_EQ(progress.Text(absl::Seconds(10), 80), "tabu: 1/2 layers, 10 s left");
}

}  // namespace
}  // namespace traverse::cli
