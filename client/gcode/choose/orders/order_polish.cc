#include "client/gcode/choose/orders/order_polish.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "engine/base/rng.h"
#include "engine/geometry/nearest_point_index.h"

namespace traverse::gcode {
namespace {

// So many near paths are looked at for what may come next.
constexpr size_t kNeighbors = 8;

// Points of a closed path from which near ones are looked for.
constexpr size_t kProbes = 8;

// Runs of these lengths change places, beside those that end near to what follows.
constexpr size_t kShortRun = 3;

// Runs up to this length are turned round.
constexpr size_t kLongestTurned = 50;

// Of the two runs that change places in a kick.
constexpr uint32_t kLongestKicked = 12;

// Travel that costs at most this much more may cost less with other entries.
constexpr double kSlackSeconds = 0.02;

// After so many estimates for each path it is looked whether the last of them were worth it.
constexpr size_t kWindowEach = 300;

}  // namespace

class OrderPolisher::Search {
 public:
  Search(const OrderPolisher& polisher, const std::vector<uint32_t>& groups,
         const OrderMerger& judge, const LayerOrder& begun)
      : polisher_(polisher),
        state_(begun, polisher.first_block_, polisher.freedom_, groups, polisher.pairs_,
               polisher.estimate_, judge),
        queued_(begun.size(), false),
        most_(kMostTravelsEach * begun.size()) {
    for (uint32_t path = 0; path < begun.size(); ++path) Push(path);
  }

  LayerOrder Run(Effort effort) {
    Settle();
    if (effort == Effort::kKick) KickOn();
    return state_.order();
  }

 private:
  // Until the last kicks were not worth it.
  void KickOn() {
    state_.KeepIfBetter();
    Rng rng(StreamSeed(1, polisher_.first_block_));
    const size_t window = kWindowEach * state_.size();
    size_t end = window;
    double score = state_.Score();
    for (size_t failed = 0; !IsOver() && failed < most_;) {
      if (!Kick(rng)) {
        ++failed;
      } else {
        Settle();
        state_.KeepIfBetter();
      }
      if (state_.asked() + failed < end) continue;
      const double least = polisher_.limit_.seconds_per_travel * static_cast<double>(window);
      if (score - state_.Score() < least) break;
      score = state_.Score();
      end += window;
    }
  }

  bool IsOver() const { return state_.asked() >= most_ || polisher_.limit_.work.Ended(); }

  void Push(uint32_t path) {
    if (queued_[path]) return;
    queued_[path] = true;
    queue_.push_back(path);
  }

  void PushTouched() {
    for (const uint32_t path : state_.TakeTouched()) Push(path);
  }

  // Makes better what lies around the paths in the queue, until nothing does.
  void Settle() {
    for (size_t next = 0; next < queue_.size(); ++next) {
      const uint32_t path = queue_[next];
      queued_[path] = false;
      while (!IsOver() && Improve(state_.PlaceOf(path))) PushTouched();
    }
    queue_.clear();
  }

  bool Kick(Rng& rng) {
    if (state_.size() < 5) return false;
    const size_t begin = 1 + rng.Below(static_cast<uint32_t>(state_.size() - 3));
    const size_t middle = begin + 1 + rng.Below(kLongestKicked);
    const size_t end = middle + 1 + rng.Below(kLongestKicked);
    if (end >= state_.size() || !state_.MayExchange(begin, middle, end)) return false;
    state_.DoIfBetter(begin, end, {PlaceRun{middle, end}, PlaceRun{begin, middle}},
                      /*any_cost=*/true);
    PushTouched();
    return true;
  }

  bool Improve(size_t i) { return TryEntries(i) || TryNext(i) || TryBefore(i) || TryTurned(i); }

  const std::vector<uint32_t>& NeighborsAt(size_t place) const {
    return polisher_.neighbors_[state_.PathAt(place)];
  }

  // Where the path at `place` begins and ends.
  Point BeginAt(size_t place) const { return BeginOf(OutlineAt(place), state_.At(place)); }
  Point EndAt(size_t place) const { return EndOf(OutlineAt(place), state_.At(place)); }
  const Outline& OutlineAt(size_t place) const { return polisher_.outlines_[state_.PathAt(place)]; }

  // Other entries of the path at `i`.
  bool TryEntries(size_t i) {
    if (i == 0 || i + 1 >= state_.size()) return false;
    for (const PlaceRun& other : Variants({i, i + 1}, i - 1, i + 1)) {
      if (state_.DoIfBetter(i, i + 1, {other, PlaceRun{}})) return true;
    }
    return false;
  }

