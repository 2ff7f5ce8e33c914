#include "client/gcode/choose/orders/island_turns.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

namespace traverse::gcode {
namespace {

// Where an order has more islands than this, it begins at so many of them, evenly along its time.
constexpr size_t kMostBegins = 12;

// The first stretches of an order, each for half as long as islands rest, or one island.
constexpr size_t kHeadStretches = 4;

// [path] the number of its unit; units begin at the places that `begins` says.
std::vector<uint32_t> UnitsIn(const LayerOrder& order, uint32_t first_block,
                              const std::vector<bool>& begins) {
  std::vector<uint32_t> units(order.size());
  uint32_t unit = 0;
  for (size_t place = 0; place < order.size(); ++place) {
    if (begins[place]) ++unit;
    units[order[place].block - first_block] = unit;
  }
  return units;
}

}  // namespace

class IslandTurns::Maker {
 public:
  Maker(const LayerOrder& given, const std::vector<uint32_t>& islands, double rest_seconds,
        const LayerFreedom& freedom, const TravelEstimate& estimate, const Settle& settle,
        IslandTurns& turns)
      : given_(given),
        rest_seconds_(rest_seconds),
        freedom_(freedom),
        estimate_(estimate),
        settle_(settle),
        turns_(turns),
        first_(given.front().block),
        place_(given.size()) {
    NumberParts(islands);
  }

  // Bases and turns of `order`.
  void Add(const LayerOrder& order) {
    if (IsAllowed(order)) AddBase(order);
    for (const LayerOrder& base : Together(order)) {
      AddBase(Settled(base));
      AddBase(Settled(Backwards(base)));
    }
  }

  // `order` with its islands together, in its own sequence of them and in that of the file; what is
  // allowed of these.
  std::vector<LayerOrder> Together(const LayerOrder& order) {
    if (!IsAllowed(order)) return {};
    std::vector<LayerOrder> together = {InSequence(order, RanksIn(order)),
                                        InSequence(order, RanksIn(given_))};
    std::erase_if(together, [this](const LayerOrder& base) { return !IsAllowed(base); });
    return together;
  }

 private:
  using Base = IslandTurns::Base;
  using Turn = IslandTurns::Turn;
  using Stretch = IslandTurns::Stretch;

  size_t size() const { return given_.size(); }
  uint32_t PathAt(const LayerOrder& order, size_t place) const {
    return order[place].block - first_;
  }

  // A part is what an island has in a group, and what must directly follow a path of it.
  void NumberParts(const std::vector<uint32_t>& islands) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> numbers;
    for (size_t path = 0; path < size(); ++path) {
      if (freedom_.goes_on[path]) {
        part_.push_back(part_.back());
        continue;
      }
      const std::pair key{freedom_.group[path], islands[path]};
      part_.push_back(numbers.try_emplace(key, numbers.size()).first->second);
    }
    parts_ = numbers.size();
  }

  // [part] its rank, as `order` comes to them first.
  std::vector<uint32_t> RanksIn(const LayerOrder& order) const {
    constexpr uint32_t kNone = UINT32_MAX;
    std::vector<uint32_t> ranks(parts_, kNone);
    uint32_t next = 0;
    for (const Placement& placement : order) {
      uint32_t& rank = ranks[part_[placement.block - first_]];
      if (rank == kNone) rank = next++;
    }
    return ranks;
  }

  // The parts one by one; those of a group stay in it, because groups come one after the other.
  LayerOrder InSequence(const LayerOrder& order, const std::vector<uint32_t>& ranks) const {
    LayerOrder sorted = order;
    const auto key = [&](const Placement& placement) {
      const uint32_t path = placement.block - first_;
      return std::pair(freedom_.group[path], ranks[part_[path]]);
    };
    std::ranges::stable_sort(sorted, {}, key);
    return sorted;
  }

