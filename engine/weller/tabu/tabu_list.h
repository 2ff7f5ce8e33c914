// The memory of a tabu search: the moves that are forbidden for a while.
//
// Source: thesis 2.2.8 (p. 28), table 4.2 (p. 84): 1.5 entries for each contour, each for a number
// of iterations; Glover and Laguna (1998).

#ifndef TRAVERSE_ENGINE_WELLER_TABU_TABU_LIST_H_
#define TRAVERSE_ENGINE_WELLER_TABU_TABU_LIST_H_

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace traverse {

// A move has a key. At most `capacity` moves are forbidden at a time: a new one then replaces the
// oldest. Memory: 16 bytes for each of the moves that were forbidden at a time.
class TabuList {
 public:
  explicit TabuList(int capacity) : capacity_(static_cast<size_t>(capacity)) {}

  void Clear() {
    for (const Entry& entry : entries_) --Count(entry.key);
    entries_.clear();
    next_ = 0;
  }

  // Changes the capacity; if it falls, the oldest moves go. O(capacity) if it changes.
  void Resize(int capacity) {
    const size_t wanted = static_cast<size_t>(capacity);
    if (wanted == capacity_) return;
    const size_t kept = std::min(wanted, entries_.size());
    for (size_t back = entries_.size(); back > kept; --back) --Count(Back(back).key);
    std::vector<Entry> entries;
    for (size_t back = kept; back > 0; --back) entries.push_back(Back(back));
    entries_ = std::move(entries);
    capacity_ = wanted;
    next_ = kept == wanted ? 0 : kept;
  }

  // Forbids `key` until iteration `until`, exclusive.
  void Add(uint64_t key, int64_t until) {
    if (capacity_ == 0) return;
    if (entries_.size() < capacity_) {
      entries_.push_back({key, until});
    } else {
      --Count(entries_[next_].key);
      entries_[next_] = {key, until};
    }
    next_ = next_ + 1 == capacity_ ? 0 : next_ + 1;
    ++Count(key);
  }

  // O(1) for most keys that are not in the list, else O(capacity).
  bool Forbids(uint64_t key, int64_t iteration) const {
    if (counts_[Bucket(key)] == 0) return false;
    for (size_t back = 1; back <= entries_.size(); ++back) {
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

  // The entry that was added `back` additions ago, 1 for the last one. REQUIRES: back <=
  // entries_.size().
  const Entry& Back(size_t back) const {
    assert(0 < back && back <= entries_.size());
    return entries_[next_ >= back ? next_ - back : next_ + entries_.size() - back];
  }

  size_t capacity_;
  std::vector<Entry> entries_;                                            // a ring once it is full
  size_t next_ = 0;                                                       // where the next one goes
  std::vector<int> counts_ = std::vector<int>(size_t{1} << kBucketBits);  // entries in each bucket
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_TABU_LIST_H_
