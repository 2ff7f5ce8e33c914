#include "engine/search/link_search.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/rest.h"
#include "engine/base/tolerances.h"
#include "engine/cost/link_cost.h"
#include "engine/cost/neighbor_lists.h"
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
        queue_(tree_.path_count(), tree_.leaf_count()),
        onward_(Index(tree_.leaf_count())),
        backward_(onward_.size()) {}

  Route Run(const Route& route) {
    state_.Load(route, &budget_);
    Measure(0, state_.last_position());
    for (int i = 1; i < state_.last_position(); ++i) queue_.Push(state_.leaf_at(i));
    while (!queue_.empty() && !budget_.Exhausted()) {
      const int leaf = queue_.Pop();
      while (!budget_.Exhausted() && Improve(leaf)) state_.Commit();
    }
    return state_.Unload();
  }

 private:
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

  // REQUIRES: `from` is not the finish, `to` is not the start.
  double Link(Placed from, Placed to) const {
    const LinkCost::Left left = from.leaf == tree_.start()
                                    ? cost_.Before()
                                    : cost_.After(entries_.VisitOf(from.leaf, from.entry));
    if (to.leaf == tree_.finish()) return cost_.ToFinish(left);
    return cost_.To(left, entries_.VisitOf(to.leaf, to.entry)).cost;
  }

  // The links between the places [first, last], and the sums of all up to each place behind.
  void Measure(int first, int last) {
    Rest rest(&budget_);
    for (int i = first; i < last; ++i) {
      rest(32);
      const bool inner = i > 0 && i + 1 < state_.last_position();
      onward_[Index(i)].link = Link(At(i), At(i + 1));
      backward_[Index(i)].link = inner ? Link(At(i + 1, true), At(i, true)) : 0;
    }
    for (std::vector<Step>* steps : {&onward_, &backward_}) {
      for (int i = first; i < state_.last_position(); ++i) {
        (*steps)[Index(i) + 1].before = (*steps)[Index(i)].before + (*steps)[Index(i)].link;
      }
    }
  }

  double Inside(const Segment& run) const {
    const std::vector<Step>& steps = run.reversed ? backward_ : onward_;
    return steps[Index(run.last)].before - steps[Index(run.first)].before;
  }

  // What the route costs more if the run or runs between `first` and `last` come as `runs`.
  double Delta(int first, int last, absl::Span<const Piece> runs) const {
    double delta = -Inside({first - 1, last + 1});
    Placed at = At(first - 1);
    for (const Piece& run : runs) {
      const Placed begin = EnteredFirst(run);
      delta += Link(at, begin) + Inside(run.places);
      at = run.is_one() ? begin : At(run.places.At(run.places.size() - 1), run.places.reversed);
    }
    return delta + Link(at, At(last + 1));
  }

  Placed EnteredFirst(const Piece& run) const {
    const Placed placed = At(run.places.At(0), run.places.reversed);
    return {placed.leaf, run.entry.value_or(placed.entry)};
  }

  // Sets the entry of the only path of `run`, one of `runs`, that suits its place best.
  double ChooseEntry(int first, int last, Piece& run, absl::Span<const Piece> runs) const {
    double least = Delta(first, last, runs);
    const int leaf = state_.leaf_at(run.places.first);
    std::optional<int> best;
    for (int e = entries_.first(leaf); e < entries_.first(leaf) + entries_.count(leaf); ++e) {
      run.entry = e;
      const double delta = Delta(first, last, runs);
      if (delta >= least) continue;
      least = delta;
      best = e;
    }
    run.entry = best;
    return least;
  }

  // Does `move` if that makes the route cheaper, perhaps with another entry of a path alone in its
  // run.
  bool Try(const SegmentMove& move) {
    if (move.first < 1 || move.last >= state_.last_position()) return false;
    if (!state_.Allows(move)) return false;
    const std::array<Segment, 2> order = move.NewOrder();
    std::array<Piece, 2> both = {Piece{order[0], {}}, Piece{order[1], {}}};
    const absl::Span<Piece> runs = absl::MakeSpan(both).first(Index(move.segment_count()));
    Piece* const alone = runs[0].is_one() ? runs.data() : &runs.back();
    const double delta = alone->is_one() ? ChooseEntry(move.first, move.last, *alone, runs)
                                         : Delta(move.first, move.last, runs);
    if (delta > -kImprovementTolerance) return false;
    const Placed entered = EnteredFirst(*alone);
    state_.Apply(move);
    if (alone->is_one()) state_.SetEntry(entered.leaf, entered.entry);
    Measure(move.first - 1, move.last + 1);
    const int middle = move.segment_count() == 2 ? move.NewMiddle() : move.first;
    for (const int behind : {move.first, middle, move.last + 1}) {
      queue_.Push(state_.leaf_at(behind - 1));
      queue_.Push(state_.leaf_at(behind));
    }
    return true;
  }

  bool TryEntry(int position) {
    Piece run{{position, position}, {}};
    const absl::Span<const Piece> runs = absl::MakeConstSpan(&run, 1);
    if (ChooseEntry(position, position, run, runs) > -kImprovementTolerance) return false;
    if (!run.entry) return false;
    state_.SetEntry(state_.leaf_at(position), *run.entry);
    Measure(position - 1, position + 1);
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
    for (int run = 1; run <= kLongestRun; ++run) {
      // ... low | .. | high .. | ...   .. low | .. | .. high | ...   and so on.
      if (TryExchange(low + 1, high, high + run - 1)) return true;
      if (TryExchange(low + 1, high - run + 1, high)) return true;
      if (TryExchange(low, low + run, high - 1)) return true;
      if (TryExchange(low - run + 1, low + 1, high - 1)) return true;
      if (TryExchange(low, high - run + 1, high)) return true;
      if (TryExchange(low - run + 1, low + 1, high)) return true;
    }
    return false;
  }

  // The runs [first, middle) and [middle, last] change places, also with one of them backwards.
  bool TryExchange(int first, int middle, int last) {
    if (first < 1 || middle <= first || middle > last || last >= state_.last_position()) {
      return false;
    }
    return Try({Kind::kExchange, first, middle, last}) ||
           Try({Kind::kExchangeReverseFirst, first, middle, last}) ||
           Try({Kind::kExchangeReverseSecond, first, middle, last});
  }

  // The link from a place to the next one, and what all those before it cost together.
  struct Step {
    double link = 0;
    double before = 0;
  };

  Budget& budget_;
  const LayerProblem order_;
  const OrderTree tree_;
  const LeafEntries entries_;
  const EndGroups groups_;
  const NeighborLists neighbors_;
  SearchState state_;
  const LinkCost cost_;
  LeafQueue queue_;
  std::vector<Step> onward_;    // [place]
  std::vector<Step> backward_;  // [place] the same of the route backwards, from the next one to it
};

}  // namespace

Route ImproveLinks(const LayerProblem& problem, const Route& route, Budget& budget) {
  assert(problem.links != nullptr && LinksFit(*problem.links, *problem.plan));
  return route.empty() ? route : Search(problem, budget).Run(route);
}

}  // namespace traverse
