#include "engine/proof/tsp/max_flow.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "engine/base/at.h"

namespace traverse {
namespace {

constexpr double kTiny = 1e-9;  // less left counts as nothing

}  // namespace

MaxFlow::MaxFlow(const SupportGraph& graph)
    : arcs_(2 * graph.edges.size()),
      first_(At(graph.nodes) + 1),
      left_(arcs_.size()),
      reached_(At(graph.nodes)),
      reached_by_(At(graph.nodes)) {
  for (const SupportGraph::Edge& edge : graph.edges) {
    ++first_[At(edge.a) + 1];
    ++first_[At(edge.b) + 1];
  }
  for (size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (const SupportGraph::Edge& edge : graph.edges) {
    const int there = next[At(edge.a)]++;
    const int back = next[At(edge.b)]++;
    arcs_[At(there)] = {edge.b, back, edge.weight};
    arcs_[At(back)] = {edge.a, there, edge.weight};
  }
}

double MaxFlow::Send(const std::vector<int>& sources, int sink, double most) {
  assert(!sources.empty() && std::find(sources.begin(), sources.end(), sink) == sources.end());
  for (size_t i = 0; i < arcs_.size(); ++i) left_[i] = arcs_[i].capacity;
  double sent = 0;
  while (sent < most && Reach(sources, sink)) {
    double amount = most - sent;
    for (int v = sink; reached_by_[At(v)] >= 0;) {
      const int arc = reached_by_[At(v)];
      amount = std::min(amount, left_[At(arc)]);
      v = arcs_[At(arcs_[At(arc)].back)].to;
    }
    for (int v = sink; reached_by_[At(v)] >= 0;) {
      const int arc = reached_by_[At(v)];
      left_[At(arc)] -= amount;
      left_[At(arcs_[At(arc)].back)] += amount;
      v = arcs_[At(arcs_[At(arc)].back)].to;
    }
    sent += amount;
  }
  return sent;
}

bool MaxFlow::Reach(const std::vector<int>& sources, int sink) {
  std::fill(reached_.begin(), reached_.end(), 0);
  queue_ = sources;
  for (const int source : sources) {
    reached_[At(source)] = 1;
    reached_by_[At(source)] = -1;
  }
  for (size_t i = 0; i < queue_.size(); ++i) {
    const int v = queue_[i];
    for (int arc = first_[At(v)]; arc < first_[At(v) + 1]; ++arc) {
      const int to = arcs_[At(arc)].to;
      if (reached_[At(to)] != 0 || left_[At(arc)] < kTiny) continue;
      reached_[At(to)] = 1;
      reached_by_[At(to)] = arc;
      if (to == sink) return true;
      queue_.push_back(to);
    }
  }
  return false;
}

}  // namespace traverse
