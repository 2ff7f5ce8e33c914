#include "engine/proof/tsp/tsp_relaxation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "engine/proof/min_plus.h"

namespace traverse {
namespace {

constexpr double kTiny = 1e-9;  // a value or multiplier below counts as 0
constexpr double kPriceTolerance = 1e-8;
constexpr int kMostIdleRounds = 1;
constexpr double kDivided = 1e-4;  // how far a sum is from 0 and 1

}  // namespace

TspRelaxation::TspRelaxation(const PathTsp& problem)
    : problem_(problem),
      nodes_(problem),
      start_(static_cast<size_t>(problem.ports)),
      port_column_(static_cast<size_t>(problem.ports), -1),
      left_out_(static_cast<size_t>(nodes_.count())),
      has_(static_cast<size_t>(nodes_.count()) * static_cast<size_t>(nodes_.count())),
      is_dear_(has_.size()) {
  AddRowsOfNodes();
}

void TspRelaxation::AddRowsOfNodes() {
  std::vector<LinearProgram::Row> rows;
  std::vector<LinearProgram::Column> columns;
  for (int v = 0; v < nodes_.count(); ++v) {
    const double moves = nodes_.IsChoice(v) ? 0 : nodes_.mate(v) == v ? 2 : 1;
    rows.push_back({moves, moves, {}});
  }
  for (int item = 1; item < nodes_.item_count(); ++item) {
    if (!nodes_.HasChoice(item)) continue;
    const int row = static_cast<int>(rows.size());
    rows.push_back({1, 1, {}});
    for (int p = nodes_.first(item); p < nodes_.first(item + 1); ++p) {
      LinearProgram::Entries entries;
      entries.Add(p, -2);
      entries.Add(row, 1);
      port_column_[static_cast<size_t>(p)] = static_cast<int>(columns.size());
      columns.push_back({0, 0, 1, std::move(entries)});
    }
  }
  lp_.AddRows(rows);
  lp_.AddColumns(columns);
  first_move_ = lp_.column_count();
}

void TspRelaxation::SetStart(const std::vector<double>& start, double forbidden) {
  for (size_t p = 0; p < start.size(); ++p) {
    start_[p] = start[p] == kUnreached ? forbidden : start[p];
  }
  for (int j = 0; j < move_count(); ++j) {
    if (move(j).b == nodes_.start()) lp_.SetCost(ColumnOf(j), MoveCost(move(j)));
  }
}

double TspRelaxation::MoveCost(const Move& move) const {
  if (move.b == nodes_.start()) return start_[static_cast<size_t>(move.a)];
  if (move.b == nodes_.finish()) return problem_.finish[static_cast<size_t>(move.a)];
  return problem_.Cost(move.a, move.b);
}

LinearProgram::Entries TspRelaxation::EntriesOf(const Move& move) const {
  LinearProgram::Entries entries;
  entries.Add(move.a, 1);
  entries.Add(move.b, 1);
  for (const RowOfCut& it : cuts_) {
    const double coefficient = it.cut.Coefficient(nodes_, move);
    if (coefficient != 0) entries.Add(it.row, coefficient);
  }
  for (const RowOfPair& it : pairs_) {
    if (PairOf(move) == it.pair) entries.Add(it.row, 1);
  }
  return entries;
}

void TspRelaxation::AddMoves(const std::vector<Move>& moves) {
  std::vector<LinearProgram::Column> columns;
  for (const Move& move : moves) {
    if (!nodes_.CanJoin(move.a, move.b) || Has(move)) continue;
    has_[Key(move)] = 1;
    columns.push_back({MoveCost(move), 0, 1, EntriesOf(move)});
    moves_.push_back(move);
  }
  lp_.AddColumns(columns);
}

std::vector<double> TspRelaxation::Duals() const {
  std::vector<double> duals;
  for (int row = 0; row < lp_.row_count(); ++row) duals.push_back(lp_.Dual(row));
  return duals;
}

// Calls visit(move, reduced cost) for the moves, in the programme or not, whose reduced cost is at
// most `most`. A cut's multiplier goes to the nodes on its side, so that what is left for pairs of
// nodes only adds to the reduced cost: most pairs need one comparison.
template <typename Cost, typename Visit>
void TspRelaxation::ForEachCheapMove(const std::vector<double>& duals, const Cost& cost,
                                     double most, Budget& budget, const Visit& visit) const {
  const int n = nodes_.count();
  std::vector<double> potential(duals.begin(), duals.begin() + n);
  std::vector<std::pair<const TspCut*, double>> active;  // with what both ends inside cost
  for (const RowOfCut& it : cuts_) {
    const double dual = duals[static_cast<size_t>(it.row)];
    if (!it.cut.crosses) {
      if (dual < 0) active.emplace_back(&it.cut, -dual);
    } else if (dual > 0) {
      active.emplace_back(&it.cut, 2 * dual);
      for (int v = 0; v < n; ++v) {
        if (it.cut.side[static_cast<size_t>(v)] != 0) potential[static_cast<size_t>(v)] += dual;
      }
    }
  }
  // What moves between two items save by the rows of pairs.
  const size_t items = static_cast<size_t>(nodes_.item_count());
  std::vector<double> saved(pairs_.empty() ? 0 : items * items);
  for (const RowOfPair& it : pairs_) {
    const size_t first = static_cast<size_t>(it.pair.first);
    const size_t second = static_cast<size_t>(it.pair.second);
    const double dual = duals[static_cast<size_t>(it.row)];
    saved[first * items + second] = saved[second * items + first] = dual;
  }
  for (int a = 0; a < n; ++a) {
    if (left_out_[static_cast<size_t>(a)] != 0) continue;
    if (budget.Exhausted()) return;
    const size_t item = static_cast<size_t>(nodes_.item(a));
    const double* const saved_of = saved.empty() ? nullptr : saved.data() + item * items;
    for (int b = a + 1; b < n; ++b) {
      if (!nodes_.CanJoin(a, b) || left_out_[static_cast<size_t>(b)] != 0) continue;
      const Move move{a, b};
      if (is_dear_[Key(move)] != 0) continue;
      double reduced =
          cost(move) - potential[static_cast<size_t>(a)] - potential[static_cast<size_t>(b)];
      if (saved_of != nullptr) reduced -= saved_of[nodes_.item(b)];
      for (size_t k = 0; k < active.size() && reduced <= most; ++k) {
        const CutSide& side = active[k].first->side;
        if (side[static_cast<size_t>(a)] != 0 && side[static_cast<size_t>(b)] != 0) {
          reduced += active[k].second;
        }
      }
      if (reduced <= most) visit(move, reduced);
    }
  }
}

void TspRelaxation::AddLowest(std::vector<std::pair<double, Move>>& reduced, int most) {
  std::sort(reduced.begin(), reduced.end(),
            [](const auto& x, const auto& y) { return x.first < y.first; });
  if (reduced.size() > static_cast<size_t>(most)) reduced.resize(static_cast<size_t>(most));
  std::vector<Move> moves;
  for (const auto& [cost, move] : reduced) moves.push_back(move);
  AddMoves(moves);
}

int TspRelaxation::Price(int most, double& missing, Budget& budget) {
  std::vector<std::pair<double, Move>> negative;
  missing = 0;
  const auto cost = [this](const Move& move) { return MoveCost(move); };
  ForEachCheapMove(Duals(), cost, 0, budget, [&](const Move& move, double reduced) {
    if (Has(move)) return;
    missing += reduced;
    if (reduced < -kPriceTolerance) negative.emplace_back(reduced, move);
  });
  AddLowest(negative, most);
  return static_cast<int>(negative.size());
}

int TspRelaxation::PriceInfeasible(int most, Budget& budget) {
  const std::optional<LinearProgram::Contradiction> proof = lp_.FindContradiction();
  if (!proof) return -1;
  std::vector<std::pair<double, Move>> helpful;
  double help = 0;  // what the rows get of all moves outside
  const auto no_cost = [](const Move&) { return 0.0; };
  ForEachCheapMove(proof->multipliers, no_cost, 0, budget, [&](const Move& move, double reduced) {
    if (Has(move) || reduced == 0) return;
    help -= reduced;
    helpful.emplace_back(reduced, move);
  });
  if (help < proof->margin) return 0;
  AddLowest(helpful, most);
  return static_cast<int>(helpful.size());
}

void TspRelaxation::LeaveOutDear(double gap, Budget& budget) {
  // The reduced cost of a move of some blossom's F is higher than what is computed here, so it may
  // stay in for nothing; none is out that should not be.
  std::vector<char> is_dear(has_.size(), 1);
  const auto cost = [this](const Move& move) { return MoveCost(move); };
  ForEachCheapMove(Duals(), cost, gap, budget,
                   [&](const Move& move, double) { is_dear[Key(move)] = 0; });
  if (budget.was_exhausted()) return;
  is_dear_ = std::move(is_dear);
  for (size_t p = 0; p < port_column_.size(); ++p) {
    if (port_column_[p] < 0 || lp_.ReducedCost(port_column_[p]) <= gap) continue;
    left_out_[p] = 1;
    Fix(port_column_[p], false);
  }
  std::vector<int> columns;
  std::vector<Move> kept;
  for (int j = 0; j < move_count(); ++j) {
    if (IsAllowed(move(j))) {
      kept.push_back(move(j));
      continue;
    }
    columns.push_back(ColumnOf(j));
    has_[Key(move(j))] = 0;
  }
  moves_ = std::move(kept);
  lp_.DeleteColumns(columns);
}

void TspRelaxation::AllowAll() {
  std::fill(left_out_.begin(), left_out_.end(), 0);
  std::fill(is_dear_.begin(), is_dear_.end(), 0);
  for (int column = 0; column < column_count(); ++column) Free(column);
  HoldPairs({});
}

TspSolution TspRelaxation::Solution() const {
  TspSolution solution;
  for (int j = 0; j < move_count(); ++j) {
    const double x = lp_.Primal(ColumnOf(j));
    if (x >= kTiny) solution.moves.emplace_back(move(j), x);
  }
  for (const int column : port_column_) {
    solution.ports.push_back(column < 0 ? 1 : lp_.Primal(column));
  }
  return solution;
}

int TspRelaxation::Separate(double violation, int most, Budget& budget) {
  std::vector<TspCut> cuts = ViolatedCuts(nodes_, Solution(), violation, most, budget);
  std::vector<LinearProgram::Row> rows;
  int row = lp_.row_count();
  for (TspCut& cut : cuts) {
    rows.push_back(RowOf(cut));
    if (!cut.crosses) {
      TspCut other = ByMovesOut(cut);
      LinearProgram::Row row_of_other = RowOf(other);
      if (row_of_other.columns.indices.size() < rows.back().columns.indices.size()) {
        cut = std::move(other);
        rows.back() = std::move(row_of_other);
      }
    }
    cuts_.push_back({std::move(cut), row++});
  }
  lp_.AddRows(rows);
  total_cuts_ += static_cast<int>(cuts.size());
  return static_cast<int>(cuts.size());
}

LinearProgram::Row TspRelaxation::RowOf(const TspCut& cut) const {
  LinearProgram::Row row{cut.lower, cut.upper, {}};
  for (const auto& [port, coefficient] : cut.ports) {
    row.columns.Add(port_column_[static_cast<size_t>(port)], coefficient);
  }
  for (int j = 0; j < move_count(); ++j) {
    const double coefficient = cut.Coefficient(nodes_, move(j));
    if (coefficient != 0) row.columns.Add(ColumnOf(j), coefficient);
  }
  return row;
}

void TspRelaxation::DropIdleCuts() {
  std::vector<int> rows;
  std::vector<RowOfCut> kept;
  for (RowOfCut& it : cuts_) {
    it.idle = lp_.RowIsBasic(it.row) ? it.idle + 1 : 0;
    if (it.idle > kMostIdleRounds) {
      rows.push_back(it.row);
    } else {
      kept.push_back(std::move(it));
    }
  }
  cuts_ = std::move(kept);
  DeleteRows(rows);
}

// REQUIRES: no cut or pair has one of the rows. They ascend.
void TspRelaxation::DeleteRows(const std::vector<int>& rows) {
  if (rows.empty()) return;
  const auto less = [&rows](int row) {
    return static_cast<int>(std::lower_bound(rows.begin(), rows.end(), row) - rows.begin());
  };
  for (RowOfCut& it : cuts_) it.row -= less(it.row);
  for (RowOfPair& it : pairs_) it.row -= less(it.row);
  lp_.DeleteRows(rows);
}

TspRelaxation::ItemPair TspRelaxation::PairOf(const Move& move) const {
  const int a = nodes_.item(move.a);
  const int b = nodes_.item(move.b);
  return {std::min(a, b), std::max(a, b)};
}

std::vector<TspRelaxation::RowOfPair>::const_iterator TspRelaxation::Held(
    const ItemPair& pair) const {
  return std::find_if(pairs_.begin(), pairs_.end(),
                      [&pair](const RowOfPair& held) { return held.pair == pair; });
}

std::vector<std::pair<TspRelaxation::ItemPair, double>> TspRelaxation::DividedPairs() const {
  std::map<std::pair<int, int>, std::pair<double, int>> sums;  // of the moves, and how many
  for (const auto& [move, x] : Solution().moves) {
    const ItemPair pair = PairOf(move);
    auto& [sum, count] = sums[{pair.first, pair.second}];
    sum += x;
    ++count;
  }
  std::vector<std::pair<ItemPair, double>> divided;
  for (const auto& [pair, of] : sums) {
    const auto& [sum, count] = of;
    if (pair.first == 0 || count < 2 || sum < kDivided || sum > 1 - kDivided) continue;
    divided.push_back({{pair.first, pair.second}, sum});
  }
  return divided;
}

void TspRelaxation::HoldPairs(const std::vector<ItemPair>& pairs) {
  std::vector<int> rows;
  std::vector<RowOfPair> kept;
  for (const RowOfPair& it : pairs_) {
    if (std::find(pairs.begin(), pairs.end(), it.pair) != pairs.end()) {
      kept.push_back(it);
    } else {
      rows.push_back(it.row);
    }
  }
  std::sort(rows.begin(), rows.end());
  pairs_ = std::move(kept);
  DeleteRows(rows);
  std::vector<LinearProgram::Row> added;
  for (const ItemPair& pair : pairs) {
    const auto is_held = [&pair](const RowOfPair& it) { return it.pair == pair; };
    if (std::any_of(pairs_.begin(), pairs_.end(), is_held)) continue;
    LinearProgram::Row row{0, 1, {}};
    for (int j = 0; j < move_count(); ++j) {
      if (PairOf(move(j)) == pair) row.columns.Add(ColumnOf(j), 1);
    }
    pairs_.push_back({pair, lp_.row_count() + static_cast<int>(added.size())});
    added.push_back(std::move(row));
  }
  if (!added.empty()) lp_.AddRows(added);
}

void TspRelaxation::Fix(const ItemPair& pair, bool in) {
  const auto held = Held(pair);
  assert(held != pairs_.end());
  lp_.SetRowBounds(held->row, in ? 1 : 0, in ? 1 : 0);
}

void TspRelaxation::Free(const ItemPair& pair) {
  const auto held = Held(pair);
  if (held != pairs_.end()) lp_.SetRowBounds(held->row, 0, 1);
}

std::vector<int> TspRelaxation::IntegralPath() const {
  std::vector<std::vector<int>> next(static_cast<size_t>(nodes_.count()));
  for (int j = 0; j < move_count(); ++j) {
    const double x = lp_.Primal(ColumnOf(j));
    if (x < 1e-6) continue;
    if (x < 1 - 1e-6) return {};
    next[static_cast<size_t>(move(j).a)].push_back(move(j).b);
    next[static_cast<size_t>(move(j).b)].push_back(move(j).a);
  }
  std::vector<int> path;
  int from = nodes_.start();
  int at = next[static_cast<size_t>(from)].empty() ? nodes_.finish()
                                                   : next[static_cast<size_t>(from)].front();
  while (at != nodes_.finish() && static_cast<int>(path.size()) < nodes_.item_count()) {
    path.push_back(at);
    const int mate = nodes_.mate(at);
    const std::vector<int>& targets = next[static_cast<size_t>(mate)];
    if (targets.size() != (mate == at ? 2 : 1)) return {};
    const int to = targets.front() == from && mate == at ? targets.back() : targets.front();
    from = mate;
    at = to;
  }
  if (static_cast<int>(path.size()) != nodes_.item_count() - 1) return {};
  return path;
}

}  // namespace traverse
