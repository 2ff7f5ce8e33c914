#include "engine/search/link_search.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/rng.h"
#include "engine/base/tolerances.h"
#include "engine/cost/link_cost.h"
#include "engine/cost/neighbor_lists.h"
#include "engine/cost/wall_cost.h"
#include "engine/search/bookkeeping/leaf_queue.h"
#include "engine/search/end_groups.h"
#include "engine/search/entries/leaf_entries.h"
#include "engine/search/order_tree.h"
#include "engine/search/search_state.h"
#include "engine/search/segment_move.h"

namespace traverse {
namespace {

using Kind = SegmentMove::Kind;

// So many near paths are looked at for what may come next.
constexpr int kNeighbors = 8;

// Runs of up to so many paths come elsewhere.
constexpr int kLongestRun = 3;

// A change moves up to so many paths, so that all changes take time that is linear in the paths.
constexpr int kMostMoved = 25'000;

// Runs of up to so many paths change places in a kick; routes of so few paths have none.
constexpr int kLongestKicked = 10;
constexpr int kFewestKicked = 4;

// Kicks go on while one for each path, or so much work for each, gains this share of the cost. Work
// is counted in questions about links, of 25 ns; moving so many numbers takes as long.
constexpr int64_t kWindowEach = 8'000;
constexpr double kLeastGain = 0.005;
constexpr size_t kNumbersMoved = 8;

// The order alone is searched here, whose own costs nobody asks for.
LayerProblem OrderOf(const LayerProblem& problem) {
  LayerProblem order = problem;
  order.cost = CostSpec();
  order.walls = nullptr;
  order.links = nullptr;
  return order;
}

class Search {
 public:
  Search(const LayerProblem& problem, Budget& budget)
      : budget_(budget),
        order_(OrderOf(problem)),
        tree_(*problem.plan, &budget),
        entries_(order_, &budget),
        groups_(entries_, &budget),
        neighbors_(FindNeighbors(tree_, groups_, kNeighbors, budget)),
        state_(order_, tree_, entries_),
        cost_(problem),
        walls_(problem.walls),
        queue_(tree_.path_count(), tree_.leaf_count()),
        onward_(Index(tree_.leaf_count())),
        backward_(onward_) {}

  Route Run(const Route& route, LinkEffort effort) {
    NoteEnds();
    state_.Load(route, &budget_);
    for (int i = 0; i < state_.last_position(); ++i) {
      if (budget_.Exhausted()) return route;
      Measure(i);
    }
    Sum(0, state_.last_position());
    for (int i = 1; i < state_.last_position(); ++i) queue_.Push(state_.leaf_at(i));
    Settle();
    if (effort == LinkEffort::kKick) KickOn();
    return state_.Unload();
  }

 private:
  // Makes better what lies around the paths in the queue, until nothing does.
  void Settle() {
    while (!queue_.empty() && !budget_.Exhausted()) {
      const int leaf = queue_.Pop();
      while (!budget_.Exhausted() && Improve(leaf)) continue;
    }
  }

  double Cost() const { return onward_.Before(state_.last_position()); }

  // Kicks, until the last ones were not worth it.
  void KickOn() {
    state_.Commit();
    const int paths = state_.last_position() - 1;
    if (paths < kFewestKicked) return;
    Rng rng(1);
    std::vector<double> onward = onward_.links;
    std::vector<double> backward = backward_.links;
    changed_ = {state_.last_position(), 0};
    double cost = Cost();
    double cost_before = cost;
    int64_t work_before = Work();
    for (int kicks = 1; !budget_.Exhausted(); ++kicks) {
      if (Kick(rng)) Settle();
      if (queue_.empty() && Cost() <= cost) {
        state_.Commit();
        CopyChanged(onward_.links, onward);
        CopyChanged(backward_.links, backward);
        cost = Cost();
      } else {
        queue_.Clear();
        state_.UndoTo(0);
        CopyChanged(onward, onward_.links);
        CopyChanged(backward, backward_.links);
        if (changed_.first <= changed_.last) Sum(changed_.first, changed_.last);
      }
      ++asked_;
      changed_ = {state_.last_position(), 0};
      if (kicks < paths && Work() - work_before < kWindowEach * paths) continue;
      if (cost_before - cost <= kLeastGain * cost_before) return;
      cost_before = cost;
      work_before = Work();
      kicks = 0;
    }
  }

  // What has changed since the last kick.
  void CopyChanged(const std::vector<double>& from, std::vector<double>& to) const {
    if (changed_.first > changed_.last) return;
    std::copy(from.begin() + changed_.first, from.begin() + changed_.last + 1,
              to.begin() + changed_.first);
  }

