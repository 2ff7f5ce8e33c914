#include "engine/proof/tsp/tsp_choices.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace traverse {
namespace {

constexpr size_t kColumnsTried = 4;
constexpr double kUndecided = 1e-6;  // how far a value is from 0 and 1

// Choices and how far they are from one half.
using Distances = std::vector<std::pair<double, TspChoice>>;

void AppendNearest(Distances& from, size_t most, std::vector<TspChoice>& to) {
  std::stable_sort(from.begin(), from.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (from.size() > most) from.resize(most);
  for (const auto& [distance, choice] : from) to.push_back(choice);
}

}  // namespace

std::vector<TspChoice> OpenChoices(TspRelaxation& relaxation, const TspChoices& made,
                                   size_t most_pairs) {
  Distances pairs;
  for (const auto& divided : relaxation.DividedPairs()) {
    const TspRelaxation::ItemPair& pair = divided.first;  // clang 14 captures no part of a binding
    const bool is_made = std::any_of(made.begin(), made.end(), [&](const auto& choice) {
      return choice.first.column < 0 && choice.first.pair == pair;
    });
    if (!is_made) pairs.push_back({std::abs(divided.second - 0.5), TspChoice{-1, pair}});
  }
  Distances columns;
  for (int j = 0; j < relaxation.column_count(); ++j) {
    const double x = relaxation.lp().Primal(j);
    if (x > kUndecided && x < 1 - kUndecided) {
      columns.push_back({std::abs(x - 0.5), TspChoice{j, {}}});
    }
  }
  std::vector<TspChoice> choices;
  AppendNearest(pairs, most_pairs, choices);
  AppendNearest(columns, kColumnsTried, choices);
  return choices;
}

void HoldPairsOf(const TspChoices& made, const std::vector<TspChoice>& choices,
                 TspRelaxation& relaxation) {
  std::vector<TspRelaxation::ItemPair> pairs;
  for (const auto& [choice, in] : made) {
    if (choice.column < 0) pairs.push_back(choice.pair);
  }
  for (const TspChoice& choice : choices) {
    if (choice.column < 0) pairs.push_back(choice.pair);
  }
  relaxation.HoldPairs(pairs);
}

void Fix(const TspChoice& choice, bool in, TspRelaxation& relaxation) {
  if (choice.column < 0) {
    relaxation.Fix(choice.pair, in);
  } else {
    relaxation.Fix(choice.column, in);
  }
}

void Free(const TspChoice& choice, TspRelaxation& relaxation) {
  if (choice.column < 0) {
    relaxation.Free(choice.pair);
  } else {
    relaxation.Free(choice.column);
  }
}

}  // namespace traverse
