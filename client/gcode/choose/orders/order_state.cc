#include "client/gcode/choose/orders/order_state.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace traverse::gcode {

PathPairs::PathPairs(const LayerFreedom& freedom)
    : earlier(freedom.rules.size()), later(freedom.rules.size()) {
  for (const auto& [first, second] : freedom.ordered) {
    later[first].push_back(second);
    earlier[second].push_back(first);
  }
}

OrderState::OrderState(LayerOrder begun, uint32_t first_block, const LayerFreedom& freedom,
                       const std::vector<uint32_t>& groups, const PathPairs& pairs,
                       const TravelEstimate& estimate, const OrderMerger& judge)
    : first_block_(first_block),
      freedom_(freedom),
      groups_(groups),
      pairs_(pairs),
      estimate_(estimate),
      judge_(judge),
      order_(std::move(begun)),
      travels_(order_.size()),
      place_(order_.size()) {
  assert(order_.size() == freedom.rules.size());
  for (size_t i = 0; i < order_.size(); ++i) {
    place_[PathAt(i)] = i;
    if (i == 0) continue;
    travels_[i] = Ask(i, order_[i - 1], order_[i]);
    totals_ += travels_[i];
  }
  kept_order_ = order_;
  kept_travels_ = travels_;
  kept_totals_ = totals_;
  changed_begin_ = order_.size();
}

TravelTotals OrderState::Ask(size_t place, const Placement& from, const Placement& to) {
  ++asked_;
  return estimate_(place, from, to);
}

// Whether other paths may come between the one at `place` and the one before it.
bool OrderState::MayCut(size_t place) const { return !freedom_.goes_on[PathAt(place)]; }

// Whether any of `paths` stands at [begin, end).
bool OrderState::AnyBetween(const std::vector<uint32_t>& paths, size_t begin, size_t end) const {
  return std::any_of(paths.begin(), paths.end(),
                     [&](uint32_t path) { return begin <= place_[path] && place_[path] < end; });
}

bool OrderState::MayExchange(size_t begin, size_t middle, size_t end) const {
  if (begin == 0 || end >= size()) return false;
  // Groups come one after the other.
  if (groups_[PathAt(begin)] != groups_[PathAt(end - 1)]) return false;
  if (!MayCut(begin) || !MayCut(middle) || !MayCut(end)) return false;
  if (middle - begin <= end - middle) {
    for (size_t i = begin; i < middle; ++i) {
      if (AnyBetween(pairs_.later[PathAt(i)], middle, end)) return false;
    }
  } else {
    for (size_t i = middle; i < end; ++i) {
      if (AnyBetween(pairs_.earlier[PathAt(i)], begin, middle)) return false;
    }
  }
  return true;
}

bool OrderState::MayTurn(size_t begin, size_t end) const {
  if (begin == 0 || end >= size()) return false;
  if (groups_[PathAt(begin)] != groups_[PathAt(end - 1)]) return false;
  if (!MayCut(end)) return false;
  for (size_t i = begin; i < end; ++i) {
    const PathRule& rule = RuleAt(i);
    if (!MayCut(i) || (!rule.contour && rule.one_way)) return false;
    if (AnyBetween(pairs_.later[PathAt(i)], begin, end)) return false;
  }
  return true;
}

// The path at place `k` of `run`, as it is to be.
Placement OrderState::PlacedIn(const PlaceRun& run, size_t k) const {
  Placement placement = order_[run.turned ? run.end - 1 - k : run.begin + k];
  if (run.turned) placement = Turned(placement);
  if (run.entry) placement.entry = *run.entry;
  return placement;
}

// The travel moves of a run that are new: all of one that is turned, else the travel to it.
size_t OrderState::NewTravels(const PlaceRun& run) {
  return run.turned ? run.size() : std::min<size_t>(run.size(), 1);
}

// What the order comes to with `runs`; leaves the new travel moves in the scratch. Travel moves
// within a run that is not turned stay.
TravelTotals OrderState::TotalsWith(size_t begin, size_t end, const PlaceRuns& runs) {
  asked_travels_.clear();
  TravelTotals totals = totals_;
  const auto exchange = [&](const TravelTotals& was, const TravelTotals& is) {
    totals -= was;
    totals += is;
    asked_travels_.push_back(is);
  };
  Placement before = order_[begin - 1];
  size_t place = begin;
  for (const PlaceRun& run : runs) {
    for (size_t k = 0; k < NewTravels(run); ++k) {
      const Placement placement = PlacedIn(run, k);
      exchange(travels_[run.begin + k], Ask(place + k, before, placement));
      before = placement;
    }
    if (run.size() > 0) before = PlacedIn(run, run.size() - 1);
    place += run.size();
  }
  assert(place == end);
  exchange(travels_[end], Ask(end, before, order_[end]));
  return totals;
}

bool OrderState::DoIfBetter(size_t begin, size_t end, const PlaceRuns& runs, bool any_cost) {
  assert(0 < begin && begin < end && end < size());
  const TravelTotals totals = TotalsWith(begin, end, runs);
  if (!any_cost && !judge_.IsBetter(totals, totals_)) return false;
  totals_ = totals;
  run_.clear();
  new_travels_.clear();
  auto asked = asked_travels_.begin();
  for (const PlaceRun& run : runs) {
    for (size_t k = 0; k < run.size(); ++k) {
      run_.push_back(PlacedIn(run, k));
      new_travels_.push_back(k < NewTravels(run) ? *asked++ : travels_[run.begin + k]);
    }
  }
  new_travels_.push_back(*asked);
  const auto at = static_cast<std::ptrdiff_t>(begin);
  std::copy(run_.begin(), run_.end(), order_.begin() + at);
  std::copy(new_travels_.begin(), new_travels_.end(), travels_.begin() + at);
  for (size_t i = begin; i < end; ++i) place_[PathAt(i)] = i;
  changed_begin_ = std::min(changed_begin_, begin);
  changed_end_ = std::max(changed_end_, end + 1);
  const size_t middle = begin + runs[0].size();
  for (const size_t i : {begin - 1, begin, middle - 1, middle, end - 1, end}) {
    touched_.push_back(PathAt(i));
  }
  return true;
}

std::vector<uint32_t> OrderState::TakeTouched() { return std::exchange(touched_, {}); }

bool OrderState::KeepIfBetter() {
  const bool better = judge_.IsBetter(totals_, kept_totals_);
  for (size_t i = changed_begin_; i < changed_end_; ++i) {
    if (better) {
      kept_order_[i] = order_[i];
      kept_travels_[i] = travels_[i];
    } else {
      order_[i] = kept_order_[i];
      travels_[i] = kept_travels_[i];
      place_[PathAt(i)] = i;
    }
  }
  (better ? kept_totals_ : totals_) = better ? totals_ : kept_totals_;
  changed_begin_ = size();
  changed_end_ = 0;
  return better;
}

}  // namespace traverse::gcode
