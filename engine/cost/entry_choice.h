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

// A workspace for many choices, which keeps its memory between them. Not thread-safe.
class EntryChoice {
 public:
  // `table` must outlive the workspace, and so must `budget` if it is not null. Asks `budget`
  // regularly; once that is exhausted, choices come at once and are no longer optimal.
  EntryChoice(const EntryTable& table, const TravelCost& cost, Budget* budget = nullptr)
      : table_(&table), cost_(cost), rest_(budget) {}

  // Sets entries[k] to the best entry (of the table) of paths[k]. Returns the cost of all moves,
  // from `from` to the last path, and on to `to` if that is set. To choose again within a route
  // between two visits that stay, `from` is the exit of the first and `to` the entry of the second.
  // Deterministic. REQUIRES: entries.size() == paths.size().
  double Choose(Point from, absl::Span<const int> paths, const std::optional<Point>& to,
                absl::Span<int> entries);

 private:
  // One node of a tree over the entries of a path: entries [first, end) of the layer, in preorder.
  struct TreeNode {
    BoundingBox box;  // of their exits
    double best = 0;  // least best_ of these entries
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

  std::vector<double> best_;          // [entry of the last path] least cost up to entering there
  std::vector<double> next_;          // [entry of the next path] the same, under construction
  std::vector<double> totals_;        // [entry of the last path] scratch space of AdvanceByScan
  std::vector<int> parents_;          // [entry of any path but the first] the best entry before it
  std::vector<size_t> parent_begin_;  // [k] where the entries of paths[k] begin
  std::vector<TreeNode> tree_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_ENTRY_CHOICE_H_
