#include "engine/proof/walks/item_stage.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace traverse {
namespace {

// The other end of an item: where it is left when it is entered at `state`.
int OtherEnd(const StageModel& model, int cluster, int state) {
  return model.states(cluster) == 1 ? 0 : 1 - state;
}

// Cost of moving from one end to another. Move() has costs from the exits of states, and an item's
// exit is its other end.
double MoveBetweenEnds(const StageModel& model, int a, int end_of_a, int b, int end_of_b) {
  return model.Move(a, b)[OtherEnd(model, a, end_of_a) * model.states(b) + end_of_b];
}

}  // namespace

bool IsItemStage(const StageModel& model, int stage) {
  if (!model.IsFree(stage)) return false;
  for (int c = model.first(stage); c < model.first(stage + 1); ++c) {
    if (!model.IsItem(c) || !model.Before(c).empty() || !model.After(c).empty()) return false;
  }
  return true;
}

PathTsp ItemStage::MakeTsp(const StageModel& model, int stage) {
  PathTsp tsp;
  std::vector<ClusterState> ports;
  for (int c = model.first(stage); c < model.first(stage + 1); ++c) {
    for (int state = 0; state < model.states(c); ++state) {
      const int port = static_cast<int>(ports.size());
      tsp.mate.push_back(model.states(c) == 1 ? port : port + 1 - 2 * state);
      tsp.finish.push_back(model.Finish(c)[OtherEnd(model, c, state)]);
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
  assert(IsItemStage(model, stage) && stage == model.stage_count() - 1 && model.size(stage) >= 2);
  for (int c = first_cluster_; c < model.first(stage + 1); ++c) {
    first_.push_back(state_count_);
    state_count_ += model.states(c);
  }
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
    if (at.cluster >= first_cluster_) path.push_back(static_cast<int>(StateIndex(at)));
  }
  const PathTspSolver::Result result = solver_.Solve(start, limit, path, budget);
  Best best{result.lower_bound, {}, result.complete};
  for (const int port : result.path) {
    const auto after = std::upper_bound(first_.begin(), first_.end(), port);
    const auto i = after - first_.begin() - 1;
    best.walk.push_back(
        {first_cluster_ + static_cast<int>(i), port - first_[static_cast<size_t>(i)]});
  }
  return best;
}

}  // namespace traverse
