#include "engine/proof/walks/item_stage.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/proof/min_plus.h"

namespace traverse {
namespace {

// Of more, or more for each item, a programme takes longer than walks do.
constexpr int kMostPorts = 1500;
constexpr int kMostPortsOfEach = 16;  // on average

// Whether the clusters of `stage` may be done in any order, and `fits` holds for each.
template <typename Fits>
bool IsFreeOf(const StageModel& model, int stage, const Fits& fits) {
  if (!model.IsFree(stage)) return false;
  for (int c = model.first(stage); c < model.first(stage + 1); ++c) {
    if (!fits(c) || !model.Before(c).empty() || !model.After(c).empty()) return false;
  }
  return true;
}

// Where an item is left when it is entered at `state`.
int OtherEnd(const StageModel& model, int cluster, int state) {
  return model.IsItem(cluster) && model.states(cluster) == 2 ? 1 - state : state;
}

// Cost of moving from one end to another. Move() has costs from the exits of states, and an item's
// exit is its other end.
double MoveBetweenEnds(const StageModel& model, int a, int end_of_a, int b, int end_of_b) {
  return model.Move(a, b)[OtherEnd(model, a, end_of_a) * model.states(b) + end_of_b];
}

// Least cost of all that comes after a stage that is left at an exit of `from`, in `state` then.
double FinishAfter(const StageModel& model, ClusterState from, int* best = nullptr) {
  const int stage = model.stage_of(from.cluster);
  if (stage == model.stage_count() - 1) return model.Finish(from.cluster)[from.state];
  const int last = model.first(stage + 1);
  double least = kUnreached;
  for (int v = 0; v < model.states(last); ++v) {
    const double cost =
        model.Move(from.cluster, last)[from.state * model.states(last) + v] + model.Finish(last)[v];
    if (cost >= least) continue;
    least = cost;
    if (best != nullptr) *best = v;
  }
  return least;
}

}  // namespace

bool IsItemStage(const StageModel& model, int stage) {
  return IsFreeOf(model, stage, [&](int c) { return model.IsItem(c); });
}

bool IsPortStage(const StageModel& model, int stage) {
  int ports = 0;
  const int most = std::min(kMostPorts, kMostPortsOfEach * model.size(stage));
  return IsFreeOf(model, stage, [&](int c) {
    ports += model.states(c);
    return ports <= most && (model.IsItem(c) || model.IsContour(c));
  });
}

PathTsp ItemStage::MakeTsp(const StageModel& model, int stage) {
  PathTsp tsp;
  std::vector<ClusterState> ports;
  for (int c = model.first(stage); c < model.first(stage + 1); ++c) {
    for (int state = 0; state < model.states(c); ++state) {
      const int port = static_cast<int>(ports.size());
      tsp.item.push_back(c - model.first(stage));
      tsp.mate.push_back(port + OtherEnd(model, c, state) - state);
      tsp.finish.push_back(FinishAfter(model, {c, OtherEnd(model, c, state)}));
      ports.push_back({c, state});
    }
  }
  tsp.ports = static_cast<int>(ports.size());
  for (const ClusterState& p : ports) {
    for (const ClusterState& q : ports) {
      tsp.cost.push_back(p.cluster == q.cluster
                             ? 0
                             : MoveBetweenEnds(model, p.cluster, p.state, q.cluster, q.state));
    }
  }
  return tsp;
}

ItemStage::ItemStage(const StageModel& model, int stage)
    : model_(model), first_cluster_(model.first(stage)), solver_(MakeTsp(model, stage)) {
  assert(IsItemStage(model, stage) || IsPortStage(model, stage));
  assert(model.size(stage) >= 2 && model.cluster_count() - model.first(stage + 1) <= 1);
  for (int c = first_cluster_; c < model.first(stage + 1); ++c) {
    first_.push_back(state_count_);
    state_count_ += model.states(c);
  }
}

bool ItemStage::IsAll(const StageModel& model) {
  if (model.size(0) < 2 || model.cluster_count() - model.size(0) > 1) return false;
  return IsItemStage(model, 0) || IsPortStage(model, 0);
}

std::vector<double> ItemStage::StartOfModel() const {
  std::vector<double> start;
  for (size_t i = 0; i < first_.size(); ++i) {
    const int c = first_cluster_ + static_cast<int>(i);
    start.insert(start.end(), model_.Start(c), model_.Start(c) + model_.states(c));
  }
  return start;
}

ItemStage::Best ItemStage::Solve(const std::vector<double>& start, double limit,
                                 const std::vector<ClusterState>& known, Budget& budget) {
  std::vector<int> path;
  for (const ClusterState& at : known) {
    if (Has(at.cluster)) path.push_back(static_cast<int>(StateIndex(at)));
  }
  const PathTspSolver::Result result = solver_.Solve(start, limit, path, budget);
  Best best{result.lower_bound, {}, result.complete};
  for (const int port : result.path) {
    const auto after = std::upper_bound(first_.begin(), first_.end(), port);
    const auto i = after - first_.begin() - 1;
    best.walk.push_back(
        {first_cluster_ + static_cast<int>(i), port - first_[static_cast<size_t>(i)]});
  }
  if (!best.walk.empty() && !Has(model_.cluster_count() - 1)) {
    const ClusterState from = best.walk.back();
    ClusterState last{model_.cluster_count() - 1, 0};
    FinishAfter(model_, {from.cluster, OtherEnd(model_, from.cluster, from.state)}, &last.state);
    best.walk.push_back(last);
  }
  return best;
}

}  // namespace traverse
