#include "client/gcode/write/layer_choice.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string_view>
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

double Score(const PrintTotals& totals, Crossings crossings) {
  const double seconds = totals.seconds + kSecondsPerMm * totals.travel_mm;
  if (crossings != Crossings::kFewer) return seconds;
  return seconds + kFewerCrossingSeconds * static_cast<double>(totals.crossings);
}

// As slicers write it: a sign that the extruder's register does not count through.
bool Resets(std::string_view text) { return text.find("G92") != std::string_view::npos; }

// One order of a layer.
struct Choice {
  LayerOrder order;
  const LayerWriter* writer = nullptr;
  PrintTotals inside;  // its paths and the ways between them
  PartStart start;     // how it begins and ends in `text`
  PartStart behind;
  bool resets_e = false;  // the register is set on the way, and does not count through
  std::string text;       // empty for the order of the file
};

// A layer and what it may be. choices[0] is the order of the file.
struct Column {
  std::unique_ptr<const LayerWriter> writer;
  std::unique_ptr<const LayerWriter> plain;  // which spares no walls; null if not needed
  std::vector<Choice> choices;
  std::vector<PrintTotals> ways;  // [before * choices.size() + choice] from the layer before
  std::vector<double> score;      // [choice] of the best row up to here
  std::vector<uint32_t> from;     // [choice] the layer before in that row
  uint32_t chosen = 0;
};

class Chooser {
 public:
  Chooser(const GcodeFile& file, const std::vector<FileOrder>& tries, const ChoiceOptions& choice)
      : file_(file),
        tries_(tries),
        policy_(choice.policy),
        crossings_(choice.crossings),
        threads_(choice.threads),
        habit_(HabitOfNewWays(file)),
        plain_habit_(Plain(habit_)),
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
  static RetractionHabit Plain(RetractionHabit habit) {
    habit.spares_walls = false;
    return habit;
  }

  void AddGiven(size_t layer, Column& column) const {
    Choice& choice = column.choices.emplace_back();
    choice.order = column.writer->GivenOrder();
    choice.writer = column.writer.get();
    choice.start = StartOfPaths(file_, choice.order.front());
    choice.behind = StartBehind(file_, file_.blocks[file_.layers[layer].end_block - 1]);
    choice.resets_e = Resets(file_.PathsText(file_.layers[layer]));
    choice.inside = MeasurePaths(file_, file_.layers[layer], column.writer->walls());
  }

  // Writes `order` with walls spared. Where that leaves fewer ways across them with an open nozzle
  // than the file has, there may be time to win: so it is written as the file would have it as
  // well.
  void AddChoices(const LayerOrder& order, size_t layer, Column& column) const {
    for (const Choice& known : column.choices) {
      if (known.order == order) return;
    }
    AddChoice(order, *column.writer, column);
    if (!habit_.spares_walls || habit_.avoids_walls) return;
    if (column.choices.back().inside.open_crossings >= column.choices[0].inside.open_crossings) {
      return;
    }
    if (column.plain == nullptr) {
      column.plain =
          std::make_unique<const LayerWriter>(file_, file_.layers[layer], plain_habit_, donors_);
    }
    AddChoice(order, *column.plain, column);
  }

  void AddChoice(const LayerOrder& order, const LayerWriter& writer, Column& column) const {
    Choice& choice = column.choices.emplace_back();
    choice.order = order;
    choice.writer = &writer;
    choice.start = StartOfPaths(file_, order.front());
    choice.behind = writer.WritePaths(order, choice.start, choice.text);
    choice.resets_e = Resets(choice.text);
    choice.inside = Measure(file_, choice.text, choice.start, &column.writer->walls());
  }

  void FillColumn(size_t layer) {
    Column& column = columns_[layer];
    column.writer =
        std::make_unique<const LayerWriter>(file_, file_.layers[layer], habit_, donors_);
    AddGiven(layer, column);
    for (const FileOrder& order : tries_) {
      if (!order[layer].empty()) AddChoices(order[layer], layer, column);
    }
  }

  void FillWays(size_t layer) {
    Column& column = columns_[layer];
    for (const Choice& before : columns_[layer - 1].choices) {
      for (const Choice& choice : column.choices) {
        std::string text;
        column.writer->WriteWay(before.order.back(), choice.order.front(), before.behind, text);
        column.ways.push_back(Measure(file_, text, before.behind, &column.writer->walls()));
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
        if (MayBe(column, {}, inside)) column.score[c] = Score(inside, crossings_);
        continue;
      }
      const Column& before = columns_[layer - 1];
      for (size_t b = 0; b < before.choices.size(); ++b) {
        const PrintTotals& way = column.ways[b * n + c];
        const double score = before.score[b] + Score(way, crossings_) + Score(inside, crossings_);
        if (score >= column.score[c] || !MayBe(column, way, inside)) continue;
        column.score[c] = score;
        column.from[c] = static_cast<uint32_t>(b);
      }
    }
  }

  bool MayBe(const Column& column, const PrintTotals& way, const PrintTotals& inside) const {
    const PrintTotals& given = column.choices[0].inside;
    PrintTotals given_whole = given;
    if (!column.ways.empty()) given_whole += column.ways[0];
    PrintTotals whole = inside;
    whole += way;
    return MayBe(given, inside) && MayBe(given_whole, whole);
  }