  bool IsAllowed(const LayerOrder& order) {
    for (size_t place = 0; place < size(); ++place) {
      const uint32_t path = PathAt(order, place);
      place_[path] = place;
      const bool whole_groups =
          place == 0 || freedom_.group[PathAt(order, place - 1)] <= freedom_.group[path];
      if (!whole_groups) return false;
    }
    return std::all_of(freedom_.ordered.begin(), freedom_.ordered.end(),
                       [&](const auto& pair) { return place_[pair.first] < place_[pair.second]; });
  }

  // [place] whether a unit begins there: no part, and no two paths whose order is fixed, are on
  // both sides.
  std::vector<bool> BeginsOf(const LayerOrder& order) {
    std::vector<std::pair<size_t, size_t>> spans(parts_, {size(), 0});
    for (size_t place = 0; place < size(); ++place) {
      const uint32_t path = PathAt(order, place);
      place_[path] = place;
      auto& [least, most] = spans[part_[path]];
      least = std::min(least, place);
      most = place;
    }
    for (const auto& [before, after] : freedom_.ordered) {
      if (freedom_.group[before] == freedom_.group[after]) {
        spans.emplace_back(place_[before], place_[after]);
      }
    }
    std::vector<int> open(size() + 1, 0);
    for (const auto& [least, most] : spans) {
      if (least >= most) continue;
      ++open[least + 1];
      --open[most + 1];
    }
    std::vector<bool> begins(size());
    int depth = 0;
    for (size_t place = 0; place < size(); ++place) begins[place] = (depth += open[place]) == 0;
    return begins;
  }

  LayerOrder Settled(const LayerOrder& order) {
    return settle_ ? settle_(order, UnitsIn(order, first_, BeginsOf(order))) : order;
  }

  // The units of each group from the last to the first, each as it is.
  LayerOrder Backwards(const LayerOrder& order) {
    const std::vector<bool> begins = BeginsOf(order);
    LayerOrder turned;
    turned.reserve(size());
    for (size_t begin = 0; begin < size();) {
      const size_t end = GroupEnd(order, begin);
      size_t unit_end = end;
      for (size_t place = end; place-- > begin;) {
        if (!begins[place]) continue;
        turned.insert(turned.end(), order.begin() + static_cast<std::ptrdiff_t>(place),
                      order.begin() + static_cast<std::ptrdiff_t>(unit_end));
        unit_end = place;
      }
      begin = end;
    }
    return turned;
  }

  size_t GroupEnd(const LayerOrder& order, size_t place) const {
    const uint32_t group = freedom_.group[PathAt(order, place)];
    while (place < size() && freedom_.group[PathAt(order, place)] == group) ++place;
    return place;
  }

  void AddBase(const LayerOrder& order) {
    if (std::ranges::find(turns_.bases_, order, &Base::order) != turns_.bases_.end()) return;
    Base base;
    base.order = order;
    base.begins = BeginsOf(order);
    links_.assign(size(), {});
    TravelTotals totals;
    for (size_t place = 1; place < size(); ++place) {
      links_[place] = estimate_(place, order[place - 1], order[place]);
      totals += links_[place];
    }
    for (const TravelTotals& link : links_) base.link_seconds.push_back(SecondsOf(link));
    const auto number = static_cast<uint32_t>(turns_.bases_.size());
    turns_.bases_.push_back(std::move(base));
    turns_.turns_.push_back(TurnOf(number, {{0, size()}}, totals));
    AddTurns(number, totals);
    AddHeads(number, totals);
  }

  // Of the first group that has a choice, and of the last one.
  void AddTurns(uint32_t number, const TravelTotals& totals) {
    const LayerOrder order = turns_.bases_[number].order;
    std::vector<std::pair<size_t, size_t>> groups;
    for (size_t begin = 0; begin < size();) {
      const size_t end = GroupEnd(order, begin);
      const std::vector<bool>& begins = turns_.bases_[number].begins;
      const auto from = begins.begin() + static_cast<std::ptrdiff_t>(begin);
      if (std::count(from, from + static_cast<std::ptrdiff_t>(end - begin), true) > 1) {
        groups.emplace_back(begin, end);
      }
      begin = end;
    }
    if (groups.empty()) return;
    AddTurnsOf(number, groups.front(), totals);
    if (groups.size() > 1) AddTurnsOf(number, groups.back(), totals);
  }

