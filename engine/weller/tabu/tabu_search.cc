#include "engine/weller/tabu/tabu_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>

#include "engine/base/rng.h"
#include "engine/base/tolerances.h"
#include "engine/cost/travel_cost.h"
#include "engine/weller/tabu/swap_candidates.h"
#include "engine/weller/tabu/swap_sequence.h"
#include "engine/weller/tabu/swap_table.h"
#include "engine/weller/tabu/tabu_list.h"

namespace traverse {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

// Visits of the sequences kept, all together: 8 bytes each.
constexpr size_t kMostEliteVisits = size_t{8} << 20;

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

// Children in the most `before` pairs that one swap can turn round.
int MostPairs(const SequenceTree& tree) {
  int most = 0;
  for (const int node : tree.movable_nodes()) {
    for (int i = 0; i < tree.child_count(node) && tree.has_before(node); ++i) {
      most = std::max(most, tree.pair_count(tree.child_at(node, i)));
    }
  }
  return 2 * most;
}

// A change of cost that no rounding of costs that hold so much of penalties makes.
double ToleranceFor(double penalties) {
  constexpr double kRoundings = 32;
  return std::max(kImprovementTolerance,
                  kRoundings * std::numeric_limits<double>::epsilon() * penalties);
}

// How long a move stays tabu, or how long the list is. Constant unless reactive.
class Tenure {
 public:
  Tenure(const TabuOptions& options)
      : reactive_(options.reactive),
        lists_(options.published),
        least_(std::max(1.0, options.tenure * options.diversifications)),
        tenure_(least_) {}

  int64_t iterations() const { return std::llround(lists_ ? least_ : tenure_); }

  // Of a list that has `size` moves at first.
  int ListSize(int size) const {
    return lists_ ? static_cast<int>(std::ceil(size * tenure_ / least_)) : size;
  }

  // Takes note of a sequence, known by its cost. True if it was met often enough to leave.
  bool MetTooOften(double cost) {
    if (!reactive_) return false;
    if (met_.size() >= kMostMet) met_.clear();
    const int met = ++met_[std::llround(std::min(cost / kIdentity, kMostIdentities))];
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
  static constexpr double kMostIdentities = 9e18;
  static constexpr size_t kMostMet = 1'000'000;
  static constexpr double kGrowth = 1.25;
  static constexpr double kMostGrowth = 20;
  static constexpr int kQuiet = 100;  // new sequences in a row, after which the tenure shrinks
  static constexpr int kTooOften = 3;

  bool reactive_;
  bool lists_;  // the list grows, not the tenure
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
        sequence_(problem, rules, &budget),
        candidates_(*problem.plan, sequence_.tree(), budget),
        children_(ChildrenOf(sequence_.tree())),
        list_size_(static_cast<int>(std::ceil(options.list_size * children_))),
        list_(list_size_),
        tenure_(options),
        order_penalty_(TravelCost(problem).OfLength(options.order_penalty_mm)),
        link_penalty_(TravelCost(problem).OfLength(rules.penalty_mm)),
        tolerance_(ToleranceFor(link_penalty_ + order_penalty_ * MostPairs(sequence_.tree()))),
        most_elite_(MostElite(options.elite, problem.plan->paths.size())) {
    for (const int node : sequence_.tree().movable_nodes()) {
      const bool small = sequence_.tree().child_count(node) <= SwapCandidates::kAllSwaps;
      tables_.push_back(small ? std::make_unique<SwapTable>(sequence_, node) : nullptr);
    }
    for (int node = 0; options.published && node < sequence_.tree().node_count(); ++node) {
      if (sequence_.tree().path_of(node) >= 0) leaves_.push_back(node);
    }
  }

  TabuResult Run(const Route& start) {
    sequence_.Load(start);
    sequence_.ChooseEntries();
    const double limit =
        options_.published ? options_.diversifications
                           : std::min<double>(options_.diversifications, Orders(sequence_.tree()));
    for (int d = 0; d < limit && !budget_.ExhaustedNow() && !Ended(); ++d) {
      if (d > 0 || options_.published) Diversify();
      ++changes_;
      Intensify();
      ++result_.diversifications;
    }
    if (result_.elite.empty()) Keep();
    // Where moves are longer than the penalty for a pair, no sequence may have kept them all.
    if (result_.elite.empty()) {
      sequence_.Load(start);
      Keep();
    }
    return std::move(result_);
  }

 private:
  static size_t MostElite(int wanted, size_t paths) {
    return std::min(static_cast<size_t>(wanted), 1 + kMostEliteVisits / std::max<size_t>(paths, 1));
  }

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
      sequence_.Shuffle(rng_, !options_.published);
      return;
    }
    sequence_.Load(result_.elite.front().route);
    const SequenceTree& tree = sequence_.tree();
    const auto& nodes = tree.movable_nodes();
    if (nodes.empty()) return;
    int swaps = std::max(3, static_cast<int>(options_.swaps * children_));
    for (int64_t tries = int64_t{4} * swaps; swaps > 0 && tries > 0 && !Ended(); --tries) {
      const int node = nodes[rng_.Below(static_cast<uint32_t>(nodes.size()))];
      const int last = tree.child_count(node) - 1;
      const int i = rng_.Between(0, last - 1);
      const SwapMove move = sequence_.Evaluate(node, i, rng_.Between(i + 1, last));
      if (move.violations > 0) continue;
      sequence_.Apply(move);
      --swaps;
    }
    if (!options_.published) sequence_.ChooseEntries();
  }

