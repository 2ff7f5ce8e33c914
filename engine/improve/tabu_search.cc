#include "engine/improve/tabu_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>

#include "engine/base/rng.h"
#include "engine/base/tolerances.h"
#include "engine/cost/travel_cost.h"
#include "engine/improve/swap_candidates.h"
#include "engine/improve/swap_sequence.h"
#include "engine/improve/swap_table.h"
#include "engine/improve/tabu_list.h"

namespace traverse {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

int ChildrenOf(const SequenceTree& tree) {
  int children = 0;
  for (const int node : tree.movable_nodes()) children += tree.child_count(node);
  return children;
}

// How many orders there are, `before` pairs apart.
double Orders(const SequenceTree& tree) {
  double orders = 1;
  for (const int node : tree.movable_nodes()) orders *= std::tgamma(tree.child_count(node) + 1.0);
  return orders;
}

// How long a move stays tabu. Constant unless reactive.
class Tenure {
 public:
  Tenure(const TabuOptions& options)
      : reactive_(options.reactive),
        least_(std::max(1.0, options.tenure * options.diversifications)),
        tenure_(least_) {}

  int64_t iterations() const { return std::llround(tenure_); }

  // Takes note of a sequence, known by its cost. True if it was met often enough to leave.
  bool MetTooOften(double cost) {
    if (!reactive_) return false;
    const int met = ++met_[std::llround(cost / kIdentity)];
    if (met > 1) {
      tenure_ = std::min(tenure_ * kGrowth, least_ * kMostGrowth);
      quiet_ = 0;
    } else if (++quiet_ > kQuiet) {
      tenure_ = std::max(tenure_ / kGrowth, least_);
      quiet_ = 0;
    }
    return met >= kTooOften;
  }

 private:
  static constexpr double kIdentity = 1e-7;  // sequences whose costs agree to this are one
  static constexpr double kGrowth = 1.25;
  static constexpr double kMostGrowth = 20;
  static constexpr int kQuiet = 100;  // new sequences in a row, after which the tenure shrinks
  static constexpr int kTooOften = 3;

  bool reactive_;
  double least_;
  double tenure_;
  int quiet_ = 0;
  std::unordered_map<int64_t, int> met_;
};

class Search {
 public:
  Search(const LayerProblem& problem, const LinkRules& rules, const TabuOptions& options,
         Budget& budget)
      : options_(options),
        budget_(budget),
        rng_(problem.seed),
        sequence_(problem, rules),
        candidates_(*problem.plan, sequence_.tree(), budget),
        children_(ChildrenOf(sequence_.tree())),
        list_(static_cast<int>(std::ceil(options.list_size * children_))),
        tenure_(options),
        order_penalty_(TravelCost(problem.cost).OfLength(options.order_penalty_mm)),
        link_penalty_(TravelCost(problem.cost).OfLength(rules.penalty_mm)) {
    for (const int node : sequence_.tree().movable_nodes()) {
      const bool small = sequence_.tree().child_count(node) <= SwapCandidates::kAllSwaps;
      tables_.push_back(small ? std::make_unique<SwapTable>(sequence_, node) : nullptr);
    }
  }

  TabuResult Run(const Route& start) {
    sequence_.Load(start);
    sequence_.ChooseEntries();
    const double limit = std::min<double>(options_.diversifications, Orders(sequence_.tree()));
    for (int d = 0; d < limit && !budget_.ExhaustedNow() && !Ended(); ++d) {
      if (d > 0) Diversify();
      ++changes_;
      Intensify();
      ++result_.diversifications;
    }
    if (result_.elite.empty()) Keep();
    return std::move(result_);
  }

 private:
  bool Ended() {
    return budget_.Exhausted() ||
           (options_.evaluations > 0 && result_.evaluations >= options_.evaluations);
  }

  double Penalized(double cost, int violations) const { return cost + violations * order_penalty_; }

  double BestCost() const { return result_.elite.empty() ? kNone : Cost(result_.elite.front()); }
  double Cost(const TabuElite& elite) const { return elite.cost + elite.penalized * link_penalty_; }