  void AddTurnsOf(uint32_t number, const std::pair<size_t, size_t>& group,
                  const TravelTotals& totals) {
    const auto [first, last] = group;
    const Base& base = turns_.bases_[number];
    std::vector<std::pair<size_t, Turn>> all;  // with the place at which each begins
    for (size_t middle = first + 1; middle < last; ++middle) {
      if (!base.begins[middle]) continue;
      all.emplace_back(middle, TurnOf(number, {{middle, last}, {first, middle}}, totals));
    }
    if (all.size() <= kMostBegins) {
      for (const auto& [begin, turn] : all) turns_.turns_.push_back(turn);
      return;
    }
    // The best one of each part.
    std::vector<double> at(last - first, 0);
    for (size_t place = first + 1; place < last; ++place) {
      at[place - first] = at[place - first - 1] + SecondsOfPath(base.order[place - 1]);
    }
    const double whole = at.back() + SecondsOfPath(base.order[last - 1]);
    std::vector<const Turn*> best(kMostBegins, nullptr);
    for (const auto& [begin, turn] : all) {
      const double share = whole > 0 ? at[begin - first] / whole : 0;
      const auto part = std::min(static_cast<size_t>(share * kMostBegins), kMostBegins - 1);
      const bool better = best[part] == nullptr || turn.totals.seconds < best[part]->totals.seconds;
      if (better) best[part] = &turn;
    }
    for (const Turn* turn : best) {
      if (turn != nullptr) turns_.turns_.push_back(*turn);
    }
    // And the one that begins where the file does: if those of all layers do, islands rest about as
    // long as in the file.
    const auto given =
        std::ranges::find(base.order, given_[first].block, &Placement::block) - base.order.begin();
    auto begin = static_cast<size_t>(given);
    while (!base.begins[begin]) --begin;
    const auto found = std::ranges::find(all, begin, &std::pair<size_t, Turn>::first);
    if (found != all.end()) turns_.turns_.push_back(found->second);
  }

  // The first stretches of the first group in all other sequences.
  void AddHeads(uint32_t number, const TravelTotals& totals) {
    const Base& base = turns_.bases_[number];
    const size_t end = GroupEnd(base.order, 0);
    std::vector<std::pair<size_t, size_t>> head;
    for (size_t begin = 0; begin < end && head.size() < kHeadStretches;) {
      double seconds = 0;
      size_t place = begin;
      do {
        seconds += SecondsOfPath(base.order[place++]);
      } while (place < end && (!base.begins[place] || seconds < rest_seconds_ / 2));
      head.emplace_back(begin, place);
      begin = place;
    }
    std::vector<std::pair<size_t, size_t>> sequence = head;
    while (std::next_permutation(sequence.begin(), sequence.end())) {
      Turn turn = TurnOf(number, sequence, totals);
      turn.head = true;
      turns_.turns_.push_back(std::move(turn));
    }
  }

  double SecondsOfPath(const Placement& placement) const {
    return turns_.clock_.path_seconds[placement.block - first_];
  }

  // The base with `sequence`, which are stretches that adjoin, in place of these.
  Turn TurnOf(uint32_t number, const std::vector<std::pair<size_t, size_t>>& sequence,
              const TravelTotals& totals) {
    const LayerOrder& order = turns_.bases_[number].order;
    Turn turn{.base = number, .totals = totals};
    size_t place = 0;
    size_t before = size();  // in the base
    const auto add = [&](size_t from, size_t to) {
      if (from == to) return;
      Stretch stretch{static_cast<uint32_t>(from), static_cast<uint32_t>(to), 0};
      // The link to what was there is in the totals.
      if (from > 0) turn.totals -= links_[from];
      if (before < size()) {
        const bool stays = before + 1 == from;
        const TravelTotals link =
            stays ? links_[from] : estimate_(place, order[before], order[from]);
        turn.totals += link;
        stretch.link_seconds = SecondsOf(link);
      }
      turn.stretches.push_back(stretch);
      place += to - from;
      before = to - 1;
    };
    const auto [begin, end] = std::minmax_element(sequence.begin(), sequence.end());
    add(0, begin->first);
    for (const auto& [from, to] : sequence) add(from, to);
    add(end->second, size());
    return turn;
  }

