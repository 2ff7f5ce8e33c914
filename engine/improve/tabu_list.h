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

  void Clear() {
    for (; size_ > 0; --size_) --Count(Back(size_).key);
  }

  // Forbids `key` until iteration `until`, that one excluded.
  void Add(uint64_t key, int64_t until) {
    if (entries_.empty()) return;
    if (size_ == entries_.size()) --Count(Back(size_--).key);
    entries_[next_] = {key, until};
    next_ = next_ + 1 == entries_.size() ? 0 : next_ + 1;
    ++size_;
    ++Count(key);
  }

  // O(1) for most keys that are not in the list, else O(capacity).
  bool Forbids(uint64_t key, int64_t iteration) const {
    if (counts_[Bucket(key)] == 0) return false;
    for (size_t back = 1; back <= size_; ++back) {
      const Entry& entry = Back(back);
      if (entry.key == key && iteration < entry.until) return true;
    }
    return false;
  }

 private:
  struct Entry {
    uint64_t key = 0;
    int64_t until = 0;
  };

  static constexpr int kBucketBits = 10;
  static size_t Bucket(uint64_t key) {
    return static_cast<size_t>(key * 0x9e3779b97f4a7c15u >> (64 - kBucketBits));
  }
  int& Count(uint64_t key) { return counts_[Bucket(key)]; }

  // The entry that was added `back` additions ago, 1 for the last one. REQUIRES: back <= size_.
  const Entry& Back(size_t back) const {
    return entries_[next_ >= back ? next_ - back : next_ + entries_.size() - back];
  }

  std::vector<Entry> entries_;  // a ring; the last size_ before next_ are in use
  size_t next_ = 0;
  size_t size_ = 0;
  std::vector<int> counts_ = std::vector<int>(size_t{1} << kBucketBits);  // entries in each bucket
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_IMPROVE_TABU_LIST_H_
