// A small set of the clusters of one stage: those that a walk remembers to have visited.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_MEMORY_SET_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_MEMORY_SET_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace traverse {

// Holds numbers in [0, 64 * kWords).
template <int kWords>
class MemorySet {
 public:
  static constexpr int kCapacity = 64 * kWords;

  MemorySet() = default;
  static MemorySet Of(int element) {
    MemorySet set;
    set.Add(element);
    return set;
  }

  void Add(int element) { words_[Word(element)] |= Bit(element); }
  bool Has(int element) const { return (words_[Word(element)] & Bit(element)) != 0; }

  bool Intersects(const MemorySet& other) const {
    for (size_t w = 0; w < kWords; ++w) {
      if ((words_[w] & other.words_[w]) != 0) return true;
    }
    return false;
  }
  bool IsSubsetOf(const MemorySet& other) const {
    for (size_t w = 0; w < kWords; ++w) {
      if ((words_[w] & ~other.words_[w]) != 0) return false;
    }
    return true;
  }

  friend MemorySet operator&(MemorySet a, const MemorySet& b) {
    for (size_t w = 0; w < kWords; ++w) a.words_[w] &= b.words_[w];
    return a;
  }
  friend MemorySet operator|(MemorySet a, const MemorySet& b) {
    for (size_t w = 0; w < kWords; ++w) a.words_[w] |= b.words_[w];
    return a;
  }
  friend bool operator==(const MemorySet&, const MemorySet&) = default;

  template <typename H>
  friend H AbslHashValue(H h, const MemorySet& set) {
    return H::combine(std::move(h), set.words_);
  }

 private:
  static size_t Word(int element) { return static_cast<size_t>(element) / 64; }
  static uint64_t Bit(int element) { return uint64_t{1} << (element % 64); }

  std::array<uint64_t, static_cast<size_t>(kWords)> words_{};
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_MEMORY_SET_H_
