// The memory of a tabu search: the moves that are forbidden for a while.
//
// Source: thesis 2.2.8 (p. 28), table 4.2 (p. 84): 1.5 entries for each contour, each for a number
// of iterations; Glover and Laguna (1998).

#ifndef TRAVERSE_ENGINE_IMPROVE_TABU_LIST_H_
#define TRAVERSE_ENGINE_IMPROVE_TABU_LIST_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace traverse {

// A move is known by a key. At most `capacity` moves are forbidden at a time: a new one then takes
// the place of the oldest.
class TabuList {
 public:
  explicit TabuList(int capacity) : entries_(static_cast<size_t>(capacity)) {}

  void Clear() { size_ = 0; }

  // Forbids `key` until iteration `until`, that one excluded.
  void Add(uint64_t key, int64_t until) {
    if (entries_.empty()) return;
    entries_[next_] = {key, until};
    next_ = (next_ + 1) % entries_.size();
    if (size_ < entries_.size()) ++size_;
  }

  // O(capacity): ask it only about moves that would be taken otherwise.
  bool Forbids(uint64_t key, int64_t iteration) const {
    for (size_t back = 1; back <= size_; ++back) {
      const Entry& entry = entries_[(next_ + entries_.size() - back) % entries_.size()];
      if (entry.key == key && iteration < entry.until) return true;
    }
    return false;
  }

 private:
  struct Entry {
    uint64_t key = 0;
    int64_t until = 0;
  };

  std::vector<Entry> entries_;  // a ring; the last size_ before next_ are in use
  size_t next_ = 0;
  size_t size_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_IMPROVE_TABU_LIST_H_
