#include "engine/search/iterated_search.h"

#include <algorithm>
#include <cmath>

#include "engine/base/tolerances.h"
#include "engine/search/end_groups.h"
#include "engine/search/turn_run.h"

namespace traverse {
namespace {

// Positions tried for a kick before an iteration passes without one.
constexpr int kTries = 20;

}  // namespace

IteratedSearch::IteratedSearch(SearchState& state, const NeighborLists& neighbors,
                               const IteratedSearchOptions& options)
    : state_(state),
      neighbors_(neighbors),
      options_(options),
      local_search_(state, neighbors, options.local_search) {
  const OrderTree& tree = state.tree();
  for (int node = tree.root(); node < tree.item_count(); ++node) {
    turns_ = turns_ || TurnsOnly(tree, node);
  }
}

void IteratedSearch::Descend(Budget& budget) {
  local_search_.set_depth(options_.descent_depth);
  local_search_.PushAll();
  local_search_.Run(budget);
  local_search_.set_depth(options_.local_search.depth);
  state_.Commit();
}

void IteratedSearch::Run(Rng& rng, Budget& budget) {
  double cost = state_.TotalCost();
  KeepBest(cost);
  double best_before = cost;  // the last `patience` iterations
  int64_t since = 0;
  begun_at_ = looked_at_ = Work();
  cost_looked_at_ = cost;
  iterations_looked_at_ = iterations_;
  price_looked_at_ = options_.least_gain_each > 0 ? Price() : 0;
  const double temperature = options_.temperature * cost / state_.last_position();
  for (int64_t idle = 0; idle < options_.patience && !budget.Exhausted(); ++idle, ++since) {
    if (since == options_.patience) {
      if (best_before - best_cost_ <= options_.least_gain * best_cost_) break;
      best_before = best_cost_;
      since = 0;
    }
    if (options_.least_gain_each > 0 && !IsWorthIt(Work())) break;
    ++iterations_;
    double delta = 0;
    if (!Kick(rng, options_.bridges, delta)) continue;
    delta += local_search_.Run(budget, delta);
    if (delta > kImprovementTolerance && rng.Unit() >= std::exp(-delta / temperature)) {
      state_.UndoTo(0);
      continue;
    }
    state_.Commit();
    cost += delta;
    if (cost >= best_cost_ - kImprovementTolerance) continue;
    KeepBest(cost);
    idle = 0;
  }
  if (cost > best_cost_ + kImprovementTolerance) state_.Load(best_);
}

void IteratedSearch::Shake(int kicks, Rng& rng, Budget& budget) {
  double unused = 0;
  for (int i = 0; i < kicks && !budget.Exhausted(); ++i) Kick(rng, 1, unused);
  local_search_.Run(budget);
  state_.Commit();
}

double IteratedSearch::Work() const {
  const double walls = options_.walls != nullptr ? static_cast<double>(options_.walls->work()) : 0;
  return static_cast<double>(iterations_) + walls / kWallWorkOfIteration;
}

double IteratedSearch::Price() const { return options_.price ? options_.price(best_) : 0; }

bool IteratedSearch::IsWorthIt(double work) {
  const double done = work - begun_at_;
  const double gained = std::max(0.0, options_.given_cost - (best_cost_ - price_looked_at_));
  const double least = options_.least_gain_each;
  if (done >= options_.window + gained / (options_.earned * least)) return false;
  const double since = work - looked_at_;
  if (since < std::max(options_.window, done / 3)) return true;
  if (iterations_ - iterations_looked_at_ < kLeastIterations) return true;
  if (cost_looked_at_ - best_cost_ < least * since) return false;
  looked_at_ = work;
  iterations_looked_at_ = iterations_;
  cost_looked_at_ = best_cost_;
  price_looked_at_ = Price();
  return true;
}

void IteratedSearch::KeepBest(double cost) {
  best_cost_ = cost;
  state_.Unload(best_);
}

bool IteratedSearch::Kick(Rng& rng, int bridges, double& delta) {
  if (turns_ && rng.Unit() < options_.turn_share) return TurnKick(rng, delta);
  return BridgeKick(rng, bridges, delta);
}

bool IteratedSearch::BridgeKick(Rng& rng, int bridges, double& delta) {
  for (int i = 0; i < kTries; ++i) {
    Cuts cuts;
    if (!ChooseBridge(rng, bridges, cuts)) continue;
    // A | B | C | D -> A | D | C | B in two exchanges: B with C D, then C with D.
    const SegmentMove whole{SegmentMove::Kind::kExchange, cuts[0], cuts[1], cuts[3] - 1};
    const int after_c = cuts[0] + cuts[2] - cuts[1];
    const int after_d = cuts[0] + cuts[3] - cuts[1];
    const SegmentMove rest{SegmentMove::Kind::kExchange, cuts[0], after_c, after_d - 1};
    if (!state_.Allows(whole)) continue;
    for (const int cut : cuts) {
      delta -= state_.StepCost(cut - 1);
      local_search_.Queue(state_.leaf_at(cut - 1));
      local_search_.Queue(state_.leaf_at(cut));
    }
    state_.Apply(whole);
    int new_c = after_c;
    if (state_.Allows(rest)) {
      state_.Apply(rest);
      new_c = cuts[0] + cuts[3] - cuts[2];
    }
    for (const int place : {cuts[0], new_c, after_d, cuts[3]}) {
      delta += state_.StepCost(place - 1);
      local_search_.PushMove(place - 1);
    }
    return true;
  }
  return false;
}

// The cheapest of so many double bridges inside one node.
bool IteratedSearch::ChooseBridge(Rng& rng, int bridges, Cuts& cuts) const {
  const int node = ChooseNode(rng, ChooseLeaf(rng));
  if (node < 0 || !ChooseCuts(rng, node, cuts)) return false;
  double least = BridgeCost(cuts);
  for (int i = 1; i < bridges; ++i) {
    Cuts others;
    if (!ChooseCuts(rng, node, others)) continue;
    const double cost = BridgeCost(others);
    if (cost >= least) continue;
    least = cost;
    cuts = others;
  }
  return true;
}

// By how much a double bridge makes the route longer, with the entries as they are. The moves that
// it adds ask no walls, which would take longer than the choice is worth.
double IteratedSearch::BridgeCost(const Cuts& cuts) const {
  const auto move_cost = [this](int from, int to) {
    const int leaf = state_.leaf_at(to);
    if (state_.IsFree(leaf)) return 0.0;
    return state_.cost().Base(state_.out(state_.leaf_at(from)), state_.in(leaf));
  };
  double cost = move_cost(cuts[0] - 1, cuts[2]) + move_cost(cuts[3] - 1, cuts[1]) +
                move_cost(cuts[2] - 1, cuts[0]) + move_cost(cuts[1] - 1, cuts[3]);
  for (const int cut : cuts) cost -= state_.StepCost(cut - 1);
  return cost;
}

bool IteratedSearch::TurnKick(Rng& rng, double& delta) {
  const OrderTree& tree = state_.tree();
  for (int i = 0; i < kTries; ++i) {
    const int leaf = ChooseLeaf(rng);
    const int node = ChooseNode(rng, leaf);
    if (node < 0 || !TurnsOnly(tree, node)) continue;
    const int first = state_.position(tree.ChildHolding(node, leaf));
    const int last = ChooseRunEnd(rng, node, first);
    if (last < 0 || last - first >= options_.most_span) continue;
    const auto cost = [&] {
      double sum = 0;
      for (int at = first - 1; at <= last; ++at) sum += state_.StepCost(at);
      return sum;
    };
    delta -= cost();
    TurnRun(state_, node, first, last);
    delta += cost();
    for (int at = first - 1; at <= last + 1; ++at) local_search_.Push(state_.leaf_at(at));
    return true;
  }
  return false;
}

// The last position of a run of children of `node` that begins at `first`: it ends with a block
// near the path before the run, or some blocks on. -1 if there is no such run.
int IteratedSearch::ChooseRunEnd(Rng& rng, int node, int first) const {
  const OrderTree& tree = state_.tree();
  const int node_end = state_.position(node) + tree.size(node);
  const auto past_child = [&](int leaf) {
    const int child = tree.ChildHolding(node, leaf);
    return state_.position(child) + tree.size(child);
  };
  const int second = past_child(state_.leaf_at(first));
  if (rng.Unit() >= options_.near_share) {
    const double blocks = std::pow(static_cast<double>(options_.most_turned), rng.Unit());
    int past = second;
    for (int i = 1; i <= blocks && past < node_end; ++i) past = past_child(state_.leaf_at(past));
    return past > second ? past - 1 : -1;
  }
  const int before = state_.leaf_at(first - 1);
  if (before >= tree.path_count()) return -1;
  auto near = neighbors_.of(EndGroups::GroupOf(before, static_cast<int>(rng.Below(2))));
  if (near.empty()) near = neighbors_.of(EndGroups::GroupOf(before, 0));
  if (near.empty()) return -1;
  const size_t chosen = rng.Below(static_cast<uint32_t>(near.size()));
  const int leaf = EndGroups::LeafOf(near[chosen].group);
  const int at = state_.position(leaf);
  return at >= second && at < node_end ? past_child(leaf) - 1 : -1;
}

int IteratedSearch::ChooseLeaf(Rng& rng) const {
  const int first = options_.first_kicked;
  const int last = std::min(options_.last_kicked, state_.last_position() - 1);
  if (first > 1 || last < state_.last_position() - 1) {
    return state_.leaf_at(rng.Between(first, last));
  }
  return static_cast<int>(rng.Below(static_cast<uint32_t>(state_.tree().path_count())));
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

// The position behind the longest of `tries` moves.
int IteratedSearch::ChooseCut(Rng& rng, int begin, int span, int tries) const {
  int cut = begin + rng.Between(0, span);
  for (int i = 1; i < tries; ++i) {
    const int other = begin + rng.Between(0, span);
    if (state_.StepCost(other - 1) > state_.StepCost(cut - 1)) cut = other;
  }
  return cut;
}

bool IteratedSearch::ChooseCuts(Rng& rng, int node, Cuts& cuts) const {
  const OrderTree& tree = state_.tree();
  const int first = std::max(state_.position(node), options_.first_kicked);
  const int past_node = state_.position(node) + tree.size(node);
  const int size = std::min(past_node - 1, options_.last_kicked) + 1 - first;
  const bool at_long_moves = options_.long_share > 0 && rng.Unit() < options_.long_share;
  const int span = std::min(size, at_long_moves ? options_.most_span : ChooseSpan(rng));
  const int begin = first + rng.Between(0, size - span);
  for (int& cut : cuts) {
    cut = ChooseCut(rng, begin, span, at_long_moves ? options_.long_of : 1);
    if (cut < past_node) {
      cut = state_.position(tree.ChildHolding(node, state_.leaf_at(cut)));
    }
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts[0] < cuts[1] && cuts[1] < cuts[2] && cuts[2] < cuts[3];
}

}  // namespace traverse
