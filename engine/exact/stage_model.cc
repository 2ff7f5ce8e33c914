#include "engine/exact/stage_model.h"

#include <algorithm>
#include <limits>

#include "engine/cost/entry_table.h"
#include "engine/cost/travel_cost.h"
#include "engine/exact/plan_stages.h"

namespace traverse {
namespace {

// Larger any_orders are beyond what the exact methods can do.
constexpr size_t kMostChildren = 1024;

// Costs between all states of two clusters, and the transposed matrix.
void FillMatrix(const Plan& plan, const TravelCost& cost, const std::vector<Visit>& from,
                const std::vector<Visit>& to, double* matrix, double* transposed) {
  for (size_t u = 0; u < from.size(); ++u) {
    const Point exit = ExitPoint(plan.paths[static_cast<size_t>(from[u].path)], from[u].entry);
    for (size_t v = 0; v < to.size(); ++v) {
      const Point enter = EnterPoint(plan.paths[static_cast<size_t>(to[v].path)], to[v].entry);
      const double move = cost(exit, enter);
      matrix[u * to.size() + v] = move;
      transposed[v * from.size() + u] = move;
    }
  }
}

}  // namespace

std::optional<StageModel> StageModel::Build(const LayerProblem& problem, size_t max_entries,
                                            Budget* budget) {
  const std::optional<std::vector<PlanStage>> stages = StagesOf(*problem.plan, kMostChildren);
  if (!stages) return std::nullopt;
  const EntryTable table(*problem.plan);
  StageModel model;
  model.first_.push_back(0);
  for (const PlanStage& stage : *stages) {
    const int first = model.first_.back();
    for (const int path : stage.paths) {
      model.stage_of_.push_back(static_cast<int>(model.first_.size()) - 1);
      std::vector<Visit>& visits = model.visits_.emplace_back();
      for (int e = table.first(path); e < table.first(path + 1); ++e) {
        visits.push_back(table.VisitOf(e));
      }
      const Path& given = problem.plan->paths[static_cast<size_t>(path)];
      model.is_item_.push_back(given.kind == Path::Kind::kOpen ? !given.one_way
                                                               : visits.size() == 1);
    }
    model.before_.resize(model.visits_.size());
    model.after_.resize(model.visits_.size());
    for (const auto& [i, j] : stage.before) {
      model.after_[static_cast<size_t>(first + i)].push_back(first + j);
      model.before_[static_cast<size_t>(first + j)].push_back(first + i);
    }
    model.first_.push_back(static_cast<int>(model.visits_.size()));
  }
  if (!model.AllocateMatrices(max_entries)) return std::nullopt;
  if (!model.FillMatrices(problem, budget)) return std::nullopt;
  return model;
}

bool StageModel::AllocateMatrices(size_t max_entries) {
  const auto n = static_cast<size_t>(cluster_count());
  offsets_.assign(n * n, std::numeric_limits<size_t>::max());
  size_t total = 0;
  for (int a = 0; a < cluster_count(); ++a) {
    for (int b = 0; b < cluster_count(); ++b) {
      const int step = stage_of(b) - stage_of(a);
      if (a == b || step < 0 || step > 1) continue;
      offsets_[static_cast<size_t>(a) * n + static_cast<size_t>(b)] = total;
      total += static_cast<size_t>(states(a)) * static_cast<size_t>(states(b));
      if (total > max_entries) return false;
    }
  }
  costs_.reserve(total);
  transposed_.reserve(total);
  return true;
}

bool StageModel::FillMatrices(const LayerProblem& problem, Budget* budget) {
  const Plan& plan = *problem.plan;
  const TravelCost cost(problem.cost);
  for (int a = 0; a < cluster_count(); ++a) {
    if (budget != nullptr && budget->ExhaustedNow()) return false;
    for (int b = 0; b < cluster_count(); ++b) {
      const int step = stage_of(b) - stage_of(a);
      if (a == b || step < 0 || step > 1) continue;
      const size_t count = static_cast<size_t>(states(a)) * static_cast<size_t>(states(b));
      costs_.resize(offset(a, b) + count);
      transposed_.resize(offset(a, b) + count);
      FillMatrix(plan, cost, visits_[static_cast<size_t>(a)], visits_[static_cast<size_t>(b)],
                 &costs_[offset(a, b)], &transposed_[offset(a, b)]);
    }
  }
  if (stage_count() == 0) return true;
  for (int c = 0; c < size(0); ++c) {
    std::vector<double>& row = start_.emplace_back();
    for (const Visit& visit : visits_[static_cast<size_t>(c)]) {
      row.push_back(cost(problem.start,
                         EnterPoint(plan.paths[static_cast<size_t>(visit.path)], visit.entry)));
    }
  }
  for (int c = first(stage_count() - 1); c < cluster_count(); ++c) {
    std::vector<double>& row = finish_.emplace_back();
    for (const Visit& visit : visits_[static_cast<size_t>(c)]) {
      const Point exit = ExitPoint(plan.paths[static_cast<size_t>(visit.path)], visit.entry);
      row.push_back(problem.finish ? cost(exit, *problem.finish) : 0);
    }
  }
  return true;
}

Route StageModel::RouteOf(const std::vector<ClusterState>& walk) const {
  Route route;
  for (const ClusterState& at : walk) {
    route.push_back(visits_[static_cast<size_t>(at.cluster)][static_cast<size_t>(at.state)]);
  }
  return route;
}

std::vector<ClusterState> StageModel::WalkOf(const Route& route) const {
  std::vector<int> cluster_of(route.size());
  for (size_t c = 0; c < visits_.size(); ++c) {
    cluster_of[static_cast<size_t>(visits_[c].front().path)] = static_cast<int>(c);
  }
  std::vector<ClusterState> walk;
  for (const Visit& visit : route) {
    const int cluster = cluster_of[static_cast<size_t>(visit.path)];
    const std::vector<Visit>& visits = visits_[static_cast<size_t>(cluster)];
    const auto state = std::find(visits.begin(), visits.end(), visit) - visits.begin();
    walk.push_back({cluster, static_cast<int>(state)});
  }
  return walk;
}

double StageModel::CostOf(const std::vector<ClusterState>& walk) const {
  if (walk.empty()) return 0;
  return CostBefore(walk) + Finish(walk.back().cluster)[walk.back().state];
}

double StageModel::CostBefore(const std::vector<ClusterState>& walk) const {
  double sum = Start(walk.front().cluster)[walk.front().state];
  for (size_t k = 1; k < walk.size(); ++k) {
    const ClusterState from = walk[k - 1];
    const ClusterState to = walk[k];
    sum += Move(from.cluster, to.cluster)[from.state * states(to.cluster) + to.state];
  }
  return sum;
}

}  // namespace traverse