  void Intensify() {
    if (!options_.published) {
      list_.Clear();
      list_is_new_ = true;
      Descend();
    }
    double best = kNone;  // of this intensification; `saved_` is that sequence once it was left
    bool at_best = false;
    int stale = 0;
    while (true) {
      if (sequence_.tree().violations() == 0 && sequence_.cost() < best - tolerance_) {
        best = sequence_.cost();
        at_best = true;
        stale = 0;
      } else if (++stale > options_.patience) {
        break;
      }
      const SwapMove move = BestMove();
      if (move.node < 0 || Ended()) break;
      if (at_best && (move.delta > -tolerance_ || move.violations > 0)) {
        saved_ = sequence_.Unload();
        at_best = false;
      }
      Apply(move);
      const bool leaves =
          tenure_.MetTooOften(Penalized(sequence_.cost(), sequence_.tree().violations()));
      list_.Resize(tenure_.ListSize(list_size_));
      if (leaves) break;
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
      double best_delta = -tolerance_;
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
        if (budget_.Exhausted()) return SwapMove();
        ConsiderRow(n, i, best, best_delta);
      }
    }
    if (best.node >= 0) best = sequence_.Evaluate(best.node, best.i, best.j);
    if (options_.published) ConsiderReentries(best, best_delta);
    return best;
  }

  // The two nodes of a raster swapped: what a swap of two rasters does by the way, for one alone.
  void ConsiderReentries(SwapMove& best, double best_delta) {
    for (const int leaf : leaves_) {
      if (budget_.Exhausted()) return;
      const std::optional<SwapMove> move = sequence_.EvaluateReentry(leaf);
      if (!move) continue;
      ++result_.evaluations;
      if (move->delta >= best_delta) continue;
      const bool aspires = sequence_.tree().violations() == 0 &&
                           sequence_.cost() + move->delta < BestCost() - kImprovementTolerance;
      if (list_.Forbids(KeyOf(*move), iteration_) && !aspires) continue;
      best = *move;
      best_delta = move->delta;
    }
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
           sequence_.cost() + delta < BestCost() - tolerance_;
  }

  uint64_t Key(int node, int i, int j) const {
    const auto a = static_cast<uint64_t>(sequence_.tree().child_at(node, i));
    const auto b = static_cast<uint64_t>(sequence_.tree().child_at(node, j));
    return a < b ? a << 32 | b : b << 32 | a;
  }

  uint64_t KeyOf(const SwapMove& move) const {
    const uint64_t leaf = static_cast<uint64_t>(move.node);
    return move.i == move.j ? leaf << 32 | leaf : Key(move.node, move.i, move.j);
  }

  void Apply(const SwapMove& move) {
    const uint64_t key = KeyOf(move);
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
    if (!options_.published) sequence_.ChooseEntries();
    if (sequence_.tree().violations() > 0) return;
    std::vector<TabuElite>& elite = result_.elite;
    const bool full = elite.size() >= most_elite_;
    if (full && sequence_.cost() >= Cost(elite.back()) - tolerance_) return;
    const auto better = std::find_if(elite.begin(), elite.end(), [&](const TabuElite& kept) {
      return sequence_.cost() < Cost(kept) + tolerance_;
    });
    if (better != elite.end() && sequence_.cost() > Cost(*better) - tolerance_) return;
    const int penalized = sequence_.PenalizedLinks();
    elite.insert(better,
                 {sequence_.Unload(), sequence_.cost() - penalized * link_penalty_, penalized});
    if (elite.size() > most_elite_) elite.pop_back();
  }

  const TabuOptions& options_;
  Budget& budget_;
  Rng rng_;
  SwapSequence sequence_;
  SwapCandidates candidates_;                       // of nodes with many children
  std::vector<std::unique_ptr<SwapTable>> tables_;  // [movable node] of the others
  std::vector<int> leaves_;                         // of a published search
  int children_;                                    // of all nodes that can be reordered
  int list_size_;
  TabuList list_;
  Tenure tenure_;
  double order_penalty_;
  double link_penalty_;
  double tolerance_;  // changes of cost nearer to 0 may be rounding
  size_t most_elite_;
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