  // A short run, which comes to stand between the paths at `before` and `behind`, turned or, if it
  // is one path, with other entries.
  std::vector<PlaceRun> Variants(PlaceRun run, size_t before, size_t behind) const {
    std::vector<PlaceRun> variants;
    if (run.size() == 1) {
      for (const uint32_t entry : EntriesBetween(run.begin, before, behind)) {
        if (entry == state_.At(run.begin).entry) continue;
        run.entry = entry;
        variants.push_back(run);
      }
    } else if (run.size() <= kShortRun && state_.MayTurn(run.begin, run.end)) {
      run.turned = true;
      variants.push_back(run);
    }
    return variants;
  }

  // Those of the path at `i` that may suit it between the paths at `before` and `behind`.
  std::vector<uint32_t> EntriesBetween(size_t i, size_t before, size_t behind) const {
    std::vector<uint32_t> entries = EntriesNear(i, EndAt(before));
    for (const uint32_t entry : EntriesNear(i, BeginAt(behind))) entries.push_back(entry);
    if (!entries.empty()) entries.push_back(0);
    return entries;
  }

  // Of an open path both, of a closed one the one nearest to `point`; none if it has no choice.
  std::vector<uint32_t> EntriesNear(size_t i, Point point) const {
    const PathRule& rule = state_.RuleAt(i);
    if (!rule.contour) return rule.one_way ? std::vector<uint32_t>{} : std::vector<uint32_t>{0, 1};
    if (rule.entries.size() == 1) return {};
    return {polisher_.NearestEntry(state_.PathAt(i), point)};
  }

  // [begin, middle) and [middle, end) change places; what is short also turned, or begun elsewhere.
  bool TryExchange(size_t begin, size_t middle, size_t end) {
    if (begin >= middle || middle >= end || !state_.MayExchange(begin, middle, end)) return false;
    const PlaceRun left{begin, middle};
    const PlaceRun right{middle, end};
    if (state_.DoIfBetter(begin, end, {right, left})) return true;
    for (const PlaceRun& other : Variants(right, begin - 1, begin)) {
      if (state_.DoIfBetter(begin, end, {other, left})) return true;
    }
    for (const PlaceRun& other : Variants(left, end - 1, end)) {
      if (state_.DoIfBetter(begin, end, {right, other})) return true;
    }
    return false;
  }

  // A run that begins with a near path comes behind the one at `i`.
  bool TryNext(size_t i) {
    if (i + 1 >= state_.size()) return false;
    for (const uint32_t near : NeighborsAt(i)) {
      const size_t j = state_.PlaceOf(near);
      if (j == i + 1 || !MayFollow(i, j)) continue;
      // ... i | .. | j .. | ...   or   ... | j .. | .. i | ...
      const bool later = j > i;
      const auto try_up_to = [&](size_t end) {
        return later ? TryExchange(i + 1, j, end) : end <= i && TryExchange(j, end, i + 1);
      };
      for (size_t run = 1; run <= kShortRun; ++run) {
        if (try_up_to(j + run)) return true;
      }
      for (const uint32_t last : NeighborsAt(i + 1)) {
        const size_t end = state_.PlaceOf(last) + 1;
        if (end > j + kShortRun && try_up_to(end)) return true;
      }
    }
    return false;
  }

  // A short run that ends with a near path comes before the one at `i`.
  bool TryBefore(size_t i) {
    if (i == 0) return false;
    for (const uint32_t near : NeighborsAt(i)) {
      const size_t j = state_.PlaceOf(near);
      if (j + 1 == i || !MayLead(j, i)) continue;
      // ... | .. j | .. | i ...   or   ... | i .. | .. j | ...
      for (size_t run = 1; run <= kShortRun && run <= j; ++run) {
        const size_t begin = j + 1 - run;
        if (j < i ? TryExchange(begin, j + 1, i) : begin > i && TryExchange(i, begin, j + 1)) {
          return true;
        }
      }
    }
    return false;
  }

  // The run from behind `i` up to a near path is done backwards.
  bool TryTurned(size_t i) {
    for (const uint32_t near : NeighborsAt(i)) {
      const size_t j = state_.PlaceOf(near);
      if (j <= i + 1 || j - i > kLongestTurned || !state_.MayTurn(i + 1, j + 1)) continue;
      if (!MayGain(i + 1, state_.At(i), Turned(state_.At(j)))) continue;
      if (state_.DoIfBetter(i + 1, j + 1, {PlaceRun{i + 1, j + 1, true}, PlaceRun{}})) return true;
    }
    return false;
  }

  // Whether the travel from the path at `i` to the one at `j`, begun as it may be, is about as
  // cheap as the one that leads on from `i` now.
  bool MayFollow(size_t i, size_t j) {
    if (MayGain(i + 1, state_.At(i), state_.At(j))) return true;
    for (const uint32_t entry : EntriesNear(j, EndAt(i))) {
      if (MayGain(i + 1, state_.At(i), Entered(j, entry))) return true;
    }
    return false;
  }

  // The same of the travel to the path at `i` from the one at `j`.
  bool MayLead(size_t j, size_t i) {
    if (MayGain(i, state_.At(j), state_.At(i))) return true;
    for (const uint32_t entry : EntriesNear(j, BeginAt(i))) {
      if (MayGain(i, Entered(j, entry), state_.At(i))) return true;
    }
    return false;
  }

