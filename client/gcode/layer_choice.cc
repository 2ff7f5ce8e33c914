#include "client/gcode/layer_choice.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "client/gcode/parallel.h"

namespace traverse::gcode {
namespace {

// Rounding of sums of lengths.
constexpr double kSlackMm = 1e-6;

constexpr double kNever = std::numeric_limits<double>::infinity();

// A second of print time is worth this much travel: between orders that take the same time the
// shorter one is better.
constexpr double kSecondsPerMm = 1e-6;

double Score(const PrintTotals& totals) {
  return totals.seconds + kSecondsPerMm * totals.travel_mm;
}

// One order of a layer.
struct Choice {
  LayerOrder order;
  PrintTotals inside;  // its paths and the ways between them
  PartStart behind;
};

// A layer and what it may be. choices[0] is the order of the file.
struct Column {
  std::unique_ptr<const LayerWriter> writer;
  std::vector<Choice> choices;
  std::vector<PrintTotals> ways;  // [before * choices.size() + choice] from the layer before
  std::vector<double> score;      // [choice] of the best row up to here
  std::vector<uint32_t> from;     // [choice] the layer before in that row
  uint32_t chosen = 0;
};

class Chooser {
 public:
  Chooser(const GcodeFile& file, const std::vector<FileOrder>& tries, Policy policy, int threads)
      : file_(file),
        tries_(tries),
        policy_(policy),
        threads_(threads),
        habit_(LearnRetraction(file)),
        donors_(file),
        columns_(file.layers.size()) {}

  ChosenLayers Choose() {
    ParallelFor(columns_.size(), threads_, [this](size_t layer) { FillColumn(layer); });
    ParallelFor(columns_.size() - 1, threads_, [this](size_t i) { FillWays(i + 1); });
    for (size_t layer = 0; layer < columns_.size(); ++layer) Extend(layer);
    Trace();
    return Write();
  }

 private:
  void AddChoice(LayerOrder order, Column& column) const {
    for (const Choice& known : column.choices) {
      if (known.order == order) return;
    }
    Choice& choice = column.choices.emplace_back();
    choice.order = std::move(order);
    std::string text;
    const PartStart start = StartOfPaths(file_, choice.order.front());
    choice.behind = column.writer->WritePaths(choice.order, start, text);
    choice.inside = Measure(file_, text, start);
  }

  void FillColumn(size_t layer) {
    Column& column = columns_[layer];
    column.writer =
        std::make_unique<const LayerWriter>(file_, file_.layers[layer], habit_, donors_);
    AddChoice(column.writer->GivenOrder(), column);
    for (const FileOrder& order : tries_) {
      if (!order[layer].empty()) AddChoice(order[layer], column);
    }
  }

  void FillWays(size_t layer) {
    Column& column = columns_[layer];
    for (const Choice& before : columns_[layer - 1].choices) {
      for (const Choice& choice : column.choices) {
        std::string text;
        column.writer->WriteWay(before.order.back(), choice.order.front(), before.behind, text);
        column.ways.push_back(Measure(file_, text, before.behind));
      }
    }
  }

  // How the best rows of choices go on to `layer`.
  void Extend(size_t layer) {
    Column& column = columns_[layer];
    const size_t n = column.choices.size();
    column.score.assign(n, kNever);
    column.from.assign(n, 0);
    for (size_t c = 0; c < n; ++c) {
      const PrintTotals& inside = column.choices[c].inside;
      if (layer == 0) {
        if (MayBe(column, {}, inside)) column.score[c] = Score(inside);
        continue;
      }
      const Column& before = columns_[layer - 1];
      for (size_t b = 0; b < before.choices.size(); ++b) {
        const PrintTotals& way = column.ways[b * n + c];
        const double score = before.score[b] + Score(way) + Score(inside);
        if (score >= column.score[c] || !MayBe(column, way, inside)) continue;
        column.score[c] = score;
        column.from[c] = static_cast<uint32_t>(b);
      }
    }
  }

  bool MayBe(const Column& column, const PrintTotals& way, const PrintTotals& inside) const {
    if (policy_ != Policy::kSafe) return true;
    const double given = column.choices[0].inside.travel_mm;
    const double given_way = column.ways.empty() ? 0 : column.ways[0].travel_mm;
    return inside.travel_mm <= given + kSlackMm &&
           inside.travel_mm + way.travel_mm <= given + given_way + kSlackMm;
  }

  void Trace() {
    const std::vector<double>& last = columns_.back().score;
    auto choice = static_cast<uint32_t>(std::min_element(last.begin(), last.end()) - last.begin());
    for (size_t layer = columns_.size(); layer-- > 0;) {
      columns_[layer].chosen = choice;
      choice = columns_[layer].from[choice];
    }
  }

  ChosenLayers Write() const {
    ChosenLayers chosen;
    const Block& first = file_.blocks.front();
    PartStart at{StateAt(file_, first), file_.states[first.state_in]};
    std::vector<PartStart> starts;  // [layer]
    std::vector<size_t> ends;       // [layer] of its text
    for (size_t layer = 0; layer < columns_.size(); ++layer) {
      const Column& column = columns_[layer];
      const LayerOrder& order = column.choices[column.chosen].order;
      starts.push_back(at);
      if (layer > 0) {
        const Column& before = columns_[layer - 1];
        const Placement& last = before.choices[before.chosen].order.back();
        at = column.writer->WriteWay(last, order.front(), at, chosen.text);
      }
      at = column.writer->WritePaths(order, at, chosen.text);
      ends.push_back(chosen.text.size());
      chosen.changed += column.chosen != 0 ? 1 : 0;
    }
    chosen.behind = at;
    chosen.totals.resize(columns_.size());
    ParallelFor(columns_.size(), threads_, [&](size_t layer) {
      const size_t begin = layer == 0 ? 0 : ends[layer - 1];
      const std::string_view text =
          std::string_view(chosen.text).substr(begin, ends[layer] - begin);
      chosen.totals[layer] = Measure(file_, text, starts[layer]);
    });
    return chosen;
  }

  const GcodeFile& file_;
  const std::vector<FileOrder>& tries_;
  const Policy policy_;
  const int threads_;
  const RetractionHabit habit_;
  const LinkDonors donors_;
  std::vector<Column> columns_;  // [layer]
};

}  // namespace

ChosenLayers ChooseLayers(const GcodeFile& file, const std::vector<FileOrder>& tries, Policy policy,
                          int threads) {
  return Chooser(file, tries, policy, threads).Choose();
}

}  // namespace traverse::gcode
