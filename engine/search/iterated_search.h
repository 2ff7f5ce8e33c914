// Iterated local search: kicks and repairs, until they gain nothing more.
//
//   kick     ... A | B | C | D ...   ->   ... A | D | C | B ...     double bridge, inside one node,
//            or a run of blocks turned (turn_run.h) where the plan has blocks that cannot be
//            reversed
//   repair   local search from the visits at the cuts
//   keep     the result if it costs no more, and by chance if it costs little more, else undo
//            everything; the best route of all is what remains at the end
//
// Local search by sequential moves does not find a double bridge, and does not simply undo it. A
// walk among slightly worse routes escapes from where no single kick leads out (both: Martin, Otto
// and Felten 1991, large-step Markov chains). All work of an iteration is near the cuts: undoing
// uses a log, and only a route better than all before is copied.

#ifndef TRAVERSE_ENGINE_SEARCH_ITERATED_SEARCH_H_
#define TRAVERSE_ENGINE_SEARCH_ITERATED_SEARCH_H_

#include <array>
#include <cstdint>
#include <functional>
#include <limits>

#include "engine/base/budget.h"
#include "engine/base/rng.h"
#include "engine/cost/wall_cost.h"
#include "engine/search/local_search.h"
#include "engine/search/search_state.h"

namespace traverse {

struct IteratedSearchOptions {
  LocalSearchOptions local_search;
  int descent_depth = 2;  // LocalSearchOptions::depth of Descend

  // Iterations without a gain, or with less than least_gain of the cost, that end the search.
  int64_t patience = 1000;
  double least_gain = 0;

  // It also ends when iterations do not pay: when the last third of them, or the last `window` if
  // that is more, gained less than this per iteration, in the unit of the cost; or when all beyond
  // the first `window` together gained less than `earned` times as much over `given_cost`, not
  // counting what `price` says of a route. Questions to `walls`, if any, count as the iterations
  // that they take the time of.
  double least_gain_each = 0;
  double window = 200;
  double given_cost = std::numeric_limits<double>::infinity();
  std::function<double(const Route& route)> price = nullptr;  // saving this is no gain
  double earned = 1;
  const WallCost* walls = nullptr;

  // How much worse a route may be to stay with a chance of 1/e, in mean moves of the route.
  double temperature = 0.2;

  // Kicks cut only next to positions from the first to the last of these. Repairs go beyond them.
  int first_kicked = 1;
  int last_kicked = std::numeric_limits<int>::max();

  // Leaves between the first and the last cut of a kick: least and most, with as many kicks of one
  // order of magnitude as of another. Wide kicks find more on small layers, but their repair costs
  // too much on large ones. A turned run has at most the largest span.
  int least_span = 30;
  int most_span = 400;

  // A kick is the cheapest of so many double bridges chosen at random: it takes less repair, and
  // more often leads to a better route. Shakes take any.
  int bridges = 1;

  // The share of kicks that have the largest span and each cut at the longest of so many moves
  // chosen at random. Between groups of paths far apart, such as holes that are drilled here and
  // there, moves are few and long, and neighbors do not lead from group to group.
  double long_share = 0;
  int long_of = 12;

  // For kicks that turn a run, where those exist: their share of all kicks, the most blocks in a
  // run, and the share of the runs that end near where they begin.
  double turn_share = 0.5;
  int most_turned = 30;
  double near_share = 0.5;
};

class IteratedSearch {
 public:
  // The arguments must outlive the search.
  IteratedSearch(SearchState& state, const NeighborLists& neighbors,
                 const IteratedSearchOptions& options);

  // Runs only local search, from the current route.
  void Descend(Budget& budget);

  // Kicks and repairs the route. Afterwards it is the best one found, never worse than before.
  void Run(Rng& rng, Budget& budget);

  // Kicks the route so many times and repairs it once. It may be worse afterwards.
  void Shake(int kicks, Rng& rng, Budget& budget);

  int64_t iterations() const { return iterations_; }

  // The WallCost::work() that takes as long as an iteration without walls: about 20 us.
  static constexpr double kWallWorkOfIteration = 400;

  // Fewer iterations do not predict the gain of the next ones, whatever their walls cost.
  static constexpr int64_t kLeastIterations = 200;

 private:
  using Cuts = std::array<int, 4>;  // the positions behind them, ascending

  bool Kick(Rng& rng, int bridges, double& delta);
  bool BridgeKick(Rng& rng, int bridges, double& delta);
  bool ChooseBridge(Rng& rng, int bridges, Cuts& cuts) const;
  double BridgeCost(const Cuts& cuts) const;
  bool TurnKick(Rng& rng, double& delta);
  int ChooseRunEnd(Rng& rng, int node, int first) const;
  int ChooseNode(Rng& rng, int leaf) const;
  int ChooseLeaf(Rng& rng) const;
  bool ChooseCuts(Rng& rng, int node, Cuts& cuts) const;
  int ChooseSpan(Rng& rng) const;
  int ChooseCut(Rng& rng, int begin, int span, int tries) const;
  void KeepBest(double cost);

  // The work so far, in iterations without walls.
  double Work() const;
  double Price() const;
  bool IsWorthIt(double work);

  SearchState& state_;
  const NeighborLists& neighbors_;
  const IteratedSearchOptions options_;
  LocalSearch local_search_;
  bool turns_ = false;  // whether there are runs to turn
  int64_t iterations_ = 0;
  double best_cost_ = 0;
  double begun_at_ = 0;   // Work() when Run() began
  double looked_at_ = 0;  // Work(), and the best cost, when the last iterations were judged
  double cost_looked_at_ = 0;
  int64_t iterations_looked_at_ = 0;
  double price_looked_at_ = 0;
  Route best_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_ITERATED_SEARCH_H_
