#include "engine/local_search/iterated_search.h"

#include <algorithm>
#include <cmath>

#include "engine/base/tolerances.h"

namespace traverse {
namespace {

// Places tried for a kick before an iteration goes by without one.
constexpr int kTries = 20;

}  // namespace

IteratedSearch::IteratedSearch(SearchState& state, const NeighborLists& neighbors,
                               const IteratedSearchOptions& options)
    : state_(state), options_(options), local_search_(state, neighbors, options.local_search) {}

void IteratedSearch::Descend(Budget& budget) {
  local_search_.set_depth(options_.descent_depth);
  local_search_.PushAll();
  local_search_.Run(budget);
  local_search_.set_depth(options_.local_search.depth);
  state_.Commit();
}

void IteratedSearch::Run(Rng& rng, Budget& budget) {
  double cost = state_.TotalCost();
  double cost_before = cost;  // the last `patience` iterations
  int64_t since = 0;
  for (int64_t idle = 0; idle < options_.patience && !budget.Exhausted(); ++idle, ++since) {
    if (since == options_.patience) {
      if (cost_before - cost <= options_.least_gain * cost) return;
      cost_before = cost;
      since = 0;
    }
    ++iterations_;
    double delta = 0;
    if (!Kick(rng, delta)) continue;
    delta += local_search_.Run(budget);
    if (delta > kImprovementTolerance) {
      state_.UndoTo(0);
      continue;
    }
    state_.Commit();
    cost += delta;
    if (delta < -kImprovementTolerance) idle = 0;
  }
}

bool IteratedSearch::Kick(Rng& rng, double& delta) {
  const int paths = state_.tree().path_count();
  for (int i = 0; i < kTries; ++i) {
    const int node = ChooseNode(rng, static_cast<int>(rng.Below(static_cast<uint32_t>(paths))));
    int cuts[4];
    if (node < 0 || !ChooseCuts(rng, node, cuts)) continue;
    // A | B | C | D -> A | D | C | B in two exchanges: B with C D, then C with D.
    const SegmentMove whole{SegmentMove::Kind::kExchange, cuts[0], cuts[1], cuts[3] - 1};
    const int after_c = cuts[0] + cuts[2] - cuts[1];
    const int after_d = cuts[0] + cuts[3] - cuts[1];
    const SegmentMove rest{SegmentMove::Kind::kExchange, cuts[0], after_c, after_d - 1};
    if (!state_.Allows(whole)) continue;
    const auto cut_costs = [&](std::initializer_list<int> places) {
      double sum = 0;
      for (const int place : places) {
        sum += state_.StepCost(place - 1);
        local_search_.Push(state_.leaf_at(place - 1));
        local_search_.Push(state_.leaf_at(place));
      }
      return sum;
    };
    delta -= cut_costs({cuts[0], cuts[1], cuts[2], cuts[3]});
    state_.Apply(whole);
    int new_c = after_c;
    if (state_.Allows(rest)) {
      state_.Apply(rest);
      new_c = cuts[0] + cuts[3] - cuts[2];
    }
    delta += cut_costs({cuts[0], new_c, after_d, cuts[3]});
    return true;
  }
  return false;
}

// One of the nodes of free order around a leaf; -1 if there is none.
int IteratedSearch::ChooseNode(Rng& rng, int leaf) const {
  const OrderTree& tree = state_.tree();
  int chosen = -1;
  uint32_t seen = 0;
  for (int node = tree.parent(leaf); node >= 0; node = tree.parent(node)) {
    if (!tree.free_order(node)) continue;
    if (++seen == 1 || rng.Below(seen) == 0) chosen = node;
  }
  return chosen;
}

int IteratedSearch::ChooseSpan(Rng& rng) const {
  const double ratio = static_cast<double>(options_.most_span) / options_.least_span;
  return static_cast<int>(options_.least_span * std::pow(ratio, rng.Unit()));
}

bool IteratedSearch::ChooseCuts(Rng& rng, int node, int (&cuts)[4]) const {
  const OrderTree& tree = state_.tree();
  const int size = tree.size(node);
  const int span = std::min(size, ChooseSpan(rng));
  const int begin = state_.position(node) + rng.Between(0, size - span);
  for (int& cut : cuts) {
    cut = begin + rng.Between(0, span);
    if (cut < state_.position(node) + size) {
      cut = state_.position(tree.ChildHolding(node, state_.leaf_at(cut)));
    }
  }
  std::sort(std::begin(cuts), std::end(cuts));
  return cuts[0] < cuts[1] && cuts[1] < cuts[2] && cuts[2] < cuts[3];
}

}  // namespace traverse
