// Says which of n things belong together.

#ifndef TRAVERSE_ENGINE_BASE_SYMMETRIC_RELATION_H_
#define TRAVERSE_ENGINE_BASE_SYMMETRIC_RELATION_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace traverse {

// A symmetric relation between nodes 0 ... node_count() - 1. Memory: n^2 / 8 bytes.
class SymmetricRelation {
 public:
  SymmetricRelation() = default;
  explicit SymmetricRelation(int nodes)
      : neighbors_(static_cast<size_t>(nodes)),
        bits_((static_cast<size_t>(nodes) * static_cast<size_t>(nodes) + 63) / 64) {}

  // Makes `a` and `b` neighbors of each other. A node is never its own neighbor.
  void Link(int a, int b) {
    if (a == b || Linked(a, b)) return;
    for (const size_t bit : {Bit(a, b), Bit(b, a)}) bits_[bit / 64] |= uint64_t{1} << (bit % 64);
    neighbors_[static_cast<size_t>(a)].push_back(b);
    neighbors_[static_cast<size_t>(b)].push_back(a);
  }

  bool Linked(int a, int b) const {
    const size_t bit = Bit(a, b);
    return (bits_[bit / 64] >> (bit % 64) & 1u) != 0;
  }

  // The neighbors of `node`, in the order in which they were linked.
  const std::vector<int>& of(int node) const { return neighbors_[static_cast<size_t>(node)]; }
  int node_count() const { return static_cast<int>(neighbors_.size()); }

  // The connected component of each node, numbered from 0 in the order of their first nodes.
  std::vector<int> Components() const {
    std::vector<int> component(neighbors_.size(), -1);
    std::vector<int> open;
    int count = 0;
    for (int seed = 0; seed < node_count(); ++seed) {
      if (component[static_cast<size_t>(seed)] >= 0) continue;
      component[static_cast<size_t>(seed)] = count;
      open.push_back(seed);
      while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        for (const int next : of(node)) {
          if (component[static_cast<size_t>(next)] >= 0) continue;
          component[static_cast<size_t>(next)] = count;
          open.push_back(next);
        }
      }
      ++count;
    }
    return component;
  }

 private:
  size_t Bit(int a, int b) const {
    return static_cast<size_t>(a) * neighbors_.size() + static_cast<size_t>(b);
  }

  std::vector<std::vector<int>> neighbors_;
  std::vector<uint64_t> bits_;  // [a * node_count() + b]
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_SYMMETRIC_RELATION_H_
