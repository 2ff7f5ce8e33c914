// A route under construction by swaps of the children of a plan's any_order nodes.
//
//   before    p -> [A] -> m1 ... m2 -> [B] -> n
//   after     p -> [B] -> m1 ... m2 -> [A] -> n        A, B: children of one node, paths or not
//
// A swap changes four moves (three if A and B are next to each other); within A, within B and
// between them nothing changes. A path that is swapped gets a new entry, for its new neighbors.
// Evaluating takes O(1) and the `before` pairs that A and B are in; applying takes O(what lies from
// A to B), O(1) for two paths. Source: thesis 4.2 (p. 84): position i is swapped with i + 1, ...,
// K.

#ifndef TRAVERSE_ENGINE_WELLER_TABU_SWAP_SEQUENCE_H_
#define TRAVERSE_ENGINE_WELLER_TABU_SWAP_SEQUENCE_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/rng.h"
#include "engine/cost/entry_choice.h"
#include "engine/cost/entry_table.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/weller/tabu/link_costs.h"
#include "engine/weller/tabu/sequence_tree.h"

namespace traverse {

// A swap, and what it would change; or another entry of one path: the two nodes of a raster
// swapped.
struct SwapMove {
  int node = -1;  // of the SequenceTree: of the children, or the leaf that is entered elsewhere
  int i = 0;      // positions of the children in the node's present order, i < j; i == j: a leaf
  int j = 0;
  int entry_i = -1;    // the entry that the path at i would get; -1: not a path
  int entry_j = -1;    // the same of the path at j
  double delta = 0;    // of cost()
  int violations = 0;  // of tree().violations()
};

// The state of the search. Memory: see LinkCosts.
class SwapSequence {
 public:
  // `problem`, its plan, `rules` and `budget` outlive the sequence. The budget is asked meanwhile;
  // once it is exhausted, entries are chosen at once, and are not the best any more.
  SwapSequence(const LayerProblem& problem, const LinkRules& rules, Budget* budget = nullptr);
  SwapSequence(const SwapSequence&) = delete;
  SwapSequence& operator=(const SwapSequence&) = delete;

  // Starts from `route`: every path once, the paths of each node together. O(n log n).
  void Load(const Route& route);
  Route Unload() const;

  // Cost of the moves with the penalties of the link rules. Apply adds deltas, so rounding errors
  // build up until Load or ChooseEntries compute it anew.
  double cost() const { return cost_; }

  // How many moves are against the link rules. O(n).
  int PenalizedLinks() const;

  const SequenceTree& tree() const { return tree_; }

  // The entries at both ends of a node's paths, and the entries next to these (the pseudo-entries
  // of LinkCosts at the ends of the route).
  int entry_before(int node) const { return EntryBefore(tree_.begin(node)); }
  int first_entry(int node) const { return EntryAt(tree_.begin(node)); }
  int last_entry(int node) const { return EntryBefore(tree_.end(node)); }
  int entry_after(int node) const { return EntryAt(tree_.end(node)); }

  // Cost of the moves to and from the paths of `node`: as they are, and if the node stood between
  // the entries `before` and `after`. A path gets the best entry there.
  double PresentCost(int node) const {
    return links_(entry_before(node), first_entry(node)) +
           links_(last_entry(node), entry_after(node));
  }
  double PlacedCost(int node, int before, int after) const {
    return BestBetween(before, node, after).cost;
  }

  // placed[k] = PlacedCost(nodes[k], before, after), but faster.
  void FillPlacedCosts(absl::Span<const int> nodes, int before, int after,
                       absl::Span<double> placed) const;

  // Evaluate(node, i, i + 1).delta, but faster.
  double NeighborDelta(int node, int i) const;

  // REQUIRES: 0 <= i < j < tree().child_count(node).
  SwapMove Evaluate(int node, int i, int j) const;
  void Apply(const SwapMove& move);

  // Entering the path of `leaf` at the best of its other entries. Unset if it has none.
  std::optional<SwapMove> EvaluateReentry(int leaf) const;

  // The best entries for the present order, exactly.
  void ChooseEntries();

  // A random order that keeps all `before` pairs, with the best entries or with random ones.
  void Shuffle(Rng& rng, bool best_entries = true);

 private:
  struct Placed {
    int entry;  // of a path; -1 for other nodes
    double cost;
  };

  int EntryBefore(int position) const {
    return position == 0 ? links_.start() : entries_[static_cast<size_t>(position) - 1];
  }
  int EntryAt(int position) const {
    return position == static_cast<int>(entries_.size()) ? links_.finish()
                                                         : entries_[static_cast<size_t>(position)];
  }
  template <typename Function>
  void ForEnds(int node, int before, int after, const Function& function) const;
  int NearestEntry(int path, std::optional<Point> to) const;
  Placed BestBetween(int before, int node, int after) const;
  std::optional<double> NeighborCost(int x, int y, int before, int after) const;
  void EvaluateNeighbors(int x, int y, SwapMove& move) const;
  void EvaluateApart(int x, int y, SwapMove& move) const;
  void ComputeCost();

  const LayerProblem& problem_;
  EntryTable table_;
  LinkCosts links_;
  mutable Rest rest_;
  EntryChoice choice_;
  SequenceTree tree_;
  std::vector<int> entries_;  // [position in the route]
  std::vector<int> scratch_;
  double cost_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_SWAP_SEQUENCE_H_
