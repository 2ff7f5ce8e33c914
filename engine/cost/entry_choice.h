// Entry choice: the best entries for paths whose order is fixed.
//
//   from -> p0@? -> p1@? -> ... -> to         p@e: path p, entered at e
//
// A shortest path in a layered graph (SPEC 3.5, step 3): one layer a path, one vertex an entry;
//
//   best[k][j] = min over i of best[k-1][i] + cost(exit of i -> entry of j),  i entry of path k-1
//
// solved exactly by dynamic programming. With m_k entries of path k, memory is O(sum m_k) and time
// O(sum m_k m_{k+1}); where both are large, a tree of bounding boxes over i cuts most of it off.
// 5000 contours of 40 vertices take about 15 ms.

#ifndef TRAVERSE_ENGINE_COST_ENTRY_CHOICE_H_
#define TRAVERSE_ENGINE_COST_ENTRY_CHOICE_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/base/rest.h"
#include "engine/cost/entry_table.h"
#include "engine/cost/travel_cost.h"
#include "engine/geometry/bounding_box.h"
#include "engine/model/point.h"

namespace traverse {

// A workspace for many choices: keeps its memory from one to the next. Not thread-safe.
class EntryChoice {
 public:
  // `table` outlives the workspace, and so does `budget`, if there is one: it is asked meanwhile.
  // Once it is exhausted, choices are made at once, and are not the best any more.
  EntryChoice(const EntryTable& table, const TravelCost& cost, Budget* budget = nullptr)
      : table_(&table), cost_(cost), rest_(budget) {}

  // Writes the best entry (of the table) of paths[k] to entries[k] and returns the cost of all
  // moves, from `from` to the last path, and on to `to` if there is one. To choose again within a
  // route, between two visits that stay: `from` is the exit of the one and `to` the entry of the
  // other. Deterministic. REQUIRES: entries.size() == paths.size().
  double Choose(Point from, absl::Span<const int> paths, const std::optional<Point>& to,
                absl::Span<int> entries);

 private:
  // One node of a tree over the entries of a path: entries [first, end) of the layer, in preorder.
  struct TreeNode {
    BoundingBox box;  // of their exits
    double best = 0;  // least best_ of them
    int first = 0;
    int end = 0;
    int skip = 0;  // the node that follows the subtree
  };

  void EnterFirst(Point from, int path);
  void Advance(int from_path, int to_path, int* parent);
  void AdvanceByScan(int from_path, int to_path, int* parent);
  void AdvanceByBounds(int from_path, int to_path, int* parent);
  void AdvanceByTree(int from_path, int to_path, int* parent);
  int BuildTree(int path, int first, int end);

  const EntryTable* table_;
  TravelCost cost_;
  Rest rest_;

  std::vector<double> best_;          // [entry of the last path] least cost to have entered there
  std::vector<double> next_;          // the same of the next path, under construction
  std::vector<double> totals_;        // [entry of the last path] scratch of AdvanceByScan
  std::vector<int> parents_;          // [entry of any path but the first] the best one before it
  std::vector<size_t> parent_begin_;  // [k] where those of paths[k] begin
  std::vector<TreeNode> tree_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_ENTRY_CHOICE_H_
