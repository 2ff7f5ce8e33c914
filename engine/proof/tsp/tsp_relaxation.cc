#include "engine/proof/tsp/tsp_relaxation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/proof/min_plus.h"

namespace traverse {
namespace {

constexpr double kTiny = 1e-9;  // a value or multiplier below counts as 0
constexpr double kPriceTolerance = 1e-8;
constexpr int kMostIdleRounds = 8;

}  // namespace

TspRelaxation::TspRelaxation(const PathTsp& problem)
    : problem_(problem),
      start_(static_cast<size_t>(problem.ports)),
      item_(static_cast<size_t>(problem.ports) + 2),
      has_(static_cast<size_t>(problem.ports + 2) * static_cast<size_t>(problem.ports + 2)) {
  for (int p = 0; p < problem.ports; ++p) {
    const int mate = problem.mate[static_cast<size_t>(p)];
    item_[static_cast<size_t>(p)] = mate < p ? item_[static_cast<size_t>(mate)] : item_count_++;
    const double degree = mate == p ? 2 : 1;
    lp_.AddRow(degree, degree, {});
  }
  lp_.AddRow(1, 1, {});
  lp_.AddRow(1, 1, {});
}

bool TspRelaxation::IsPossible(int a, int b) const {
  return a != b && item_[static_cast<size_t>(a)] != item_[static_cast<size_t>(b)];
}

void TspRelaxation::SetStart(const std::vector<double>& start, double forbidden) {
  for (size_t p = 0; p < start.size(); ++p) {
    start_[p] = start[p] == kUnreached ? forbidden : start[p];
  }
  for (size_t j = 0; j < moves_.size(); ++j) {
    if (moves_[j].b == start_node()) lp_.SetCost(static_cast<int>(j), MoveCost(moves_[j]));
  }
}

double TspRelaxation::MoveCost(const Move& move) const {
  if (move.b == start_node()) return start_[static_cast<size_t>(move.a)];
  if (move.b == finish_node()) return problem_.finish[static_cast<size_t>(move.a)];
  return problem_.Cost(move.a, move.b);
}

double TspRelaxation::Coefficient(const Cut& cut, const Move& move) const {
  const bool a = cut.side[static_cast<size_t>(move.a)] != 0;
  const bool b = cut.side[static_cast<size_t>(move.b)] != 0;
  if (cut.is_subtour) return a && b ? 1 : 0;
  if (a == b) return 0;
  for (const Move& odd : cut.odd) {
    if (odd.a == move.a && odd.b == move.b) return -1;
  }
  return 1;
}

LinearProgram::Entries TspRelaxation::ColumnOf(const Move& move) const {
  LinearProgram::Entries entries;
  entries.Add(move.a, 1);
  entries.Add(move.b, 1);
  for (const Cut& cut : cuts_) {
    const double coefficient = Coefficient(cut, move);
    if (coefficient != 0) entries.Add(cut.row, coefficient);
  }
  return entries;
}

void TspRelaxation::AddMove(const Move& move) {
  if (Has(move) || !IsPossible(move.a, move.b)) return;
  has_[Key(move)] = 1;
  lp_.AddColumn(MoveCost(move), 0, 1, ColumnOf(move));
  moves_.push_back(move);
}

// Calls visit(move, reduced cost) for the moves, in the programme or not, whose reduced cost is at
// most `most`. A cut's multiplier goes to the nodes on its side, so that what is left for pairs of
// nodes only adds to the reduced cost: most pairs need one comparison.
template <typename Visit>
void TspRelaxation::ForEachCheapMove(double most, const Visit& visit) {
  const int n = node_count();
  std::vector<double> potential(static_cast<size_t>(n));
  for (int v = 0; v < n; ++v) potential[static_cast<size_t>(v)] = lp_.Dual(v);
  std::vector<std::pair<const Cut*, double>> active;  // with what both ends inside cost
  for (const Cut& cut : cuts_) {
    const double dual = lp_.Dual(cut.row);
    if (cut.is_subtour) {
      if (dual < 0) active.emplace_back(&cut, -dual);
    } else if (dual > 0) {
      active.emplace_back(&cut, 2 * dual);
      for (int v = 0; v < n; ++v) {
        if (cut.side[static_cast<size_t>(v)] != 0) potential[static_cast<size_t>(v)] += dual;
      }
    }
  }
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      if (!IsPossible(a, b)) continue;
      const Move move{a, b};
      double reduced =
          MoveCost(move) - potential[static_cast<size_t>(a)] - potential[static_cast<size_t>(b)];
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

int TspRelaxation::Price(int most, double& missing) {
  std::vector<std::pair<double, Move>> negative;
  missing = 0;
  ForEachCheapMove(0, [&](const Move& move, double reduced) {
    if (Has(move)) return;
    missing += reduced;
    if (reduced < -kPriceTolerance) negative.emplace_back(reduced, move);
  });
  std::sort(negative.begin(), negative.end(),
            [](const auto& x, const auto& y) { return x.first < y.first; });
  const int count = std::min(most, static_cast<int>(negative.size()));
  for (int i = 0; i < count; ++i) AddMove(negative[static_cast<size_t>(i)].second);
  return count;
}

void TspRelaxation::AllowAll() {
  for (int j = 0; j < move_count(); ++j) lp_.SetColumnBounds(j, 0, 1);
}

bool TspRelaxation::Restrict(double gap, int most_new) {
  std::vector<char> cheap(has_.size());
  std::vector<Move> added;
  ForEachCheapMove(gap, [&](const Move& move, double) {
    cheap[Key(move)] = 1;
    if (!Has(move)) added.push_back(move);
  });
  if (static_cast<int>(added.size()) > most_new) return false;
  // The reduced cost of a move of some blossom's F is higher than what was computed above, so it
  // may stay in for nothing; none is out that should not be.
  for (int j = 0; j < move_count(); ++j) {
    if (cheap[Key(move(j))] == 0) lp_.SetColumnBounds(j, 0, 0);
  }
  for (const Move& move : added) AddMove(move);
  return true;
}

SupportGraph TspRelaxation::ItemGraph() const {
  SupportGraph graph;
  graph.nodes = item_count_;
  for (int j = 0; j < move_count(); ++j) {
    const double x = lp_.Primal(j);
    if (x < kTiny) continue;
    graph.edges.push_back(
        {item_[static_cast<size_t>(move(j).a)], item_[static_cast<size_t>(move(j).b)], x});
  }
  return graph;
}

SupportGraph TspRelaxation::PortGraph(std::vector<int>& move_of_edge) const {
  SupportGraph graph;
  graph.nodes = node_count();
  for (int j = 0; j < move_count(); ++j) {
    const double x = lp_.Primal(j);
    if (x < kTiny) continue;
    graph.edges.push_back({move(j).a, move(j).b, std::min(1.0, x)});
    move_of_edge.push_back(j);
  }
  for (int p = 0; p < problem_.ports; ++p) {
    const int mate = problem_.mate[static_cast<size_t>(p)];
    if (mate > p) graph.edges.push_back({p, mate, 1});
  }
  graph.edges.push_back({start_node(), finish_node(), 1});
  return graph;
}

int TspRelaxation::Separate(double violation, int most) {
  int added = 0;
  for (const CutSide& items : SmallCuts(ItemGraph(), 2 - violation)) {
    if (added++ >= most) break;
    AddSubtourCut(items);
  }
  if (added > 0) return added;
  std::vector<int> move_of_edge;
  const SupportGraph graph = PortGraph(move_of_edge);
  for (const CutSide& side : OddCuts(graph, violation)) {
    if (added >= most) break;
    double sum = 0;
    std::vector<Move> odd;
    // All fixed edges that cross are in F: with one that is not the sum is at least 1.
    for (const int edge : BestOddSet(graph, side, sum)) {
      if (edge < static_cast<int>(move_of_edge.size())) {
        odd.push_back(move(move_of_edge[static_cast<size_t>(edge)]));
      }
    }
    AddBlossomCut(side, odd);
    ++added;
  }
  return added;
}

void TspRelaxation::AddSubtourCut(const CutSide& items) {
  Cut cut;
  cut.is_subtour = true;
  // x(moves within S) <= |S| - 1, for the smaller side; the depot's side counts the depot's edge.
  const auto inside = std::count(items.begin(), items.end(), 1);
  const bool other = 2 * inside > item_count_;
  for (const int item : item_) {
    const bool in = items[static_cast<size_t>(item)] != 0;
    cut.side.push_back(in != other ? 1 : 0);
  }
  const double upper = static_cast<double>(other ? item_count_ - inside : inside) - 1;
  AddCut(std::move(cut), -LinearProgram::kInfinity, upper);
}

void TspRelaxation::AddBlossomCut(const CutSide& nodes, const std::vector<Move>& odd) {
  Cut cut;
  cut.side = nodes;
  cut.odd = odd;
  AddCut(std::move(cut), 1 - static_cast<double>(odd.size()), LinearProgram::kInfinity);
}

void TspRelaxation::AddCut(Cut cut, double lower, double upper) {
  LinearProgram::Entries entries;
  for (int j = 0; j < move_count(); ++j) {
    const double coefficient = Coefficient(cut, move(j));
    if (coefficient != 0) entries.Add(j, coefficient);
  }
  cut.row = lp_.AddRow(lower, upper, entries);
  cuts_.push_back(std::move(cut));
  ++total_cuts_;
}

void TspRelaxation::DropIdleCuts() {
  std::vector<int> rows;
  std::vector<Cut> kept;
  for (Cut& cut : cuts_) {
    cut.idle = lp_.RowIsBasic(cut.row) ? cut.idle + 1 : 0;
    if (cut.idle > kMostIdleRounds) {
      rows.push_back(cut.row);
    } else {
      kept.push_back(std::move(cut));
    }
  }
  cuts_ = std::move(kept);
  if (rows.empty()) return;
  for (Cut& cut : cuts_) {
    cut.row -= static_cast<int>(std::lower_bound(rows.begin(), rows.end(), cut.row) - rows.begin());
  }
  lp_.DeleteRows(rows);
}

std::vector<int> TspRelaxation::IntegralPath() const {
  std::vector<std::vector<int>> next(static_cast<size_t>(node_count()));
  for (int j = 0; j < move_count(); ++j) {
    const double x = lp_.Primal(j);
    if (x < 1e-6) continue;
    if (x < 1 - 1e-6) return {};
    next[static_cast<size_t>(move(j).a)].push_back(move(j).b);
    next[static_cast<size_t>(move(j).b)].push_back(move(j).a);
  }
  std::vector<int> path;
  int from = start_node();
  int at = next[static_cast<size_t>(from)].empty() ? finish_node()
                                                   : next[static_cast<size_t>(from)].front();
  while (at != finish_node() && static_cast<int>(path.size()) < item_count_) {
    path.push_back(at);
    const int mate = problem_.mate[static_cast<size_t>(at)];
    const std::vector<int>& ways = next[static_cast<size_t>(mate)];
    if (ways.size() != (mate == at ? 2 : 1)) return {};
    const int to = ways.front() == from && mate == at ? ways.back() : ways.front();
    from = mate;
    at = to;
  }
  if (static_cast<int>(path.size()) != item_count_ - 1) return {};
  return path;
}

}  // namespace traverse
