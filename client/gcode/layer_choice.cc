#include "client/gcode/layer_choice.h"

#include <utility>

#include "client/gcode/outline.h"

namespace traverse::gcode {
namespace {

// Rounding of sums of lengths and times.
constexpr double kSlack = 1e-6;

class Chooser {
 public:
  Chooser(const GcodeFile& file, const std::vector<LayerOrder>& orders,
          const std::vector<PrintTotals>& given, Policy policy)
      : file_(file),
        orders_(orders),
        given_(given),
        policy_(policy),
        habit_(LearnRetraction(file)),
        writer_(file, habit_),
        steps_(file.layers.size()),
        refused_(file.layers.size()) {}

  ChosenLayers Choose() {
    for (size_t layer = 0; layer < file_.layers.size();) {
      if (TryNew(layer) || TryGiven(layer)) {
        ++layer;
        continue;
      }
      if (layer == 0 || refused_[layer - 1] || !steps_[layer - 1].changed) {
        // Nothing to undo: only the extruder's register differs from what it is in the file.
        Try(layer, GivenOrder(file_, file_.layers[layer]), /*must_meet=*/false);
        ++layer;
        continue;
      }
      --layer;
      refused_[layer] = true;
      text_.resize(layer == 0 ? 0 : steps_[layer - 1].end);
    }
    return Result();
  }

 private:
  // A layer as written.
  struct Step {
    size_t end = 0;  // of its text
    PartStart behind;
    Placement last;
    PrintTotals totals;
    bool changed = false;
  };

  PartStart StartOf(size_t layer) const {
    if (layer > 0) return steps_[layer - 1].behind;
    const Block& first = file_.blocks.front();
    return {StateAt(file_, first), file_.states[first.state_in]};
  }

  bool TryNew(size_t layer) {
    if (refused_[layer] || orders_[layer].empty()) return false;
    return Try(layer, orders_[layer]);
  }

  bool TryGiven(size_t layer) { return Try(layer, GivenOrder(file_, file_.layers[layer])); }

  bool Try(size_t layer, const LayerOrder& order, bool must_meet = true) {
    const PartStart start = StartOf(layer);
    const Placement* before = layer == 0 ? nullptr : &steps_[layer - 1].last;
    WrittenLayer written = writer_.Write(file_.layers[layer], order, before, start);
    Step& step = steps_[layer];
    step.totals = written.as_given ? given_[layer] : Measure(file_, written.text, start);
    if (must_meet && !written.as_given && !Meets(layer, written, start)) return false;
    text_.append(written.text);
    step.end = text_.size();
    step.behind = written.behind;
    step.last = order.back();
    step.changed = !written.as_given;
    return true;
  }

  bool Meets(size_t layer, const WrittenLayer& written, const PartStart& start) const {
    const PrintTotals& is = steps_[layer].totals;
    const PrintTotals& was = given_[layer];
    if (is.seconds > was.seconds + kSlack) return false;
    if (policy_ != Policy::kSafe) return true;
    if (is.travel_mm > was.travel_mm + kSlack) return false;
    const double way = Measure(file_, written.text.substr(0, written.first_path), start).travel_mm;
    return is.travel_mm - way <= was.travel_mm - GivenWayTo(layer) + kSlack;
  }

  double GivenWayTo(size_t layer) const {
    const uint32_t first = file_.layers[layer].first_block;
    return first == 0 ? 0 : static_cast<double>(file_.blocks[first].travel_mm);
  }

  ChosenLayers Result() {
    ChosenLayers chosen;
    chosen.text = std::move(text_);
    chosen.behind = steps_.back().behind;
    chosen.last = steps_.back().last;
    for (const Step& step : steps_) {
      chosen.totals.push_back(step.totals);
      chosen.changed += step.changed ? 1 : 0;
    }
    return chosen;
  }

  const GcodeFile& file_;
  const std::vector<LayerOrder>& orders_;
  const std::vector<PrintTotals>& given_;
  const Policy policy_;
  const RetractionHabit habit_;
  const LayerWriter writer_;
  std::vector<Step> steps_;    // [layer]
  std::vector<bool> refused_;  // [layer] its new order was tried and undone
  std::string text_;
};

}  // namespace

ChosenLayers ChooseLayers(const GcodeFile& file, const std::vector<LayerOrder>& orders,
                          const std::vector<PrintTotals>& given, Policy policy) {
  return Chooser(file, orders, given, policy).Choose();
}

}  // namespace traverse::gcode
