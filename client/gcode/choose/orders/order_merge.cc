#include "client/gcode/choose/orders/order_merge.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traverse::gcode {
namespace {

// What rounding of sums is less than.
constexpr double kGrain = 1e-7;

// An order as it is looked up. REQUIRES: the layer begins with block `first`.
struct Source {
  Source(const LayerOrder& order, uint32_t first)
      : first(first), rank(order.size()), placement(order.size()) {
    for (uint32_t i = 0; i < order.size(); ++i) {
      rank[order[i].block - first] = i;
      placement[order[i].block - first] = order[i];
    }
  }

  uint32_t RankOf(const Placement& path) const { return rank[path.block - first]; }
  const Placement& PlacementOf(const Placement& path) const {
    return placement[path.block - first];
  }

  uint32_t first;
  std::vector<uint32_t> rank;        // [path]
  std::vector<Placement> placement;  // [path]
};

// One merge in progress.
class Merging {
 public:
  Merging(const OrderMerger& merger, const TravelEstimate& estimate, LayerOrder begun)
      : merger_(merger), estimate_(estimate), order_(std::move(begun)), travels_(order_.size()) {
    for (size_t i = 1; i < order_.size(); ++i) {
      travels_[i] = estimate_(i, order_[i - 1], order_[i]);
      totals_ += travels_[i];
    }
  }

  // True if a run of the order of `source` makes it better.
  bool TryAllRuns(const Source& source) {
    bool better = false;
    const size_t end = order_.size() - 1;  // the last path stays
    for (size_t size = end - 1; size > 0; size /= 2) {
      const size_t step = std::max<size_t>(1, size / 2);
      for (size_t begin = 1; begin + size <= end && asked_ < most(); begin += step) {
        better |= TryRun(source, begin, begin + size);
      }
    }
    return better;
  }

  size_t most() const { return std::max(OrderMerger::kMostTravels, order_.size()); }
  LayerOrder Take() { return std::move(order_); }

 private:
  // The run is as the source has it: so are most where orders differ little.
  bool IsOf(const Source& source, size_t begin, size_t end) const {
    uint32_t next = 0;
    for (size_t i = begin; i < end; ++i) {
      const uint32_t rank = source.RankOf(order_[i]);
      if (rank < next || source.PlacementOf(order_[i]) != order_[i]) return false;
      next = rank + 1;
    }
    return true;
  }

  bool TryRun(const Source& source, size_t begin, size_t end) {
    if (IsOf(source, begin, end)) return false;
    run_.assign(order_.begin() + static_cast<std::ptrdiff_t>(begin),
                order_.begin() + static_cast<std::ptrdiff_t>(end));
    for (Placement& placement : run_) placement = source.PlacementOf(placement);
    std::ranges::sort(run_, {}, [&](const Placement& path) { return source.RankOf(path); });
    TravelTotals totals = totals_;
    new_travels_.clear();
    const Placement* at = &order_[begin - 1];
    for (size_t place = begin; place <= end; ++place) {
      const Placement& to = place < end ? run_[place - begin] : order_[end];
      new_travels_.push_back(estimate_(place, *at, to));
      totals -= travels_[place];
      totals += new_travels_.back();
      at = &to;
    }
    asked_ += new_travels_.size();
    if (!merger_.IsBetter(totals, totals_)) return false;
    totals_ = totals;
    std::copy(run_.begin(), run_.end(), order_.begin() + static_cast<std::ptrdiff_t>(begin));
    std::copy(new_travels_.begin(), new_travels_.end(),
              travels_.begin() + static_cast<std::ptrdiff_t>(begin));
    return true;
  }

  const OrderMerger& merger_;
  const TravelEstimate& estimate_;
  LayerOrder order_;
  std::vector<TravelTotals> travels_;  // [position] the travel to it
  TravelTotals totals_;
  size_t asked_ = 0;
  LayerOrder run_;
  std::vector<TravelTotals> new_travels_;
};

}  // namespace

TravelTotals OrderMerger::TotalsOf(const LayerOrder& order) const {
  TravelTotals totals;
  for (size_t i = 1; i < order.size(); ++i) totals += estimate_(i, order[i - 1], order[i]);
  return totals;
}

double OrderMerger::Excess(const TravelTotals& totals) const {
  const auto beyond = [](int64_t value, int64_t limit) {
    return value > limit ? static_cast<double>(value - limit) : 0.0;
  };
  return beyond(totals.crossings, limits_.crossings) + beyond(totals.open, limits_.open) +
         static_cast<double>(totals.too_long) + static_cast<double>(totals.blocked) +
         beyond(totals.retractions, limits_.retractions) +
         beyond(limits_.least_retractions, totals.retractions);
}

double OrderMerger::Score(const TravelTotals& totals) const {
  return totals.seconds + limits_.crossing_seconds * static_cast<double>(totals.crossings) +
         limits_.retraction_seconds * static_cast<double>(totals.retractions);
}

bool OrderMerger::IsBetter(const TravelTotals& totals, const TravelTotals& others) const {
  const double excess = Excess(totals);
  const double excess_of_others = Excess(others);
  if (std::abs(excess - excess_of_others) > kGrain) return excess < excess_of_others;
  return Score(totals) < Score(others) - kGrain;
}

LayerOrder OrderMerger::Merge(const LayerOrder& begun,
                              const std::vector<LayerOrder>& others) const {
  if (begun.size() < 3) return begun;
  const uint32_t first = std::ranges::min(begun, {}, &Placement::block).block;
  std::vector<Source> sources;
  for (const LayerOrder& other : others) sources.emplace_back(other, first);
  sources.emplace_back(begun, first);  // what a longer run took away may be better
  Merging merge(*this, estimate_, begun);
  for (bool better = true; better;) {
    better = false;
    for (const Source& source : sources) better |= merge.TryAllRuns(source);
  }
  return merge.Take();
}

}  // namespace traverse::gcode