  float SecondsOf(const TravelTotals& link) const {
    return static_cast<float>(turns_.clock_.TravelSeconds(link.mm, link.retractions));
  }

  const LayerOrder& given_;
  const double rest_seconds_;
  const LayerFreedom& freedom_;
  const TravelEstimate& estimate_;
  const Settle& settle_;
  IslandTurns& turns_;
  const uint32_t first_;
  std::vector<size_t> place_;   // [path] scratch
  std::vector<uint32_t> part_;  // [path]
  size_t parts_ = 0;
  std::vector<TravelTotals> links_;  // [place] of the base at hand
};

IslandTurns::IslandTurns(const LayerOrder& given, const std::vector<LayerOrder>& found,
                         const std::vector<std::vector<uint32_t>>& islands, double rest_seconds,
                         const LayerFreedom& freedom, const TravelEstimate& estimate,
                         const OrderMerger& judge, LayerClock clock, const Settle& settle)
    : clock_(std::move(clock)), first_block_(given.front().block) {
  assert(clock_.path_seconds.size() == given.size());
  std::vector<LayerOrder> together;
  for (const std::vector<uint32_t>& told_apart : islands) {
    Maker maker(given, told_apart, rest_seconds, freedom, estimate, settle, *this);
    for (const auto* orders : {&std::as_const(together), &found}) {
      const size_t first = turns_.size();
      for (const LayerOrder& order : *orders) maker.Add(order);
      KeepBest(judge, first);
    }
    // Then each island of what counts as one.
    for (const LayerOrder& order : found) {
      for (LayerOrder& base : maker.Together(order)) together.push_back(std::move(base));
    }
  }
}

void IslandTurns::KeepBest(const OrderMerger& judge, size_t first) {
  std::vector<Turn> turns(turns_.begin() + static_cast<std::ptrdiff_t>(first), turns_.end());
  turns_.resize(first);
  std::erase_if(turns, [&](const Turn& turn) { return judge.Excess(turn.totals) > 0; });
  std::ranges::stable_sort(turns, {}, [&](const Turn& turn) { return judge.Score(turn.totals); });
  size_t kept[2] = {0, 0};
  std::erase_if(turns, [&](const Turn& turn) { return ++kept[turn.head] > kMostOfAKind; });
  turns_.insert(turns_.end(), turns.begin(), turns.end());
}

LayerOrder IslandTurns::OrderOf(size_t turn) const {
  const auto base = bases_[turns_[turn].base].order.begin();
  LayerOrder order;
  for (const Stretch& stretch : turns_[turn].stretches) {
    order.insert(order.end(), base + stretch.begin, base + stretch.end);
  }
  return order;
}

std::vector<double> IslandTurns::MomentsOf(size_t turn) const {
  const Base& base = bases_[turns_[turn].base];
  std::vector<double> moments;
  double at = 0;
  for (const Stretch& stretch : turns_[turn].stretches) {
    for (size_t place = stretch.begin; place < stretch.end; ++place) {
      at += place == stretch.begin ? stretch.link_seconds : base.link_seconds[place];
      moments.push_back(at);
      at += clock_.path_seconds[base.order[place].block - first_block_];
      moments.push_back(at);
    }
  }
  return moments;
}

std::vector<uint32_t> IslandTurns::UnitsOf(size_t turn) const {
  const Base& base = bases_[turns_[turn].base];
  return UnitsIn(base.order, first_block_, base.begins);
}

}  // namespace traverse::gcode
