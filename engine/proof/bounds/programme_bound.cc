#include "engine/proof/bounds/programme_bound.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "engine/proof/walks/item_stage.h"
#include "engine/proof/walks/stage_model.h"

namespace traverse {
namespace {

// Numbers in the model's matrices; filling them in is a part of the effort.
constexpr double kEntriesEach = 3e6;
constexpr double kMostEntries = 6e6;

// Iterations of the simplex method times rows, of some 200 ns each.
constexpr double kWorkOfPoint = 3000;

// Of more points, so little work does not come near to what multipliers give (vertex_bound.h).
constexpr double kMostPoints = 250;

}  // namespace

std::optional<double> ProgrammeBound(const LayerProblem& problem, double target, double effort,
                                     Budget& budget) {
  assert(effort >= 0);
  const double root = std::sqrt(effort);
  const auto entries = static_cast<size_t>(std::min(kEntriesEach * effort, kMostEntries));
  if (!StageModel::Fits(*problem.plan, entries, &budget)) return std::nullopt;
  LayerProblem without_walls = problem;
  without_walls.walls = nullptr;
  const std::optional<StageModel> model = StageModel::Build(without_walls, entries, &budget);
  if (!model || !ItemStage::IsAll(*model)) return std::nullopt;
  int points = 0;
  for (int c = 0; c < model->cluster_count(); ++c) points += model->states(c);
  if (points > kMostPoints * root) return std::nullopt;
  ItemStage stage(*model, 0);
  const double bound =
      stage.Bound(stage.StartOfModel(), target, budget, kWorkOfPoint * stage.state_count() * root);
  return bound > 0 ? std::optional<double>(bound) : std::nullopt;
}

}  // namespace traverse
