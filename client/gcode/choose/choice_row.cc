#include "client/gcode/choose/choice_row.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

namespace traverse::gcode {
namespace {

// Rounding of sums of lengths.
constexpr double kSlackMm = 1e-6;

constexpr double kNever = std::numeric_limits<double>::infinity();

// A second of print time is worth this much travel: between orders that take the same time the
// shorter one is better.
constexpr double kSecondsPerMm = 1e-6;

// Prices that are tried: from the first on twice as much each, and then halves between the last
// that is too low and the first that is not.
constexpr double kFirstPrice = 0.02;
constexpr int kDoublings = 16;
constexpr int kHalvings = 6;

struct Row {
  std::vector<uint32_t> choices;
  PrintTotals totals;
};

class RowFinder {
 public:
  RowFinder(const std::vector<const ChoiceColumn*>& columns, Policy policy, Crossings crossings,
            int64_t fewer)
      : columns_(columns), policy_(policy), crossings_(crossings), fewer_(fewer) {
    for (const ChoiceColumn* column : columns) given_ += column->Whole(0, 0);
  }

  std::vector<uint32_t> Find() {
    const double least = crossings_ == Crossings::kFewer ? kFewerCrossingSeconds : 0;
    const Row best = Find(least);
    if (MayBe(best.totals)) return best.choices;
    const std::optional<Row> dear = FindDear(least);
    return dear ? dear->choices : std::vector<uint32_t>(columns_.size(), 0);
  }

 private:
  bool MayBe(const PrintTotals& totals) const {
    return crossings_ == Crossings::kAny || totals.crossings <= given_.crossings - fewer_;
  }

  std::optional<Row> FindDear(double least) const {
    double low = least;
    double high = least + kFirstPrice;
    std::optional<Row> best;
    for (int i = 0; i < kDoublings && !best; ++i) {
      Row row = Find(high);
      if (MayBe(row.totals)) {
        best = std::move(row);
      } else {
        low = high;
        high *= 2;
      }
    }
    for (int i = 0; i < kHalvings && best; ++i) {
      const double middle = (low + high) / 2;
      Row row = Find(middle);
      const bool may_be = MayBe(row.totals);
      (may_be ? high : low) = middle;
      if (may_be && Score(row.totals, 0) < Score(best->totals, 0)) best = std::move(row);
    }
    return best;
  }

  static double Score(const PrintTotals& totals, double crossing_seconds) {
    return totals.seconds + kSecondsPerMm * totals.travel_mm +
           crossing_seconds * static_cast<double>(totals.crossings);
  }

  bool MayBe(const PrintTotals& given, const PrintTotals& chosen) const {
    if (chosen.open_crossings > given.open_crossings ||
        chosen.longest_open_mm > given.longest_open_mm + kSlackMm) {
      return false;
    }
    // Where each prime pushes a little more than was pulled back, their number is what is printed.
    if (std::abs(chosen.extra_mm - given.extra_mm) > kSlackMm) return false;
    return policy_ != Policy::kSafe || chosen.travel_mm <= given.travel_mm + kSlackMm;
  }

  Row Find(double crossing_seconds) const {
    std::vector<std::vector<uint32_t>> from(columns_.size());
    std::vector<double> before = {0};
    for (size_t layer = 0; layer < columns_.size(); ++layer) {
      before = Extend(layer, crossing_seconds, before, from[layer]);
    }
    Row row;
    row.choices.resize(columns_.size());
    auto choice =
        static_cast<uint32_t>(std::min_element(before.begin(), before.end()) - before.begin());
    for (size_t layer = columns_.size(); layer-- > 0;) {
      row.choices[layer] = choice;
      choice = from[layer][choice];
      row.totals += columns_[layer]->Whole(choice, row.choices[layer]);
    }
    return row;
  }

  // [choice] the score of the best row up to `layer`, and in `from` where it comes from.
  std::vector<double> Extend(size_t layer, double crossing_seconds,
                             const std::vector<double>& before, std::vector<uint32_t>& from) const {
    const ChoiceColumn& column = *columns_[layer];
    const size_t n = column.inside.size();
    const PrintTotals given = column.Whole(0, 0);
    std::vector<double> scores(n, kNever);
    from.assign(n, 0);
    for (size_t c = 0; c < n; ++c) {
      if (column.no_choice[c]) continue;
      // The extruder's surplus belongs to the paths, whatever is before them.
      if (std::abs(column.inside[c].extra_mm - column.inside[0].extra_mm) > kSlackMm) continue;
      for (size_t b = 0; b < before.size(); ++b) {
        if (!column.no_way.empty() && column.no_way[b * n + c]) continue;
        const PrintTotals whole = column.Whole(b, c);
        const double score = before[b] + Score(whole, crossing_seconds);
        if (score >= scores[c] || !MayBe(given, whole)) continue;
        scores[c] = score;
        from[c] = static_cast<uint32_t>(b);
      }
    }
    return scores;
  }

  const std::vector<const ChoiceColumn*>& columns_;
  const Policy policy_;
  const Crossings crossings_;
  const int64_t fewer_;
  PrintTotals given_;
};

}  // namespace

PrintTotals ChoiceColumn::Whole(size_t before, size_t choice) const {
  PrintTotals whole = inside[choice];
  if (!ways.empty()) whole += ways[before * inside.size() + choice];
  return whole;
}

std::vector<uint32_t> BestRow(const std::vector<const ChoiceColumn*>& columns, Policy policy,
                              Crossings crossings, int64_t fewer) {
  assert(!columns.empty());
  return RowFinder(columns, policy, crossings, fewer).Find();
}

}  // namespace traverse::gcode
