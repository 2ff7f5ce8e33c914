// Where a route may go next inside an any_order node.

#ifndef TRAVERSE_ENGINE_SEARCH_GREEDY_FRONTIER_H_
#define TRAVERSE_ENGINE_SEARCH_GREEDY_FRONTIER_H_

#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/rest.h"
#include "engine/cost/layer_view.h"
#include "engine/geometry/bounding_box.h"
#include "engine/geometry/nearest_point_index.h"
#include "engine/model/tree/plan_tree.h"

namespace traverse {

// The children of one any_order node that may be next, and the entries at which these may be begun:
// those of a leaf, or of the first child's, or again those of a frontier, where the child begins
// with an any_order node. Frontiers are nested like the nodes, so that all of them together hold
// each entry once.
class Frontier {
 public:
  // The frontiers of all nodes, made when they are first asked for.
  class Forest {
   public:
    // `layer` and `budget`, which is asked meanwhile, outlive the forest.
    Forest(const LayerView& layer, Budget& budget)
        : layer_(&layer),
          budget_(&budget),
          rest_(&budget),
          frontiers_(static_cast<size_t>(layer.tree.node_count())) {}

    Budget& budget() const { return *budget_; }
    Rest& rest() { return rest_; }  // of all nodes together: each of them may be small

    // Not to be used if it was cancelled meanwhile. REQUIRES: `node` is an any_order node with
    // children.
    Frontier& Of(int node);

    // For a node that is completed.
    void Drop(int node) { frontiers_[static_cast<size_t>(node)].reset(); }

   private:
    const LayerView* layer_;
    Budget* budget_;
    Rest rest_;
    std::vector<std::unique_ptr<Frontier>> frontiers_;  // [node]
  };

  struct Found {
    double squared_mm = std::numeric_limits<double>::infinity();
    int entry = -1;
    int slot = -1;
  };

  Frontier(const LayerView& layer, int node, Forest& forest);

  // The entry nearest to `at`, the smallest of several, and the slot of the child that it begins.
  // REQUIRES: a child may be next.
  Found Nearest(Point at) const;

  // Some child that may be next, found without a search: only `slot` is set. REQUIRES as above.
  Found Any() const;

  // From now on only Any is asked for: that, Begin and Finish are quicker then.
  void StopSearching() { index_.StopSearching(); }

  // The child is begun: it is not next any more.
  void Begin(int slot);

  // The child is completed: those that waited for it may be next.
  void Finish(int slot);

 private:
  void SearchNearest(Point at, Found& found) const;
  void Offer(int slot);
  std::vector<Point> ListEntries(const LayerView& layer, int node, Forest& forest);

  bool is_nested(int slot) const { return nested_[static_cast<size_t>(slot)] != nullptr; }

  template <typename F>
  void ForEachId(int slot, F&& f) const {
    const size_t s = static_cast<size_t>(slot);
    for (size_t i = first_id_[s]; i < first_id_[s + 1]; ++i) f(ids_[i]);
  }

  std::vector<std::pair<int, int>> entries_;  // [id] entry, slot; sorted
  std::vector<size_t> first_id_;              // [slot] where its ids begin in ids_; one more
  std::vector<int> ids_;
  std::vector<const Frontier*> nested_;  // [slot] where such a child begins; else null
  std::vector<int> nested_next_;         // slots of nested_ that may be next
  BoundingBox box_;                      // of all entries, nested ones included
  NearestPointIndex index_;              // of entries_, by id; built from what ListEntries fills
  std::optional<ReadySlots> ready_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_GREEDY_FRONTIER_H_