  void Diversify() {
    if (options_.diversification == TabuOptions::Diversification::kRandom ||
        result_.elite.empty()) {
      sequence_.Shuffle(rng_);
      return;
    }
    sequence_.Load(result_.elite.front().route);
    const SequenceTree& tree = sequence_.tree();
    const auto& nodes = tree.movable_nodes();
    if (nodes.empty()) return;
    int swaps = std::max(3, static_cast<int>(options_.swaps * children_));
    for (int tries = 4 * swaps; swaps > 0 && tries > 0; --tries) {
      const int node = nodes[rng_.Below(static_cast<uint32_t>(nodes.size()))];
      const int last = tree.child_count(node) - 1;
      const int i = rng_.Between(0, last - 1);
      const SwapMove move = sequence_.Evaluate(node, i, rng_.Between(i + 1, last));
      if (move.violations > 0) continue;
      sequence_.Apply(move);
      --swaps;
    }
    sequence_.ChooseEntries();
  }

  void Intensify() {
    list_.Clear();
    list_is_new_ = true;
    Descend();
    double best = kNone;  // of this intensification; `saved_` is that sequence once it was left
    bool at_best = false;
    int stale = 0;
    while (true) {
      if (sequence_.tree().violations() == 0 && sequence_.cost() < best - kImprovementTolerance) {
        best = sequence_.cost();
        at_best = true;
        stale = 0;
      } else if (++stale > options_.patience) {
        break;
      }
      const SwapMove move = BestMove();
      if (move.node < 0 || Ended()) break;
      if (at_best && (move.delta > -kImprovementTolerance || move.violations > 0)) {
        saved_ = sequence_.Unload();
        at_best = false;
      }
      Apply(move);
      if (tenure_.MetTooOften(Penalized(sequence_.cost(), sequence_.tree().violations()))) break;
    }
    if (best == kNone) return;
    if (!at_best) sequence_.Load(saved_);
    Keep();
  }

  // Goes downhill: takes, one position after the other, the best admissible swap with a later
  // position if it gains, until none does.
  void Descend() {
    const auto& nodes = sequence_.tree().movable_nodes();
    size_t settled = 0;  // nodes in a row without a gain
    for (size_t n = 0; settled < nodes.size(); n = (n + 1) % nodes.size()) {
      settled = DescendNode(n) ? 0 : settled + 1;
      if (Ended()) return;
    }
  }

  bool DescendNode(size_t n) {
    const int node = sequence_.tree().movable_nodes()[n];
    const int count = sequence_.tree().child_count(node);
    bool gained = false;
    int settled = 0;  // positions in a row without a gain
    for (int i = 0; settled < count && !Ended(); i = (i + 1) % count) {
      SwapMove best;
      double best_delta = -kImprovementTolerance;
      ConsiderRow(n, i, best, best_delta);
      ++settled;
      if (best.node < 0) continue;
      Apply(sequence_.Evaluate(best.node, best.i, best.j));
      gained = true;
      settled = 0;
    }
    return gained;
  }

  // The best admissible swap; node -1 if there is none.
  SwapMove BestMove() {
    SwapMove best;
    double best_delta = kNone;
    const auto& nodes = sequence_.tree().movable_nodes();
    for (size_t n = 0; n < nodes.size(); ++n) {
      for (int i = 0; i < sequence_.tree().child_count(nodes[n]); ++i) {
        ConsiderRow(n, i, best, best_delta);
      }
    }
    return best.node < 0 ? best : sequence_.Evaluate(best.node, best.i, best.j);
  }

