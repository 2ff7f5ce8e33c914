#include "client/report/reductions.h"

#include <optional>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/report/numbers.h"

namespace traverse::report {
namespace {

constexpr size_t kLabelWidth = 20;

constexpr char kAllPoints[] = "points_entries";

// A column: the name of the statistic, and what it reduces.
struct Reduction {
  const char* title;
  const char* name;
  const char* of;
};
constexpr Reduction kReductions[] = {{"island analysis", "points_island_analysis", kAllPoints},
                                     {"SP", "points_sp", kAllPoints},
                                     {"NRP", "points_nrp", kAllPoints},
                                     {"BBCP", "points_bbcp", kAllPoints},
                                     {"VP", "points_vp", "points_sp"}};

// The mean over the layers that have the statistic; unset if there are none.
std::optional<double> MeanStatistic(const ComparedStrategy& strategy, const char* name) {
  double sum = 0;
  int layers = 0;
  for (const JobRun& run : strategy.runs) {
    for (const v1::LayerResult& layer : run.result.layers) {
      const auto found = layer.statistics().find(name);
      if (found == layer.statistics().end()) continue;
      sum += found->second;
      ++layers;
    }
  }
  if (layers == 0) return std::nullopt;
  return sum / layers;
}

Cell ReductionCell(const ComparedStrategy& strategy, const Reduction& reduction) {
  const std::optional<double> left = MeanStatistic(strategy, reduction.name);
  const std::optional<double> before = MeanStatistic(strategy, reduction.of);
  if (!left || !before) return Cell{};
  return Cell{absl::StrFormat("%.0f (-%.1f %%)", *left, GainPercent(*before, *left))};
}

}  // namespace

std::string ReductionTable(const std::vector<ComparedStrategy>& strategies,
                           const TextStyle& style) {
  std::vector<std::string> header = {"strategy", "points"};
  for (const Reduction& reduction : kReductions) header.push_back(reduction.title);
  Table table(std::move(header));
  bool empty = true;
  for (const ComparedStrategy& strategy : strategies) {
    const std::optional<double> all = MeanStatistic(strategy, kAllPoints);
    if (!all) continue;
    empty = false;
    std::vector<Cell> row = {Cell{strategy.label}, Cell{absl::StrFormat("%.0f", *all)}};
    for (const Reduction& reduction : kReductions) {
      row.push_back(ReductionCell(strategy, reduction));
    }
    table.AddFolded(std::move(row), kLabelWidth);
  }
  if (empty) return "";
  return "\n"
         "contour points per layer, and those that each reduction leaves (VP: of SP)\n" +
         table.Text(style);
}

}  // namespace traverse::report