  bool MayBe(const PrintTotals& given, const PrintTotals& chosen) const {
    if (crossings_ != Crossings::kAny && chosen.crossings > given.crossings) return false;
    if (chosen.open_crossings > given.open_crossings ||
        chosen.longest_open_mm > given.longest_open_mm + kSlackMm) {
      return false;
    }
    // Where each prime pushes a little more than was pulled back, their number is what is printed.
    if (std::abs(chosen.extra_mm - given.extra_mm) > kSlackMm) return false;
    return policy_ != Policy::kSafe || chosen.travel_mm <= given.travel_mm + kSlackMm;
  }

  void Trace() {
    const std::vector<double>& last = columns_.back().score;
    auto choice = static_cast<uint32_t>(std::min_element(last.begin(), last.end()) - last.begin());
    for (size_t layer = columns_.size(); layer-- > 0;) {
      columns_[layer].chosen = choice;
      choice = columns_[layer].from[choice];
    }
  }

  // The ways are written one after the other, for each needs to know where the extruder's register
  // is; the paths have been written already, and only where the register counts on from elsewhere
  // they are written again, side by side.
  ChosenLayers Write() {
    ChosenLayers chosen;
    chosen.texts.resize(columns_.size());
    for (size_t layer = 0; layer < columns_.size(); ++layer) NoteTotals(layer, chosen);
    std::vector<size_t> again;
    std::vector<PartStart> starts;  // [layer] of its paths, the register as it ought to be
    for (size_t layer = 0; layer < columns_.size(); ++layer) {
      LayerText& text = chosen.texts[layer];
      starts.push_back(WriteWayTo(layer, chosen.behind, text.way));
      chosen.behind = Chosen(layer).behind;
      if (Fits(layer, starts[layer])) {
        text.paths = std::move(Chosen(layer).text);
      } else if (Chosen(layer).resets_e) {
        chosen.behind = WritePathsOf(layer, starts[layer], text.paths);
      } else {
        again.push_back(layer);
        chosen.behind.machine.e += starts[layer].machine.e - Chosen(layer).start.machine.e;
      }
    }
    starts.push_back(chosen.behind);
    std::atomic<bool> as_foreseen = true;
    ParallelFor(again.size(), threads_, [&](size_t i) {
      const size_t layer = again[i];
      const PartStart behind = WritePathsOf(layer, starts[layer], chosen.texts[layer].paths);
      const Decimal foreseen =
          Chosen(layer).behind.machine.e + starts[layer].machine.e - Chosen(layer).start.machine.e;
      if (behind.machine.e != foreseen) as_foreseen = false;
    });
    if (!as_foreseen) WriteOneByOne(chosen);
    return chosen;
  }

  // Where the register is set in some unusual spelling.
  void WriteOneByOne(ChosenLayers& chosen) const {
    for (size_t layer = 0; layer < columns_.size(); ++layer) {
      LayerText& text = chosen.texts[layer];
      text = LayerText{};
      const PartStart start = WriteWayTo(layer, chosen.behind, text.way);
      chosen.behind = WritePathsOf(layer, start, text.paths);
    }
  }

  Choice& Chosen(size_t layer) { return columns_[layer].choices[columns_[layer].chosen]; }
  const Choice& Chosen(size_t layer) const {
    return columns_[layer].choices[columns_[layer].chosen];
  }

  // The paths written for the choice may stand behind `start`.
  bool Fits(size_t layer, const PartStart& start) const {
    return start.machine.RelativeE() || start.machine.e == Chosen(layer).start.machine.e;
  }

  // `at` is the machine behind the layer before; of no meaning for the first one.
  PartStart WriteWayTo(size_t layer, const PartStart& at, std::string& text) const {
    if (layer == 0) {
      const Block& first = file_.blocks.front();
      return {StateAt(file_, first), file_.states[first.state_in]};
    }
    return columns_[layer].writer->WriteWay(Chosen(layer - 1).order.back(),
                                            Chosen(layer).order.front(), at, text);
  }

  PartStart WritePathsOf(size_t layer, const PartStart& start, std::string& text) const {
    return Chosen(layer).writer->WritePaths(Chosen(layer).order, start, text);
  }

  void NoteTotals(size_t layer, ChosenLayers& chosen) const {
    const Column& column = columns_[layer];
    PrintTotals given = column.choices[0].inside;
    PrintTotals totals = column.choices[column.chosen].inside;
    if (layer > 0) {
      const size_t before = columns_[layer - 1].chosen;
      given += column.ways[0];
      totals += column.ways[before * column.choices.size() + column.chosen];
    }
    chosen.given.push_back(given);
    chosen.totals.push_back(totals);
    chosen.changed += column.chosen != 0 ? 1 : 0;
  }

  const GcodeFile& file_;
  const std::vector<FileOrder>& tries_;
  const Policy policy_;
  const Crossings crossings_;
  const int threads_;
  const RetractionHabit habit_;
  const RetractionHabit plain_habit_;
  const LinkDonors donors_;
  std::vector<Column> columns_;  // [layer]
};

}  // namespace

void ChosenLayers::AppendTo(const GcodeFile& file, std::string& text) const {
  for (size_t i = 0; i < texts.size(); ++i) {
    text += texts[i].way;
    text +=
        texts[i].paths.empty() ? file.PathsText(file.layers[i]) : std::string_view(texts[i].paths);
  }
}

ChosenLayers ChooseLayers(const GcodeFile& file, const std::vector<FileOrder>& tries,
                          const ChoiceOptions& options) {
  return Chooser(file, tries, options).Choose();
}

}  // namespace traverse::gcode
