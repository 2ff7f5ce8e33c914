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

// The children of one any_order node that may come next, and the entries at which they may begin:
// those of a leaf, or of the first child, or those of another frontier if the child begins with an
// any_order node. Frontiers are nested like the nodes, so that all of them together hold each entry
// once.
class Frontier {
 public:
  // The frontiers of all nodes, each created when it is first needed.
  class Forest {
   public:
    // `layer` and `budget`, which it asks regularly, must outlive the forest.
    Forest(const LayerView& layer, Budget& budget)
        : layer_(&layer),
          budget_(&budget),
          rest_(&budget),
          frontiers_(static_cast<size_t>(layer.tree.node_count())) {}

    Budget& budget() const { return *budget_; }
    Rest& rest() { return rest_; }  // shared by all nodes: each of them may be small

    // Do not use it if the budget was cancelled meanwhile. REQUIRES: `node` is an any_order node
    // with children.
    Frontier& Of(int node);

    // Call it for a completed node.
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

  // The entry nearest to `at`, the smallest of several, and the slot of the child that begins
  // there. REQUIRES: some child may come next.
  Found Nearest(Point at) const;

  // Some child that may come next, found without a search: sets only `slot`. REQUIRES as above.
  Found Any() const;

  // Promises that only Any will be called: that, Begin and Finish are then quicker.
  void StopSearching() { index_.StopSearching(); }

  // The child has begun: it can no longer come next.
  void Begin(int slot);

  // The child is completed: those that waited for it may come next.
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
  std::vector<int> nested_next_;         // slots of nested_ that may come next
  BoundingBox box_;                      // of all entries, including nested ones
  NearestPointIndex index_;              // of entries_, by id; built from what ListEntries fills
  std::optional<ReadySlots> ready_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_GREEDY_FRONTIER_H_
