// Tabu search over the orders that a plan allows.
//
//   repeat `diversifications` times
//     s = a new start: random, or the best sequence after many swaps         diversification
//     repeat until `patience` moves in a row gained nothing                  intensification
//       s = s after its best swap that is not tabu, or that leads to a
//           sequence better than any before (aspiration); forbid that swap
//
// Source: thesis 2.2.8 (p. 27-31) and 4.2 (p. 82-84), after Glover and Laguna (1998); SPEC 3.5. Two
// penalties: for links against the link rules (LinkRules::penalty_mm), and for each `before` pair
// that a sequence violates. Neither ever is part of a result's cost, and no result violates a pair.

#ifndef TRAVERSE_ENGINE_WELLER_TABU_TABU_SEARCH_H_
#define TRAVERSE_ENGINE_WELLER_TABU_TABU_SEARCH_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/weller/tabu/link_costs.h"

namespace traverse {

// A move that was made, for tests and traces.
struct TabuStep {
  int first = 0;  // numbers of the two children, first < second
  int second = 0;
  int64_t iteration = 0;
  int64_t tabu_until = 0;            // iterations below this may not undo it
  bool aspired = false;              // it was tabu, but chosen nevertheless
  bool new_intensification = false;  // the list was cleared before it
  double cost = 0;                   // after it, with penalties for links
  double best = 0;                   // of all sequences before it; infinite at first
};

struct TabuOptions {
  enum class Diversification {
    kRandom,  // a random sequence
    kSwaps,   // the best sequence so far after random swaps
  };

  int diversifications = 2500;  // >= 1; the first one is the given sequence
  double list_size = 1.5;       // moves in the tabu list, per child of an any_order node
  double tenure = 0.1;          // iterations that a move is tabu, per diversification
  int patience = 3;             // moves without gain that end an intensification
  Diversification diversification = Diversification::kRandom;
  double swaps = 0.3;              // of kSwaps: swaps per child, at least 3
  double order_penalty_mm = 1000;  // for each violated pair, as much as a move of that length

  // Reactive: a sequence that is met again makes the tenure a quarter longer, and one met for the
  // third time ends the intensification; long without repetition the tenure shrinks again.
  bool reactive = false;

  // The search as the thesis prints it, without our additions: the first sequence is random, and so
  // are its entries; no descent comes before the moves; the list is kept from one diversification
  // to the next; there are as many of these as asked for, however few orders there are; entries
  // change only by moves, one of which swaps the two ends of a raster. `reactive` then lengthens
  // the list, as on p. 31, and not the tenure.
  bool published = false;

  // Swaps after which the search ends: on large plans, 2500 diversifications would take minutes. 0:
  // no limit.
  int64_t evaluations = 0;

  int elite = 5;  // how many of the best sequences to return

  std::function<void(const TabuStep&)> on_move = nullptr;
};

// A sequence that was found.
struct TabuElite {
  Route route;
  double cost = 0;    // of the moves, without penalties, in the unit of the problem's cost
  int penalized = 0;  // links against the link rules
};

struct TabuResult {
  // The best sequences, by cost with penalties, best first, no two of the same cost. Empty only if
  // no sequence without violated pairs was met, including the given one.
  std::vector<TabuElite> elite;
  int diversifications = 0;  // done
  int64_t evaluations = 0;   // of swaps
  int64_t moves = 0;         // made
  int64_t aspirations = 0;   // of these, those that were tabu
};

// Searches from `start` (every path once, the paths of each node together), which a published
// search ignores. Deterministic by `problem.seed` unless the budget ends it. A node with up to
// SwapCandidates::kAllSwaps children tries all swaps of two of them; one with more tries those of
// SwapCandidates.
TabuResult TabuSearch(const LayerProblem& problem, const LinkRules& rules, const Route& start,
                      const TabuOptions& options, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_TABU_SEARCH_H_