  int64_t Work() const { return asked_ + (walls_ != nullptr ? 2 * walls_->work() : 0); }

  // Two short runs change places, whatever it costs.
  bool Kick(Rng& rng) {
    const int first = rng.Between(1, state_.last_position() - 2);
    const int middle = first + rng.Between(1, kLongestKicked);
    const int last = middle + rng.Between(0, kLongestKicked - 1);
    const SegmentMove move{Kind::kExchange, first, middle, last};
    if (last >= state_.last_position() || !state_.Allows(move)) return false;
    Do(move, {});
    return true;
  }

  // A leaf and how it is entered.
  struct Placed {
    int leaf;
    int entry;
  };

  // What a run of the new order does with its paths.
  struct Piece {
    Segment places;
    std::optional<int> entry;  // of its only path, which begins there

    bool is_one() const { return places.size() == 1; }
  };

  static size_t Index(int i) { return static_cast<size_t>(i); }

  Placed At(int position, bool reversed = false) const {
    const int leaf = state_.leaf_at(position);
    const int entry = state_.entry(leaf);
    const bool turns = reversed && entries_.open(leaf) && entries_.count(leaf) == 2;
    return {leaf, turns ? entries_.Reversed(leaf, entry) : entry};
  }

  // How the head leaves each path, and comes to it.
  void NoteEnds() {
    for (int leaf = 0; leaf < tree_.leaf_count(); ++leaf) {
      if (budget_.Exhausted()) return;
      const bool is_path = leaf != tree_.start() && leaf != tree_.finish();
      for (int e = entries_.first(leaf); e < entries_.first(leaf) + entries_.count(leaf); ++e) {
        if (Index(e) >= ends_.size()) ends_.resize(Index(e) + 1);
        if (leaf == tree_.start()) ends_[Index(e)].left = cost_.Before();
        if (!is_path) continue;
        const Visit visit = entries_.VisitOf(leaf, e);
        ends_[Index(e)] = {cost_.After(visit), cost_.BeginOf(visit)};
      }
    }
  }

  // REQUIRES: `from` is not the finish, `to` is not the start.
  double Link(Placed from, Placed to) const {
    ++asked_;
    const LinkCost::Left& left = ends_[Index(from.entry)].left;
    if (to.leaf == tree_.finish()) return cost_.ToFinish(left);
    return cost_.To(left, ends_[Index(to.entry)].begin);
  }
  double LeastLink(Placed from, Placed to) const {
    ++asked_;
    if (to.leaf == tree_.finish()) return 0;
    return cost_.AtLeastTo(ends_[Index(from.entry)].left, ends_[Index(to.entry)].begin);
  }

  // The link from `place` to the next one, and that of the same two backwards.
  void Measure(int place) {
    const bool inner = place > 0 && place + 1 < state_.last_position();
    onward_.links[Index(place)] = Link(At(place), At(place + 1));
    backward_.links[Index(place)] = inner ? Link(At(place + 1, true), At(place, true)) : 0;
  }

  // The links from the places [first, last] have changed.
  void Sum(int first, int last) {
    changed_ = {std::min(changed_.first, first), std::max(changed_.last, last)};
    asked_ += static_cast<int64_t>(onward_.Sum(Index(first), Index(last)) / kNumbersMoved);
    backward_.Sum(Index(first), Index(last));
  }

  // What runs have inside goes with them.
  void MoveLinks(const SegmentMove& move) {
    const auto at = [](std::vector<double>& links, int place) { return links.begin() + place; };
    if (move.exchanges()) {
      for (std::vector<double>* links : {&onward_.links, &backward_.links}) {
        std::rotate(at(*links, move.first), at(*links, move.middle), at(*links, move.last + 1));
      }
    }
    int first = move.first;
    const std::array<Segment, 2> order = move.NewOrder();
    for (int r = 0; r < move.segment_count(); ++r) {
      const int size = order[Index(r)].size();
      if (order[Index(r)].reversed) {
        std::reverse(at(onward_.links, first), at(onward_.links, first + size - 1));
        std::reverse(at(backward_.links, first), at(backward_.links, first + size - 1));
        std::swap_ranges(at(onward_.links, first), at(onward_.links, first + size - 1),
                         at(backward_.links, first));
      }
      first += size;
    }
  }

  double Inside(const Segment& run) const {
    const Direction& direction = run.reversed ? backward_ : onward_;
    return direction.Before(run.last) - direction.Before(run.first);
  }

