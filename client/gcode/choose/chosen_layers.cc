#include "client/gcode/choose/chosen_layers.h"

#include <atomic>
#include <string_view>

#include "client/gcode/choose/layer_column.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/parallel.h"

namespace traverse::gcode {
namespace {

class ChosenWriter {
 public:
  ChosenWriter(const GcodeFile& file, const std::vector<LayerColumn>& columns, int threads)
      : file_(file), columns_(columns), threads_(threads) {}

  // The travel moves are written one after the other, for each needs to know where the extruder's
  // register is; then the paths, side by side. Where they set the register themselves, and it
  // counts on from elsewhere than when they were measured, they are written at once.
  ChosenLayers Write() const {
    ChosenLayers chosen;
    chosen.texts.resize(columns_.size());
    for (size_t layer = 0; layer < columns_.size(); ++layer) NoteTotals(layer, chosen);
    std::vector<size_t> left;
    std::vector<PartStart> starts;  // [layer] of its paths
    std::vector<Decimal> ends;      // [layer] the register behind them, as foreseen
    for (size_t layer = 0; layer < columns_.size(); ++layer) {
      const LayerChoice& choice = columns_[layer].Chosen();
      LayerText& text = chosen.texts[layer];
      starts.push_back(WriteTravelTo(layer, chosen.behind, text.travel));
      chosen.behind = choice.behind;
      if (Fits(layer, starts[layer])) {
        starts[layer] = choice.start;
        if (columns_[layer].chosen != 0) left.push_back(layer);
      } else if (choice.resets_e) {
        chosen.behind = WritePathsOf(layer, starts[layer], text.paths);
      } else {
        chosen.behind.machine.e += starts[layer].machine.e - choice.start.machine.e;
        left.push_back(layer);
      }
      ends.push_back(chosen.behind.machine.e);
    }
    std::atomic<bool> as_foreseen = true;
    ParallelFor(left.size(), threads_, [&](size_t i) {
      const size_t layer = left[i];
      const PartStart behind = WritePathsOf(layer, starts[layer], chosen.texts[layer].paths);
      if (behind.machine.e != ends[layer]) as_foreseen = false;
    });
    if (!as_foreseen) WriteOneByOne(chosen);
    return chosen;
  }

 private:
  // Where the register is set in some unusual spelling.
  void WriteOneByOne(ChosenLayers& chosen) const {
    for (size_t layer = 0; layer < columns_.size(); ++layer) {
      LayerText& text = chosen.texts[layer];
      text = LayerText{};
      const PartStart start = WriteTravelTo(layer, chosen.behind, text.travel);
      chosen.behind = WritePathsOf(layer, start, text.paths);
    }
  }

  // The paths written for the choice may stand behind `start`.
  bool Fits(size_t layer, const PartStart& start) const {
    return start.machine.RelativeE() || start.machine.e == columns_[layer].Chosen().start.machine.e;
  }

  // `at` is the machine behind the layer before; of no meaning for the first one.
  PartStart WriteTravelTo(size_t layer, const PartStart& at, std::string& text) const {
    if (layer == 0) {
      const Block& first = file_.blocks.front();
      return {StateAt(file_, first), file_.states[first.state_in]};
    }
    return columns_[layer].writer->WriteTravel(columns_[layer - 1].Chosen().order.back(),
                                               columns_[layer].Chosen().order.front(), at, text);
  }

  PartStart WritePathsOf(size_t layer, const PartStart& start, std::string& text) const {
    const LayerChoice& choice = columns_[layer].Chosen();
    return choice.writer->WritePaths(choice.order, start, text, nullptr, choice.as_sliced);
  }

  void NoteTotals(size_t layer, ChosenLayers& chosen) const {
    const LayerColumn& column = columns_[layer];
    chosen.orders.push_back(column.chosen == 0 ? LayerOrder() : column.Chosen().order);
    const size_t before = layer > 0 ? columns_[layer - 1].chosen : 0;
    chosen.given.push_back(column.totals.Whole(0, 0));
    chosen.totals.push_back(column.totals.Whole(before, column.chosen));
    chosen.changed += column.chosen != 0 ? 1 : 0;
    if (column.blocked) chosen.blocked.push_back(layer);
    const double given = ForecastPaths(*column.writer, column.given_order(), Hiding::kNone);
    Forecast& forecast = chosen.forecast;
    forecast.given_seconds += given;
    forecast.seconds +=
        column.chosen == 0 ? given : ForecastPaths(*column.Chosen().writer, column.Chosen().order);
    if (layer == 0) return;
    forecast.given_seconds += column.totals.Travel(0, 0).seconds;
    forecast.seconds += column.totals.Travel(before, column.chosen).seconds;
  }

  const GcodeFile& file_;
  const std::vector<LayerColumn>& columns_;  // [layer]
  const int threads_;
};

}  // namespace

ChosenLayers WriteChosen(const GcodeFile& file, const std::vector<LayerColumn>& columns,
                         int threads) {
  return ChosenWriter(file, columns, threads).Write();
}

void ChosenLayers::AppendTo(const GcodeFile& file, std::string& text) const {
  for (size_t i = 0; i < texts.size(); ++i) {
    text += texts[i].travel;
    text +=
        texts[i].paths.empty() ? file.PathsText(file.layers[i]) : std::string_view(texts[i].paths);
  }
}

}  // namespace traverse::gcode