  bool MayGain(size_t place, const Placement& from, const Placement& to) {
    return state_.ScoreOf(place, from, to) < state_.ScoreOfTravelTo(place) + kSlackSeconds;
  }

  Placement Entered(size_t i, uint32_t entry) const {
    Placement placement = state_.At(i);
    placement.entry = entry;
    return placement;
  }

  const OrderPolisher& polisher_;
  OrderState state_;
  std::vector<uint32_t> queue_;  // paths around which something changed
  std::vector<bool> queued_;     // [path]
  const size_t most_;
};

OrderPolisher::OrderPolisher(uint32_t first_block, const std::vector<Outline>& outlines,
                             const LayerFreedom& freedom, const TravelEstimate& estimate,
                             const PolishLimit& limit)
    : first_block_(first_block),
      outlines_(outlines),
      freedom_(freedom),
      estimate_(estimate),
      limit_(limit),
      neighbors_(outlines.size()),
      pairs_(freedom) {
  FindNeighbors();
}

LayerOrder OrderPolisher::PolishWithin(const std::vector<uint32_t>& groups, const LayerOrder& begun,
                                       const OrderMerger& judge, Effort effort) const {
  assert(groups.size() == outlines_.size());
  if (begun.size() < 3) return begun;
  return Search(*this, groups, judge, begun).Run(effort);
}

uint32_t OrderPolisher::NearestEntry(uint32_t path, Point point) const {
  const std::vector<Point>& points = outlines_[path].points;
  const PathRule& rule = freedom_.rules[path];
  const size_t starts = rule.StartCount(points.size() - 1);
  double least = std::numeric_limits<double>::infinity();
  uint32_t nearest = 0;
  for (size_t k = 0; k < starts; ++k) {
    const double distance = Distance(points[rule.Start(k)], point);
    if (distance >= least) continue;
    least = distance;
    nearest = rule.Start(k);
  }
  return nearest;
}

namespace {

// Points at which paths may begin or end.
struct Probes {
  std::vector<Point> points;
  std::vector<uint32_t> path;  // [point]
  std::vector<size_t> first;   // [path] its first point; one more at the end

  void Add(uint32_t of, Point point) {
    points.push_back(point);
    path.push_back(of);
  }
};

Probes ProbesOf(const std::vector<Outline>& outlines, const LayerFreedom& freedom) {
  Probes probes;
  for (uint32_t path = 0; path < outlines.size(); ++path) {
    probes.first.push_back(probes.points.size());
    const std::vector<Point>& points = outlines[path].points;
    const PathRule& rule = freedom.rules[path];
    if (!rule.contour) {
      probes.Add(path, points.front());
      probes.Add(path, points.back());
    } else {
      const size_t starts = rule.StartCount(points.size() - 1);
      const size_t step = std::max<size_t>(1, (starts + 1) / kProbes);
      for (size_t k = 0; k < starts; k += step) probes.Add(path, points[rule.Start(k)]);
    }
  }
  probes.first.push_back(probes.points.size());
  return probes;
}

// Up to kNeighbors points of the index that are nearest to point `p` of `probes`.
void AddNear(const Probes& probes, size_t p, NearestPointIndex& index,
             std::vector<std::pair<double, uint32_t>>& near) {
  std::vector<int> taken;
  while (taken.size() < kNeighbors && index.size() > 0) {
    const int id = index.Nearest(probes.points[p]);
    index.Remove(id);
    taken.push_back(id);
    near.emplace_back(index.SquaredDistance(id, probes.points[p]),
                      probes.path[static_cast<size_t>(id)]);
  }
  for (const int id : taken) index.Insert(id);
}

}  // namespace

void OrderPolisher::FindNeighbors() {
  if (outlines_.size() < 2) return;
  const Probes probes = ProbesOf(outlines_, freedom_);
  NearestPointIndex index(probes.points);
  for (uint32_t path = 0; path < outlines_.size(); ++path) {
    std::vector<std::pair<double, uint32_t>> near;
    const size_t begin = probes.first[path];
    const size_t end = probes.first[path + 1];
    for (size_t p = begin; p < end; ++p) index.Remove(static_cast<int>(p));
    for (size_t p = begin; p < end; ++p) AddNear(probes, p, index, near);
    for (size_t p = begin; p < end; ++p) index.Insert(static_cast<int>(p));
    std::sort(near.begin(), near.end());
    std::vector<uint32_t>& neighbors = neighbors_[path];
    for (const auto& [distance, other] : near) {
      const bool known = std::find(neighbors.begin(), neighbors.end(), other) != neighbors.end();
      if (!known && neighbors.size() < kNeighbors) neighbors.push_back(other);
    }
  }
}

}  // namespace traverse::gcode