  // What the route costs more if the places [first, last] come as `runs`, without the links to and
  // from the only path of `alone`, if it is not null and one of them.
  double Delta(int first, int last, absl::Span<const Piece> runs, const Piece* alone) const {
    double delta = -Inside({first - 1, last + 1});
    Placed at = At(first - 1);
    bool counts = true;
    for (const Piece& run : runs) {
      const bool skips = &run == alone;
      const Placed begin = EnteredFirst(run);
      if (counts && !skips) delta += Link(at, begin);
      delta += Inside(run.places);
      at = run.is_one() ? begin : At(run.places.At(run.places.size() - 1), run.places.reversed);
      counts = !skips;
    }
    return counts ? delta + Link(at, At(last + 1)) : delta;
  }

  Placed EnteredFirst(const Piece& run) const {
    const Placed placed = At(run.places.At(0), run.places.reversed);
    return {placed.leaf, run.entry.value_or(placed.entry)};
  }

  // The same with all links, once the only path of `alone`, which comes between `before` and
  // `behind`, is entered where that suits it best. Infinite unless it is a gain.
  double ChooseEntry(double delta, Placed before, Placed behind, Piece& alone) const {
    const int leaf = state_.leaf_at(alone.places.first);
    double least = -delta - kImprovementTolerance;  // what the two links may cost
    if (least <= 0) return std::numeric_limits<double>::infinity();
    for (int e = entries_.first(leaf); e < entries_.first(leaf) + entries_.count(leaf); ++e) {
      const Placed placed{leaf, e};
      if (LeastLink(before, placed) + LeastLink(placed, behind) >= least) continue;
      if (budget_.Exhausted()) break;
      const double links = Link(before, placed) + Link(placed, behind);
      if (links >= least) continue;
      least = links;
      alone.entry = e;
    }
    return alone.entry ? delta + least : std::numeric_limits<double>::infinity();
  }

  // The change of cost by `runs` in the place of [first, last]; sets the entry of a run of one
  // path.
  double BestDelta(int first, int last, absl::Span<Piece> runs) const {
    Piece* const alone = runs[0].is_one() ? runs.data() : &runs.back();
    if (!alone->is_one()) return Delta(first, last, runs, nullptr);
    const bool is_first = alone == runs.data();
    const bool is_last = alone == &runs.back();
    const Segment& other = is_first ? runs.back().places : runs[0].places;
    const Placed before = is_first ? At(first - 1) : At(other.At(other.size() - 1), other.reversed);
    const Placed behind = is_last ? At(last + 1) : At(other.At(0), other.reversed);
    return ChooseEntry(Delta(first, last, runs, alone), before, behind, *alone);
  }

  // Does `move` if that makes the route cheaper, perhaps with another entry of a path alone in its
  // run.
  bool Try(const SegmentMove& move) {
    if (move.last - move.first > kMostMoved) return false;
    if (move.first < 1 || move.last >= state_.last_position()) return false;
    if (budget_.Exhausted() || !state_.Allows(move)) return false;
    const std::array<Segment, 2> order = move.NewOrder();
    std::array<Piece, 2> both = {Piece{order[0], {}}, Piece{order[1], {}}};
    const absl::Span<Piece> runs = absl::MakeSpan(both).first(Index(move.segment_count()));
    if (BestDelta(move.first, move.last, runs) > -kImprovementTolerance) return false;
    Do(move, runs[0].entry ? runs[0] : runs.back());
    return true;
  }

  // `alone`: the path alone in its run, if it has another entry.
  void Do(const SegmentMove& move, const Piece& alone) {
    const int leaf = alone.entry ? state_.leaf_at(alone.places.first) : 0;
    state_.Apply(move);
    if (alone.entry) state_.SetEntry(leaf, *alone.entry);
    MoveLinks(move);
    const int middle = move.segment_count() == 2 ? move.NewMiddle() : move.first;
    for (const int behind : {move.first, middle, move.last + 1}) {
      Measure(behind - 1);
      queue_.Push(state_.leaf_at(behind - 1));
      queue_.Push(state_.leaf_at(behind));
    }
    Sum(move.first - 1, move.last);
  }

  bool TryEntry(int position) {
    Piece run{{position, position}, {}};
    if (BestDelta(position, position, absl::MakeSpan(&run, 1)) > -kImprovementTolerance) {
      return false;
    }
    state_.SetEntry(state_.leaf_at(position), *run.entry);
    Measure(position - 1);
    Measure(position);
    Sum(position - 1, position);
    for (int i = position - 1; i <= position + 1; ++i) queue_.Push(state_.leaf_at(i));
    return true;
  }

