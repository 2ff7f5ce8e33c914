// What the trees of the bounds share: which ends may be joined, and which sides are.

#ifndef TRAVERSE_ENGINE_PROOF_BOUNDS_JOINED_SIDES_H_
#define TRAVERSE_ENGINE_PROOF_BOUNDS_JOINED_SIDES_H_

#include <cstddef>
#include <numeric>
#include <vector>

namespace traverse {

// The roles (PathEnd) that the other end of a move has to have one of.
inline int OppositeRoles(int roles) { return (roles >> 1 & 1) | (roles << 1 & 2); }

// The sides of all junctions in sets that grow together (Kruskal's algorithm).
class JoinedSides {
 public:
  // Sides 0 to `count` - 1, each alone.
  void Reset(int count) {
    parent_.resize(static_cast<size_t>(count));
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  // Joins the sets of two sides. Whether they were apart. REQUIRES: sides of Reset.
  bool Join(int side, int other) {
    const int a = Find(side);
    const int b = Find(other);
    parent_[static_cast<size_t>(a)] = b;
    return a != b;
  }

 private:
  int Find(int side) {
    while (parent_[static_cast<size_t>(side)] != side) {
      int& up = parent_[static_cast<size_t>(side)];
      up = parent_[static_cast<size_t>(up)];
      side = up;
    }
    return side;
  }

  std::vector<int> parent_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_BOUNDS_JOINED_SIDES_H_
