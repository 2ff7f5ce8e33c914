#include "client/report/compare.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/report/numbers.h"

namespace traverse::report {
namespace {

constexpr int kLeastBar = 10;
constexpr int kMostBar = 30;

// Columns of a label where there is room, and where there is none.
constexpr size_t kWholeLabel = 1000;
constexpr size_t kFoldedLabel = 20;

using Value = std::function<double(const JobRun&)>;

double TravelMm(const JobRun& run) {
  return run.result.summary.travel().total_mm() + run.result.summary.cleaning_mm();
}

double GivenMm(const JobRun& run) {
  return run.result.summary.given().total_mm() + run.result.summary.cleaning_given_mm();
}

double Seconds(const JobRun& run) { return run.result.summary.cost(); }

double GivenSeconds(const JobRun& run) { return run.result.summary.cost_given(); }

double Mean(const ComparedStrategy& strategy, const Value& value) {
  double sum = 0;
  for (const JobRun& run : strategy.runs) sum += value(run);
  return sum / static_cast<double>(strategy.runs.size());
}

// Standard deviation of the sample.
double DeviationOf(const ComparedStrategy& strategy, const Value& value) {
  const double mean = Mean(strategy, value);
  double sum = 0;
  for (const JobRun& run : strategy.runs) sum += std::pow(value(run) - mean, 2);
  const size_t n = strategy.runs.size();
  return n > 1 ? std::sqrt(sum / static_cast<double>(n - 1)) : 0;
}

// In percent, if every run has a bound.
std::string Gap(const ComparedStrategy& strategy) {
  double sum = 0;
  for (const JobRun& run : strategy.runs) {
    const v1::JobSummary& summary = run.result.summary;
    if (!summary.has_lower_bound()) return "";
    if (summary.cost() > 0) sum += 100 * (summary.cost() - summary.lower_bound()) / summary.cost();
  }
  return absl::StrFormat("%.1f", sum / static_cast<double>(strategy.runs.size()));
}

// One column. Columns with the highest `rank` are dropped first if there is no room.
struct Column {
  std::string title;
  int rank = 0;
  std::function<Cell(const ComparedStrategy&)> cell;
};

// The columns for `strategies`, without the bar.
class Columns {
 public:
  Columns(const std::vector<ComparedStrategy>& strategies, CompareBy by)
      : strategies_(strategies),
        by_time_(by == CompareBy::kTime),
        value_(by_time_ ? Seconds : TravelMm),
        given_(by_time_ ? GivenSeconds : GivenMm) {
    columns_.push_back({"strategy", 0, [this](const auto& s) {
                          return Cell{FoldAtColons(s.label, label_width_)[0]};
                        }});
    AddCompared();
    if (by_time_) {
      columns_.push_back({"travel mm", 3, [](const ComparedStrategy& s) {
                            return Cell{absl::StrFormat("%.2f", Mean(s, TravelMm))};
                          }});
    }
    AddSplit();
    if (!by_time_) {
      AddMean("idle s", 3, 1, [](const v1::JobSummary& s) { return s.idle_seconds(); });
    }
    AddGain("none %", given_);
    AddGainOver("greedy");
    AddGainOver("ni2opt");
    if (Any([](const auto& s) { return !Gap(s).empty(); })) {
      columns_.push_back({"gap %", 0, [](const auto& s) { return Cell{Gap(s)}; }});
    }
    columns_.push_back({"seconds", 0, [](const auto& s) {
                          return Cell{absl::StrFormat(
                              "%.3f", Mean(s, [](const JobRun& run) { return run.wall_seconds; }))};
                        }});
  }

  Columns(const Columns&) = delete;

  // Folds labels and drops columns, the highest ranks first, until the rest takes at most `width`.
  void Fit(int width) {
    if (Width() > width) label_width_ = kFoldedLabel;
    for (int rank = 3; rank > 0 && Width() > width; --rank) {
      std::erase_if(columns_, [&](const Column& column) { return column.rank == rank; });
    }
  }

  // Columns of text that the table takes without a bar.
  int Width() const {
    size_t width = 0;
    for (const Column& column : columns_) {
      size_t widest = TextWidth(column.title);
      for (const auto& strategy : strategies_) {
        widest = std::max(widest, TextWidth(column.cell(strategy).text));
      }
      width += widest + 2;
    }
    return static_cast<int>(width);
  }

  // The share of what was given that is gone.
  double GainOf(const ComparedStrategy& strategy) const {
    return GainPercent(Mean(strategy, given_), Mean(strategy, value_)) / 100;
  }