  bool Improve(int leaf) {
    if (TryEntry(state_.position(leaf))) return true;
    for (const int end : {0, 1}) {
      if (end == 1 && !entries_.open(leaf)) break;
      for (const NeighborLists::Neighbor& near : neighbors_.of(EndGroups::GroupOf(leaf, end))) {
        if (TryNextTo(state_.position(leaf), state_.position(EndGroups::LeafOf(near.group)))) {
          return true;
        }
      }
    }
    return false;
  }

  // All moves that bring the paths at `i` and `j` next to each other, or the two runs between.
  bool TryNextTo(int i, int j) {
    const int low = std::min(i, j);
    const int high = std::max(i, j);
    // ... low | .. high | ..   and   .. | low .. | high ...   done backwards
    if (Try({Kind::kReverse, low + 1, low + 1, high})) return true;
    if (Try({Kind::kReverse, low, low, high - 1})) return true;
    // One of the two paths comes next to the other, or changes places with what lies between.
    if (TryExchange(low + 1, high, high) || TryExchange(low, low + 1, high - 1) ||
        TryExchange(low, high, high) || TryExchange(low, low + 1, high)) {
      return true;
    }
    // The same of a short run that begins or ends with it.
    for (int run = 2; run <= kLongestRun; ++run) {
      if (TryExchange(low + 1, high, high + run - 1) ||
          TryExchange(low + 1, high - run + 1, high) || TryExchange(low, low + run, high - 1) ||
          TryExchange(low - run + 1, low + 1, high - 1) || TryExchange(low, high - run + 1, high) ||
          TryExchange(low - run + 1, low + 1, high)) {
        return true;
      }
    }
    return false;
  }

  // The runs [first, middle) and [middle, last] change places; a short one also backwards.
  bool TryExchange(int first, int middle, int last) {
    if (first < 1 || middle <= first || middle > last || last >= state_.last_position()) {
      return false;
    }
    // One path alone is turned by its entry.
    const auto is_short = [](int size) { return size > 1 && size <= kLongestRun; };
    return Try({Kind::kExchange, first, middle, last}) ||
           (is_short(middle - first) && Try({Kind::kExchangeReverseFirst, first, middle, last})) ||
           (is_short(last - middle + 1) &&
            Try({Kind::kExchangeReverseSecond, first, middle, last}));
  }

  struct Ends {
    LinkCost::Left left;
    LinkCost::Reached begin;
  };

  // The link from each place to the next one, or from the next one to it in the route backwards.
  class Direction {
   public:
    explicit Direction(size_t places)
        : links(places), within_(places), blocks_(places / kBlock + 2) {}

    // What those from all places before `place` cost together.
    double Before(int place) const {
      return blocks_[Index(place) / kBlock] + within_[Index(place)];
    }

    // Those from the places [first, last] have changed. Returns how many numbers it looked at.
    size_t Sum(size_t first, size_t last) {
      const size_t first_block = first / kBlock;
      for (size_t block = first_block; block * kBlock < links.size(); ++block) {
        const size_t begin = block * kBlock;
        const size_t end = std::min(begin + kBlock, links.size());
        for (size_t i = begin; i + 1 < end && begin <= last; ++i) {
          within_[i + 1] = within_[i] + links[i];
        }
        blocks_[block + 1] = blocks_[block] + within_[end - 1] + links[end - 1];
      }
      return last - first + blocks_.size() - first_block;
    }

    std::vector<double> links;  // [place]

   private:
    static constexpr size_t kBlock = 256;

    std::vector<double> within_;  // [place] what those before it in its block cost
    std::vector<double> blocks_;  // [block] what all blocks before it cost
  };

  Budget& budget_;
  const LayerProblem order_;
  const OrderTree tree_;
  const LeafEntries entries_;
  const EndGroups groups_;
  const NeighborLists neighbors_;
  SearchState state_;
  const LinkCost cost_;
  const WallCost* const walls_;
  std::vector<Ends> ends_;  // [entry]
  mutable int64_t asked_ = 0;
  LeafQueue queue_;
  Direction onward_;
  Direction backward_;
  Segment changed_ = {0, 0};  // places whose links have
};

}  // namespace

Route ImproveLinks(const LayerProblem& problem, const Route& route, LinkEffort effort,
                   Budget& budget) {
  assert(problem.links != nullptr && LinksFit(*problem.links, *problem.plan));
  return route.empty() ? route : Search(problem, budget).Run(route, effort);
}

}  // namespace traverse
