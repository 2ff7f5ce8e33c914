#include "engine/construct/greedy.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/construct/first_entries.h"
#include "engine/cost/route_cost.h"
#include "engine/geometry/nearest_point_index.h"

namespace traverse {
namespace {

// The entries at which the children of an any_order node may be begun, as far as the children may
// be next.
class Frontier {
 public:
  // `entries`: pairs of an entry and the slot of the child that it begins.
  Frontier(const LayerView& layer, std::vector<std::pair<int, int>> entries, int slots)
      : entries_(Sorted(std::move(entries))),
        begin_(static_cast<size_t>(slots) + 1),
        ids_(entries_.size()),
        index_(Points(layer)) {
    for (const auto& [entry, slot] : entries_) ++begin_[static_cast<size_t>(slot) + 1];
    for (size_t s = 0; s + 1 < begin_.size(); ++s) begin_[s + 1] += begin_[s];
    std::vector<size_t> next(begin_.begin(), begin_.end() - 1);
    for (size_t id = 0; id < entries_.size(); ++id) {
      ids_[next[static_cast<size_t>(entries_[id].second)]++] = static_cast<int>(id);
    }
  }

  void Add(int slot) {
    ForEachId(slot, [&](int id) { index_.Insert(id); });
  }
  void Remove(int slot) {
    ForEachId(slot, [&](int id) { index_.Remove(id); });
  }

  // The entry nearest to `at`, and its slot. REQUIRES: there is one.
  const std::pair<int, int>& Nearest(Point at) const { return Of(index_.Nearest(at)); }
  const std::pair<int, int>& Any() const { return Of(index_.Any()); }

 private:
  // Ids then follow paths and entries, as ties shall be broken.
  static std::vector<std::pair<int, int>> Sorted(std::vector<std::pair<int, int>> entries) {
    if (!std::is_sorted(entries.begin(), entries.end())) std::sort(entries.begin(), entries.end());
    return entries;
  }

  std::vector<Point> Points(const LayerView& layer) const {
    std::vector<Point> points;
    points.reserve(entries_.size());
    for (const auto& [entry, slot] : entries_) points.push_back(layer.table.enter(entry));
    return points;
  }

  const std::pair<int, int>& Of(int id) const { return entries_[static_cast<size_t>(id)]; }

  template <typename F>
  void ForEachId(int slot, F&& f) const {
    const size_t s = static_cast<size_t>(slot);
    for (size_t i = begin_[s]; i < begin_[s + 1]; ++i) f(ids_[i]);
  }

  std::vector<std::pair<int, int>> entries_;  // [id]
  std::vector<size_t> begin_;                 // [slot] where its ids begin in ids_; one more
  std::vector<int> ids_;
  NearestPointIndex index_;
};

class Greedy {
 public:
  Greedy(const LayerView& layer, Budget& budget)
      : layer_(layer), budget_(budget), at_(layer.problem.start) {}

  Route Build() {
    route_.reserve(layer_.plan().paths.size());
    if (!layer_.plan().paths.empty()) Complete(0);
    return std::move(route_);
  }

 private:
  void Complete(int node) {
    const absl::Span<const int> children = layer_.tree.children(node);
    if (layer_.tree.is_leaf(node)) {
      VisitAt(NearestEntry(layer_.tree.node(node).path));
    } else if (children.size() > 1 && layer_.tree.node(node).kind == PlanNode::Kind::kAnyOrder) {
      CompleteAnyOrder(node);
    } else {
      for (const int child : children) Complete(child);
    }
  }

  void CompleteAnyOrder(int node) {
    const absl::Span<const int> children = layer_.tree.children(node);
    const int slots = static_cast<int>(children.size());
    std::vector<std::pair<int, int>> entries;
    for (int s = 0; s < slots; ++s) {
      ForEachFirstEntry(layer_, children[static_cast<size_t>(s)],
                        [&](int entry) { entries.emplace_back(entry, s); });
    }
    Frontier frontier(layer_, std::move(entries), slots);

    std::vector<bool> waits(children.size(), true);
    ReadySlots ready(layer_.tree.precedence(node), slots,
                     [&](int slot) { waits[static_cast<size_t>(slot)] = false; });
    for (int s = 0; s < slots; ++s) {
      if (waits[static_cast<size_t>(s)]) frontier.Remove(s);
    }
    for (int done = 0; done < slots; ++done) {
      const auto [entry, slot] = budget_.Exhausted() ? frontier.Any() : frontier.Nearest(at_);
      const int child = children[static_cast<size_t>(slot)];
      frontier.Remove(slot);
      if (layer_.tree.is_leaf(child)) {
        VisitAt(entry);
      } else {
        // Begins with the entry just found, as it looks for the nearest among the same ones.
        Complete(child);
      }
      ready.Finish(slot, [&](int s) { frontier.Add(s); });
    }
  }

  int NearestEntry(int path) const {
    const absl::Span<const Point> enters = layer_.table.enters(path);
    size_t nearest = 0;
    for (size_t i = 1; i < enters.size(); ++i) {
      if (Distance(at_, enters[i]) < Distance(at_, enters[nearest])) nearest = i;
    }
    return layer_.table.first(path) + static_cast<int>(nearest);
  }

  void VisitAt(int entry) {
    route_.push_back(layer_.table.VisitOf(entry));
    at_ = layer_.table.exit(entry);
  }

  const LayerView& layer_;
  Budget& budget_;
  Point at_;
  Route route_;
};

}  // namespace

Route GreedyRoute(const LayerView& layer, Budget& budget) { return Greedy(layer, budget).Build(); }

Route BaselineRoute(const LayerView& layer, Budget& budget) {
  Route given = GivenRoute(layer.plan());
  Route greedy = GreedyRoute(layer, budget);
  return RouteCost(layer.problem, greedy) < RouteCost(layer.problem, given) ? greedy : given;
}

}  // namespace traverse
