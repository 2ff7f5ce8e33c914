#include "engine/proof/walks/last_stage.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/proof/min_plus.h"

namespace traverse {

LastStage::LastStage(const StageModel& model)
    : model_(model),
      stage_(model.stage_count() - 2),
      items_(model, model.stage_count() - 1),
      least_(static_cast<size_t>(items_.state_count())) {
  assert(model.stage_count() >= 2 && IsItemStage(model, stage_ + 1));
}

std::vector<double> LastStage::StartAfter(ClusterState from, double cost) const {
  std::vector<double> start;
  for (int b = model_.first(stage_ + 1); b < model_.cluster_count(); ++b) {
    const double* moves = model_.Move(from.cluster, b) + from.state * model_.states(b);
    for (int v = 0; v < model_.states(b); ++v) start.push_back(cost + moves[v]);
  }
  return start;
}

// Calls visit(index of a cluster in the stage before, its state, state index of items_, cost of the
// move between them).
template <typename Visit>
void LastStage::ForEachMove(const Visit& visit) const {
  for (int a = model_.first(stage_); a < model_.first(stage_ + 1); ++a) {
    const auto cluster = static_cast<size_t>(a - model_.first(stage_));
    for (int b = model_.first(stage_ + 1); b < model_.cluster_count(); ++b) {
      if (!model_.CanFollow(a, b)) continue;
      const double* moves = model_.Move(a, b);
      for (int u = 0; u < model_.states(a); ++u) {
        for (int v = 0; v < model_.states(b); ++v) {
          visit(cluster, static_cast<size_t>(u), items_.StateIndex({b, v}),
                moves[u * model_.states(b) + v]);
        }
      }
    }
  }
}

std::vector<double> LastStage::StartAfter(const EndCosts& ends) const {
  std::vector<double> start(least_.size(), kUnreached);
  ForEachMove([&](size_t cluster, size_t state, size_t entry, double move) {
    start[entry] = std::min(start[entry], ends[cluster][state] + move);
  });
  return start;
}

LastStage::EndCosts LastStage::Finish() const {
  EndCosts finish;
  for (int a = model_.first(stage_); a < model_.first(stage_ + 1); ++a) {
    finish.emplace_back(static_cast<size_t>(model_.states(a)), kUnreached);
  }
  ForEachMove([&](size_t cluster, size_t state, size_t entry, double move) {
    double& least = finish[cluster][state];
    least = std::min(least, move + least_[entry]);
  });
  return finish;
}

void LastStage::Learn(const std::vector<double>& start, double bound) {
  for (size_t e = 0; e < start.size(); ++e) {
    if (start[e] != kUnreached) least_[e] = std::max(least_[e], bound - start[e]);
  }
}

ItemStage::Best LastStage::Solve(const std::vector<double>& start, double limit,
                                 const std::vector<ClusterState>& known, Budget& budget) {
  ItemStage::Best best = items_.Solve(start, limit, known, budget);
  Learn(start, best.lower_bound);
  return best;
}

void LastStage::Sample(int samples, double limit, Budget& budget) {
  std::vector<std::vector<double>> starts;
  for (int a = model_.first(stage_); a < model_.first(stage_ + 1); ++a) {
    if (budget.Exhausted()) return;
    if (!model_.CanFollow(a, model_.first(stage_ + 1))) continue;
    for (int u = 0; u < model_.states(a); ++u) starts.push_back(StartAfter({a, u}, 0));
  }
  // What is known after one end is off by at most the largest difference of start costs after
  // another: that is how far ends are from each other.
  std::vector<double> distance(starts.size(), kUnreached);
  for (int sample = 0; sample < samples && !budget.Exhausted(); ++sample) {
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (*farthest <= 0) break;
    const std::vector<double>& start = starts[static_cast<size_t>(farthest - distance.begin())];
    Learn(start, items_.Bound(start, limit, budget));
    for (size_t i = 0; i < starts.size() && !budget.Exhausted(); ++i) {
      double largest = 0;
      for (size_t e = 0; e < start.size(); ++e) {
        largest = std::max(largest, std::abs(starts[i][e] - start[e]));
      }
      distance[i] = std::min(distance[i], largest);
    }
  }
}

}  // namespace traverse
