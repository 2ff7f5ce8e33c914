// The leaves that a local search has still to look at, and which moves to and from them are new.

#ifndef TRAVERSE_ENGINE_SEARCH_BOOKKEEPING_LEAF_QUEUE_H_
#define TRAVERSE_ENGINE_SEARCH_BOOKKEEPING_LEAF_QUEUE_H_

#include <array>
#include <cassert>
#include <cstddef>
#include <vector>

namespace traverse {

// First in, first out; each path at most once. Start and finish are never in it, but have moves.
// Allocates nothing after construction.
class LeafQueue {
 public:
  // Leaves from `paths` on are the start and the finish.
  LeafQueue(int paths, int leaves)
      : ring_(Index(paths)), queued_(ring_.size()), changed_(Index(leaves), kNone) {}

  bool empty() const { return size_ == 0; }

  // Adds a leaf without any change.
  void Enqueue(int leaf) {
    if (Index(leaf) >= ring_.size() || queued_[Index(leaf)]) return;
    queued_[Index(leaf)] = true;
    const size_t tail = head_ + size_++;
    ring_[tail < ring_.size() ? tail : tail - ring_.size()] = leaf;
  }

  // Adds a leaf, to which and from which both moves count as changed.
  void Push(int leaf) {
    changed_[Index(leaf)] = kBoth;
    Enqueue(leaf);
  }

  // Adds two leaves that follow each other. Of their moves only the one between them changed.
  void PushPair(int a, int b) {
    Note(a, b);
    Note(b, a);
    Enqueue(a);
    Enqueue(b);
  }

  // REQUIRES: it is not empty.
  int Pop() {
    assert(!empty());
    const int leaf = ring_[head_];
    if (++head_ == ring_.size()) head_ = 0;
    --size_;
    queued_[Index(leaf)] = false;
    return leaf;
  }

  // Whether the move between `leaf` and its neighbor in the route `other` changed.
  bool Changed(int leaf, int other) const {
    const Others& others = changed_[Index(leaf)];
    return others == kBoth || others[0] == other || others[1] == other;
  }

  // Forgets the changes at a leaf that was looked at, if it is not in the queue again.
  void Forget(int leaf) {
    if (!queued_[Index(leaf)]) changed_[Index(leaf)] = kNone;
  }

  void Clear() {
    while (!empty()) Forget(Pop());
    for (size_t end = ring_.size(); end < changed_.size(); ++end) changed_[end] = kNone;
  }

 private:
  using Others = std::array<int, 2>;  // the last two neighbors noted
  static constexpr Others kNone{-1, -1};
  static constexpr Others kBoth{-2, -2};

  static size_t Index(int i) { return static_cast<size_t>(i); }

  void Note(int leaf, int other) {
    Others& others = changed_[Index(leaf)];
    if (others != kBoth && others[0] != other) others = {other, others[0]};
  }

  std::vector<int> ring_;
  std::vector<char> queued_;  // [leaf]
  size_t head_ = 0;
  size_t size_ = 0;
  std::vector<Others> changed_;  // [leaf]
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_BOOKKEEPING_LEAF_QUEUE_H_
