#include "client/gcode/write/choice_row.h"

#include <algorithm>
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

struct Prices {
  double crossing = 0;
  double retraction = 0;
};

struct Row {
  std::vector<uint32_t> choices;
  PrintTotals totals;
};

class RowFinder {
 public:
  RowFinder(const std::vector<const ChoiceColumn*>& columns, Policy policy, Crossings crossings)
      : columns_(columns), policy_(policy), crossings_(crossings) {
    for (const ChoiceColumn* column : columns) given_ += column->Whole(0, 0);
  }

  std::vector<uint32_t> Find() {
    const Row best = Find({crossings_ == Crossings::kFewer ? kFewerCrossingSeconds : 0, 0});
    if (MayBe(best.totals)) return best.choices;
    std::optional<Row> dear = FindBy([](double price) { return Prices{price, price}; });
    // Most files keep one of the two anyway.
    const bool crosses = TooManyCrossings(best.totals);
    const bool retracts = best.totals.retractions > given_.retractions;
    if (crosses != retracts) {
      const std::optional<Row> one = FindBy([crosses](double price) {
        return Prices{crosses ? price : 0, crosses ? 0 : price};
      });
      if (one && (!dear || Score(one->totals, {}) < Score(dear->totals, {}))) dear = one;
    }
    return dear ? dear->choices : std::vector<uint32_t>(columns_.size(), 0);
  }

 private:
  bool TooManyCrossings(const PrintTotals& totals) const {
    return crossings_ != Crossings::kAny && totals.crossings > given_.crossings;
  }

  bool MayBe(const PrintTotals& totals) const { return !TooManyCrossings(totals); }

  template <typename PricesAt>
  std::optional<Row> FindBy(PricesAt prices_at) const {
    const double least = crossings_ == Crossings::kFewer ? kFewerCrossingSeconds : 0;
    const auto find = [&](double price) {
      Prices prices = prices_at(price);
      prices.crossing = std::max(prices.crossing, least);
      return Find(prices);
    };
    double low = 0;
    double high = kFirstPrice;
    std::optional<Row> best;
    for (int i = 0; i < kDoublings && !best; ++i) {
      Row row = find(high);
      if (MayBe(row.totals)) {
        best = std::move(row);
      } else {
        low = high;
        high *= 2;
      }
    }
    for (int i = 0; i < kHalvings && best; ++i) {
      const double middle = (low + high) / 2;
      Row row = find(middle);
      const bool may_be = MayBe(row.totals);
      (may_be ? high : low) = middle;
      if (may_be && Score(row.totals, {}) < Score(best->totals, {})) best = std::move(row);
    }
    return best;
  }

  static double Score(const PrintTotals& totals, const Prices& prices) {
    return totals.seconds + kSecondsPerMm * totals.travel_mm +
           prices.crossing * static_cast<double>(totals.crossings) +
           prices.retraction * static_cast<double>(totals.retractions);
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

  Row Find(const Prices& prices) const {
    std::vector<std::vector<uint32_t>> from(columns_.size());
    std::vector<double> before = {0};
    for (size_t layer = 0; layer < columns_.size(); ++layer) {
      before = Extend(layer, prices, before, from[layer]);
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
  std::vector<double> Extend(size_t layer, const Prices& prices, const std::vector<double>& before,
                             std::vector<uint32_t>& from) const {
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
        const double score = before[b] + Score(whole, prices);
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
  PrintTotals given_;
};

}  // namespace

PrintTotals ChoiceColumn::Whole(size_t before, size_t choice) const {
  PrintTotals whole = inside[choice];
  if (!ways.empty()) whole += ways[before * inside.size() + choice];
  return whole;
}

std::vector<uint32_t> BestRow(const std::vector<const ChoiceColumn*>& columns, Policy policy,
                              Crossings crossings) {
  return RowFinder(columns, policy, crossings).Find();
}

}  // namespace traverse::gcode
