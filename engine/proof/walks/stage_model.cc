#include "engine/proof/walks/stage_model.h"

#include <algorithm>

#include "engine/base/rest.h"
#include "engine/cost/travel_cost.h"
#include "engine/proof/min_plus.h"

namespace traverse {
namespace {

Point EnterOf(const Plan& plan, const Visit& visit) {
  return EnterPoint(plan.paths[static_cast<size_t>(visit.path)], visit.entry);
}
Point ExitOf(const Plan& plan, const Visit& visit) {
  return ExitPoint(plan.paths[static_cast<size_t>(visit.path)], visit.entry);
}

// Costs between all states of two clusters, and the transposed matrix. A gate leads to the entry
// that it is in the state of.
void FillMatrix(const Plan& plan, const TravelCost& cost, bool from_gate,
                absl::Span<const Visit> from, absl::Span<const Visit> to, double* matrix,
                double* transposed) {
  for (size_t u = 0; u < from.size(); ++u) {
    const Point exit = ExitOf(plan, from[u]);
    for (size_t v = 0; v < to.size(); ++v) {
      double move = 0;
      if (!from_gate) {
        move = cost(exit, EnterOf(plan, to[v]));
      } else if (!(from[u] == to[v])) {
        move = kUnreached;
      }
      matrix[u * to.size() + v] = move;
      transposed[v * from.size() + u] = move;
    }
  }
}

// What freeing the lists of a stage of one cluster takes, as Rest counts steps.
constexpr size_t kStepsOfCluster = 32;

}  // namespace

std::optional<StageModel> StageModel::Build(const LayerProblem& problem, size_t max_entries,
                                            Budget* budget) {
  StageModel model;
  if (!model.LayOut(*problem.plan, max_entries, budget)) return std::nullopt;
  if (!model.FillMatrices(problem, budget)) return std::nullopt;
  return model;
}

bool StageModel::Fits(const Plan& plan, size_t max_entries, Budget* budget) {
  return StageModel().LayOut(plan, max_entries, budget);
}

bool StageModel::LayOut(const Plan& plan, size_t max_entries, Budget* budget) {
  std::optional<std::deque<PlanStage>> stages = StagesOf(plan, kMostClusters, budget);
  if (!stages) return false;
  const EntryTable entries(plan, budget);
  first_.push_back(0);
  for (const PlanStage& stage : *stages) {
    if (budget != nullptr && budget->Exhausted()) return false;
    AddStage(plan, entries, stage);
  }
  return PlaceMatrices(*std::move(stages), max_entries, budget);
}

void StageModel::AddStage(const Plan& plan, const EntryTable& entries, const PlanStage& stage) {
  const int first = first_.back();
  AddVisits(entries, stage);
  for (int i = 0; i < stage.size(); ++i) {
    const int path = stage.paths[static_cast<size_t>(i)];
    stage_of_.push_back(static_cast<int>(first_.size()) - 1);
    is_gate_.push_back(path == PlanStage::kGate);
    const bool open =
        path != PlanStage::kGate && plan.paths[static_cast<size_t>(path)].kind == Path::Kind::kOpen;
    is_item_.push_back(open ? !plan.paths[static_cast<size_t>(path)].one_way
                            : states(first + i) == 1);
    is_contour_.push_back(path != PlanStage::kGate && !open);
  }
  const size_t clusters = first_visit_.size() - 1;
  before_.resize(clusters);
  after_.resize(clusters);
  for (const auto& [i, j] : stage.before) {
    after_[static_cast<size_t>(first + i)].push_back(first + j);
    before_[static_cast<size_t>(first + j)].push_back(first + i);
  }
  for (const PlanStage::Gate& gate : stage.gates) {
    gates_.push_back({first + gate.item, first + gate.first, first + gate.last});
  }
  begins_.insert(begins_.end(), stage.begins.begin(), stage.begins.end());
  ends_.insert(ends_.end(), stage.ends.begin(), stage.ends.end());
  const auto pairs = std::count(stage.follows.begin(), stage.follows.end(), 1);
  is_free_.push_back(pairs == static_cast<std::ptrdiff_t>(stage.size()) * (stage.size() - 1));
  first_.push_back(static_cast<int>(clusters));
}

// The states of each item. Those of a gate, which comes after its block, are the states of what
// follows it.
void StageModel::AddVisits(const EntryTable& entries, const PlanStage& stage) {
  const size_t first = first_visit_.size() - 1;
  auto gate = stage.gates.begin();
  for (const int path : stage.paths) {
    if (path == PlanStage::kGate) {
      assert(gate->item == static_cast<int>(first_visit_.size() - 1 - first));
      for (int i = gate->first; i < gate->last; ++i) {
        if (!stage.CanFollow(gate->item, i)) continue;
        const size_t of_item = first + static_cast<size_t>(i);
        for (size_t v = first_visit_[of_item]; v < first_visit_[of_item + 1]; ++v) {
          visits_.push_back(Visit(visits_[v]));
        }
      }
      ++gate;
    } else {
      for (int e = entries.first(path); e < entries.first(path + 1); ++e) {
        visits_.push_back(entries.VisitOf(e));
      }
    }
    first_visit_.push_back(visits_.size());
  }
}

bool StageModel::PlaceMatrices(std::deque<PlanStage> stages, size_t max_entries, Budget* budget) {
  size_t pairs = 0;
  for (int s = 0; s < stage_count(); ++s) {
    pairs += static_cast<size_t>(size(s)) * static_cast<size_t>(end_of_next(s) - first(s));
    if (pairs > max_entries) return false;
  }
  row_.reserve(static_cast<size_t>(cluster_count()));
  offsets_.reserve(pairs);
  Rest rest(budget);
  for (int a = 0; a < cluster_count(); ++a) {
    const int s = stage_of(a);
    if (s > 0 && a == first(s)) stages.pop_front();
    const PlanStage& stage = stages.front();
    const int end = end_of_next(s);
    if (!rest(kStepsOfCluster + static_cast<size_t>(end - first(s)))) return false;
    row_.push_back(offsets_.size());
    offsets_.resize(offsets_.size() + static_cast<size_t>(end - first(s)), kNoMoves);
    for (int b = first(s); b < end; ++b) {
      const bool follows = stage_of(b) == s ? stage.CanFollow(a - first(s), b - first(s))
                                            : ends_[static_cast<size_t>(a)] != 0 &&
                                                  begins_[static_cast<size_t>(b)] != 0;
      if (!follows) continue;
      offsets_[row_.back() + static_cast<size_t>(b - first(s))] = move_count_;
      move_count_ += static_cast<size_t>(states(a)) * static_cast<size_t>(states(b));
      if (move_count_ > max_entries) return false;
    }
  }
  return true;
}

bool StageModel::FillMatrices(const LayerProblem& problem, Budget* budget) {
  const TravelCost cost(problem);
  costs_.reserve(move_count_);
  transposed_.reserve(move_count_);
  for (int a = 0; a < cluster_count(); ++a) {
    if (budget != nullptr && budget->ExhaustedNow()) return false;
    const int s = stage_of(a);
    for (int b = first(s); b < end_of_next(s); ++b) {
      if (!CanFollow(a, b)) continue;
      const size_t count = static_cast<size_t>(states(a)) * static_cast<size_t>(states(b));
      costs_.resize(offset(a, b) + count);
      transposed_.resize(offset(a, b) + count);
      FillMatrix(*problem.plan, cost, IsGate(a), visits(a), visits(b), &costs_[offset(a, b)],
                 &transposed_[offset(a, b)]);
    }
  }
  if (stage_count() > 0) FillEnds(problem);
  return true;
}

void StageModel::FillEnds(const LayerProblem& problem) {
  const TravelCost cost(problem);
  for (int c = 0; c < first(1); ++c) {
    std::vector<double>& row = start_.emplace_back();
    for (const Visit& visit : visits(c)) {
      const bool begins = begins_[static_cast<size_t>(c)] != 0;
      row.push_back(begins ? cost(problem.start, EnterOf(*problem.plan, visit)) : kUnreached);
    }
  }
  for (int c = first(stage_count() - 1); c < cluster_count(); ++c) {
    std::vector<double>& row = finish_.emplace_back();
    for (const Visit& visit : visits(c)) {
      const Point exit = ExitOf(*problem.plan, visit);
      const double move = problem.finish ? cost(exit, *problem.finish) : 0;
      row.push_back(ends_[static_cast<size_t>(c)] != 0 ? move : kUnreached);
    }
  }
}

Route StageModel::RouteOf(const std::vector<ClusterState>& walk) const {
  Route route;
  for (const ClusterState& at : walk) {
    if (IsGate(at.cluster)) continue;
    route.push_back(visits(at.cluster)[static_cast<size_t>(at.state)]);
  }
  return route;
}

std::vector<ClusterState> StageModel::WalkOf(const Route& route) const {
  std::vector<int> cluster_of(route.size());
  for (int c = 0; c < cluster_count(); ++c) {
    if (IsGate(c)) continue;
    cluster_of[static_cast<size_t>(visits(c).front().path)] = c;
  }
  std::vector<ClusterState> walk;
  const auto add = [&](int cluster, const Visit& visit) {
    const absl::Span<const Visit> states = visits(cluster);
    const auto state = std::find(states.begin(), states.end(), visit) - states.begin();
    walk.push_back({cluster, static_cast<int>(state)});
  };
  std::vector<PlanStage::Gate> ahead;  // of blocks of the stage that are not yet begun
  auto later = gates_.begin();         // those of later stages
  for (const Visit& visit : route) {
    const int cluster = cluster_of[static_cast<size_t>(visit.path)];
    for (; later != gates_.end() && stage_of(later->item) <= stage_of(cluster); ++later) {
      ahead.push_back(*later);
    }
    const auto holds = [&](const PlanStage::Gate& gate) {
      return gate.first <= cluster && cluster < gate.last;
    };
    for (auto gate = ahead.rbegin(); gate != ahead.rend(); ++gate) {
      if (holds(*gate)) add(gate->item, visit);
    }
    ahead.erase(std::remove_if(ahead.begin(), ahead.end(), holds), ahead.end());
    add(cluster, visit);
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