  // Replaces `best` by the best admissible swap of position i of the n-th movable node if that is
  // below `best_delta`, penalties included.
  void ConsiderRow(size_t n, int i, SwapMove& best, double& best_delta) {
    const SequenceTree& tree = sequence_.tree();
    const int node = tree.movable_nodes()[n];
    const bool has_before = tree.has_before(node);
    int considered = 0;
    const auto consider = [&](int j, double cost_delta) {
      ++considered;
      const int first = std::min(i, j);
      const int second = std::max(i, j);
      double delta = cost_delta;
      if (has_before) delta += order_penalty_ * tree.ViolationDelta(node, first, second);
      if (delta >= best_delta) return;
      if (list_.Forbids(Key(node, first, second), iteration_) &&
          !Aspires(node, first, second, cost_delta)) {
        return;
      }
      best = {node, first, second};
      best_delta = delta;
    };
    if (SwapTable* table = tables_[n].get()) {
      table->Update(changes_);
      table->ForRow(i, consider);
    } else {
      candidates_.ForRow(tree, node, i, [&](int j) {
        consider(j, sequence_.Evaluate(node, std::min(i, j), std::max(i, j)).delta);
      });
    }
    result_.evaluations += considered;
  }

  // Aspiration: a tabu move is taken if it leads to a sequence better than any before.
  bool Aspires(int node, int i, int j, double delta) const {
    const SequenceTree& tree = sequence_.tree();
    return tree.violations() + tree.ViolationDelta(node, i, j) == 0 &&
           sequence_.cost() + delta < BestCost() - kImprovementTolerance;
  }

  uint64_t Key(int node, int i, int j) const {
    const auto a = static_cast<uint64_t>(sequence_.tree().child_at(node, i));
    const auto b = static_cast<uint64_t>(sequence_.tree().child_at(node, j));
    return a < b ? a << 32 | b : b << 32 | a;
  }

  void Apply(const SwapMove& move) {
    const uint64_t key = Key(move.node, move.i, move.j);
    const bool aspired = list_.Forbids(key, iteration_);
    const int64_t until = iteration_ + 1 + tenure_.iterations();
    sequence_.Apply(move);
    list_.Add(key, until);
    if (options_.on_move) {
      options_.on_move({static_cast<int>(key >> 32), static_cast<int>(key & 0xffffffffu),
                        iteration_, until, aspired, list_is_new_, sequence_.cost(), BestCost()});
    }
    list_is_new_ = false;
    result_.aspirations += aspired;
    ++result_.moves;
    ++changes_;
    ++iteration_;
  }

  // Adds the present sequence, with its best entries, to the elite if it is good enough.
  void Keep() {
    sequence_.ChooseEntries();
    if (sequence_.tree().violations() > 0) return;
    std::vector<TabuElite>& elite = result_.elite;
    const bool full = static_cast<int>(elite.size()) >= options_.elite;
    if (full && sequence_.cost() >= Cost(elite.back()) - kImprovementTolerance) return;
    const auto better = std::find_if(elite.begin(), elite.end(), [&](const TabuElite& kept) {
      return sequence_.cost() < Cost(kept) + kImprovementTolerance;
    });
    if (better != elite.end() && sequence_.cost() > Cost(*better) - kImprovementTolerance) return;
    const int penalized = sequence_.PenalizedLinks();
    elite.insert(better,
                 {sequence_.Unload(), sequence_.cost() - penalized * link_penalty_, penalized});
    if (static_cast<int>(elite.size()) > options_.elite) elite.pop_back();
  }

  const TabuOptions& options_;
  Budget& budget_;
  Rng rng_;
  SwapSequence sequence_;
  SwapCandidates candidates_;                       // of nodes with many children
  std::vector<std::unique_ptr<SwapTable>> tables_;  // [movable node] of the others
  int children_;                                    // of all nodes that can be reordered
  TabuList list_;
  Tenure tenure_;
  double order_penalty_;
  double link_penalty_;
  int64_t iteration_ = 0;
  int64_t changes_ = 0;  // of the sequence, of any kind
  bool list_is_new_ = true;
  Route saved_;
  TabuResult result_;
};

}  // namespace

TabuResult TabuSearch(const LayerProblem& problem, const LinkRules& rules, const Route& start,
                      const TabuOptions& options, Budget& budget) {
  return Search(problem, rules, options, budget).Run(start);
}

}  // namespace traverse