  const std::vector<Column>& list() const { return columns_; }
  size_t label_width() const { return label_width_; }

 private:
  template <typename Condition>
  bool Any(Condition condition) const {
    return std::any_of(strategies_.begin(), strategies_.end(), condition);
  }

  void AddCompared() {
    double least = Mean(strategies_.front(), value_);
    for (const auto& strategy : strategies_) least = std::min(least, Mean(strategy, value_));
    columns_.push_back(
        {by_time_ ? "travel s" : "travel mm", 0, [this, least](const ComparedStrategy& s) {
           const double mean = Mean(s, value_);
           return Cell{absl::StrFormat("%.2f", mean), mean <= least ? Color::kGood : Color::kNone};
         }});
    if (Any([](const auto& s) { return s.runs.size() > 1; })) {
      columns_.push_back({by_time_ ? "+- s" : "+- mm", 0, [this](const auto& s) {
                            return Cell{absl::StrFormat("%.2f", DeviationOf(s, value_))};
                          }});
    }
  }

  void AddSplit() {
    AddMean("contours", 2, 2, [](const v1::JobSummary& s) { return s.travel().contours_mm(); });
    AddMean("rasters", 2, 2, [](const v1::JobSummary& s) { return s.travel().rasters_mm(); });
    AddMean("links", 2, 2, [](const v1::JobSummary& s) { return s.travel().links_mm(); });
    if (Any([](const auto& s) { return s.runs[0].result.summary.cleaning_mm() > 0; })) {
      AddMean("cleaning", 2, 2, [](const v1::JobSummary& s) { return s.cleaning_mm(); });
    }
  }

  void AddMean(std::string title, int rank, int digits,
               std::function<double(const v1::JobSummary&)> value) {
    columns_.push_back(
        {std::move(title), rank, [digits, value = std::move(value)](const ComparedStrategy& s) {
           const auto of_run = [&](const JobRun& run) { return value(run.result.summary); };
           return Cell{absl::StrFormat("%.*f", digits, Mean(s, of_run))};
         }});
  }

  // The gain over a length that each row has of its own, or over the mean of another row.
  void AddGain(std::string title, const Value& before) {
    columns_.push_back(
        {std::move(title), 0, [this, before](const ComparedStrategy& s) {
           const double gain = GainPercent(Mean(s, before), Mean(s, value_));
           return Cell{absl::StrFormat("%.1f", gain), gain < 0 ? Color::kBad : Color::kNone};
         }});
  }
  void AddGainOver(const std::string& label) {
    for (const ComparedStrategy& strategy : strategies_) {
      if (strategy.label != label) continue;
      const double before = Mean(strategy, value_);
      AddGain(label + " %", [before](const JobRun&) { return before; });
      return;
    }
  }

  const std::vector<ComparedStrategy>& strategies_;
  const bool by_time_;
  const Value value_;
  const Value given_;
  size_t label_width_ = kWholeLabel;
  std::vector<Column> columns_;
};

}  // namespace

CompareBy CompareByOf(const v1::JobOptions& options) {
  return options.cost().has_time() ? CompareBy::kTime : CompareBy::kLength;
}

double ComparedValue(const JobRun& run, CompareBy by) {
  return by == CompareBy::kTime ? Seconds(run) : TravelMm(run);
}

std::string CompareTable(const std::vector<ComparedStrategy>& strategies, const TextStyle& style,
                         CompareBy by) {
  assert(std::all_of(strategies.begin(), strategies.end(),
                     [](const ComparedStrategy& one) { return !one.runs.empty(); }));
  Columns columns(strategies, by);
  columns.Fit(style.width);
  const int bar = std::min(style.width - columns.Width(), kMostBar);
  const bool with_bar = bar >= kLeastBar;

  std::vector<std::string> header;
  for (const Column& column : columns.list()) header.push_back(column.title);
  if (with_bar) header.push_back("gain");
  Table table(std::move(header));
  if (with_bar) table.SetLastLeft();
  for (const ComparedStrategy& strategy : strategies) {
    std::vector<Cell> row;
    for (const Column& column : columns.list()) row.push_back(column.cell(strategy));
    if (with_bar) row.push_back({Bar(columns.GainOf(strategy), bar, style), Color::kBar});
    row[0].text = strategy.label;
    table.AddFolded(std::move(row), columns.label_width());
  }
  return table.Text(style);
}

}  // namespace traverse::report
