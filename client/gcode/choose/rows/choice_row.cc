#include "client/gcode/choose/rows/choice_row.h"

#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "client/gcode/choose/rows/cheapest_row.h"

namespace traverse::gcode {
namespace {

// Rounding of sums of lengths.
constexpr double kSlackMm = PrintTotals::kLeastExtraMm;

// And of times.
constexpr double kTimeSlack = 1e-9;

// A second of print time is worth this much travel: between orders that take the same time the
// shorter one is better.
constexpr double kSecondsPerMm = 1e-6;

// Prices that are tried: from the first on twice as much each, and then halves between the last
// that is too low and the first that is not.
constexpr double kFirstPrice = 0.02;
constexpr int kDoublings = 16;
constexpr int kHalvings = 6;

// The price of each of them in seconds, in addition to its time.
struct Prices {
  double crossing = 0;
  double retraction = 0;
};

// The seconds that each additional retraction must save on top of its own, or the file does without
// it: about twice what one takes.
constexpr double kMostRetractionSeconds = 0.3;

struct Row {
  std::vector<uint32_t> choices;
  PrintTotals totals;
  Prices prices;  // at which it is the best one
};

class RowFinder {
 public:
  RowFinder(const std::vector<const ChoiceColumn*>& columns, Crossings crossings, int64_t fewer)
      : columns_(columns), crossings_(crossings), fewer_(fewer) {
    for (const ChoiceColumn* column : columns) given_ += column->Whole(0, 0);
  }

  std::vector<uint32_t> Find() {
    std::optional<Row> row = crossings_ == Crossings::kFewer ? FindWithFewer() : Find({});
    if (!CrossesFewEnough(row->totals)) {
      const auto few = [this](const PrintTotals& totals) { return CrossesFewEnough(totals); };
      row = FindDear(row->prices, {.crossing = 1}, few);
    }
    if (!row) return std::vector<uint32_t>(columns_.size(), 0);
    if (row->totals.retractions <= given_.retractions) return row->choices;
    const auto both = [this](const PrintTotals& totals) {
      return CrossesFewEnough(totals) && totals.retractions <= given_.retractions;
    };
    const std::optional<Row> spare = FindDear(row->prices, {.retraction = 1}, both);
    if (spare && spare->prices.retraction <= kMostRetractionSeconds) return spare->choices;
    Row less = Find({row->prices.crossing, kMostRetractionSeconds});
    return CrossesFewEnough(less.totals) ? less.choices : row->choices;
  }

 private:
  bool CrossesFewEnough(const PrintTotals& totals) const {
    return crossings_ == Crossings::kAny || totals.crossings <= given_.crossings - fewer_;
  }

  // The best row at the price of a crossing or, if that takes longer than the file, at the highest
  // price at which it does not.
  Row FindWithFewer() const {
    const auto slower = [this](const Row& row) {
      return row.totals.seconds > given_.seconds + kTimeSlack;
    };
    double high = kFewerCrossingSeconds;
    Row dear = Find({.crossing = high});
    if (!slower(dear)) return dear;
    double low = 0;
    Row best = Find({});
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (low + high) / 2;
      Row row = Find({.crossing = middle});
      const bool too_slow = slower(row);
      (too_slow ? high : low) = middle;
      if (!too_slow) best = std::move(row);
    }
    return best;
  }

  // The best row that `may_be`, at prices that are raised from `least` on in the ratio of `steps`.
  template <typename MayBeRow>
  std::optional<Row> FindDear(const Prices& least, const Prices& steps, MayBeRow may_be) const {
    double low = 0;
    double high = kFirstPrice;
    const auto raised = [&](double price) {
      return Prices{least.crossing + price * steps.crossing,
                    least.retraction + price * steps.retraction};
    };
    std::optional<Row> best;
    for (int i = 0; i < kDoublings && !best; ++i) {
      Row row = Find(raised(high));
      if (may_be(row.totals)) {
        best = std::move(row);
      } else {
        low = high;
        high *= 2;
      }
    }
    for (int i = 0; i < kHalvings && best; ++i) {
      const double middle = (low + high) / 2;
      Row row = Find(raised(middle));
      const bool fits = may_be(row.totals);
      (fits ? high : low) = middle;
      if (fits && Score(row.totals, {}) <= Score(best->totals, {})) best = std::move(row);
    }
    return best;
  }

  static double Score(const PrintTotals& totals, const Prices& prices) {
    return totals.seconds + kSecondsPerMm * totals.travel_mm +
           prices.crossing * static_cast<double>(totals.crossings) +
           prices.retraction * static_cast<double>(totals.retractions);
  }

  static bool MayFollow(const ChoiceColumn& column, size_t before, size_t choice) {
    const bool ruled_out =
        column.no_choice[choice] ||
        (!column.no_travel.empty() && column.no_travel[before * column.inside.size() + choice]);
    if (ruled_out) return false;
    const PrintTotals given = column.Whole(0, 0);
    const PrintTotals chosen = column.Whole(before, choice);
    if (chosen.blocked > given.blocked || chosen.open_crossings > given.open_crossings ||
        chosen.longest_open_mm > given.longest_open_mm + kSlackMm) {
      return false;
    }
    // If primes push a little more or less than was retracted, their number is part of the print;
    // and that of the paths belongs to them, whatever is before them.
    return std::abs(chosen.extra_mm - given.extra_mm) <= kSlackMm &&
           std::abs(column.inside[choice].extra_mm - column.inside[0].extra_mm) <= kSlackMm;
  }

  Row Find(const Prices& prices) const {
    CheapestRow cheapest;
    for (const ChoiceColumn* column : columns_) {
      cheapest.Extend(
          column->inside.size(),
          [&](uint32_t before, uint32_t choice, double up_to) {
            return up_to + Score(column->Whole(before, choice), prices);
          },
          [&](uint32_t before, uint32_t choice) { return MayFollow(*column, before, choice); });
    }
    Row row{cheapest.Choices(), {}, prices};
    for (size_t layer = columns_.size(); layer-- > 0;) {
      row.totals +=
          columns_[layer]->Whole(layer > 0 ? row.choices[layer - 1] : 0, row.choices[layer]);
    }
    return row;
  }

  const std::vector<const ChoiceColumn*>& columns_;
  const Crossings crossings_;
  const int64_t fewer_;
  PrintTotals given_;
};

}  // namespace

PrintTotals ChoiceColumn::Whole(size_t before, size_t choice) const {
  PrintTotals whole = inside[choice];
  if (!travels.empty()) whole += Travel(before, choice);
  return whole;
}

const PrintTotals& ChoiceColumn::Travel(size_t before, size_t choice) const {
  assert(before * inside.size() + choice < travels.size());
  return travels[before * inside.size() + choice];
}

std::vector<uint32_t> BestRow(const std::vector<const ChoiceColumn*>& columns, Crossings crossings,
                              int64_t fewer) {
  assert(!columns.empty());
  return RowFinder(columns, crossings, fewer).Find();
}

}  // namespace traverse::gcode
