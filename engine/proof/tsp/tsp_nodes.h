// Numbers the nodes of a path TSP (path_tsp.h) and says which belong together.

#ifndef TRAVERSE_ENGINE_PROOF_TSP_TSP_NODES_H_
#define TRAVERSE_ENGINE_PROOF_TSP_TSP_NODES_H_

#include <cassert>
#include <cstddef>
#include <vector>

#include "engine/proof/tsp/path_tsp.h"

namespace traverse {

// Nodes are the ports, then the start, then the finish. Items are numbered from 1; the start and
// the finish belong to item 0.
class TspNodes {
 public:
  explicit TspNodes(const PathTsp& problem);

  int start() const { return static_cast<int>(mate_.size()) - 2; }
  int finish() const { return start() + 1; }
  int count() const { return static_cast<int>(mate_.size()); }

  int item_count() const { return static_cast<int>(first_.size()) - 1; }
  int item(int node) const { return item_[Index(node)]; }

  // The ports of `item` are [first(item), first(item + 1)). REQUIRES: it is not 0.
  int first(int item) const {
    assert(item > 0);
    return first_[Index(item)];
  }
  int size(int item) const { return first_[Index(item) + 1] - first(item); }

  // Where a path continues from `node`: at once, or after a fixed edge.
  int mate(int node) const { return mate_[Index(node)]; }

  // Whether one of the ports of `item` must be chosen, and whether `node` is such a port.
  bool HasChoice(int item) const { return has_choice_[Index(item)] != 0; }
  bool IsChoice(int node) const { return HasChoice(item(node)); }

  // The node that stands for all ports of an item with a choice; else `node`.
  int group(int node) const { return IsChoice(node) ? first(item(node)) : node; }

  // Whether a move may join two nodes.
  bool CanJoin(int a, int b) const { return item(a) != item(b); }

 private:
  static size_t Index(int i) { return static_cast<size_t>(i); }

  std::vector<int> item_;         // [node]
  std::vector<int> mate_;         // [node]
  std::vector<int> first_;        // [item]; one more
  std::vector<char> has_choice_;  // [item]
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TSP_TSP_NODES_H_
