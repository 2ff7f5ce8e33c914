// Seeded random numbers. The sequence is the same on every platform, because results depend on it.
//
// Sources: xoshiro256++ and SplitMix64, Blackman and Vigna (2021), "Scrambled linear pseudorandom
// number generators"; bounded integers after Lemire (2019), "Fast random integer generation in an
// interval".

#ifndef TRAVERSE_ENGINE_BASE_RNG_H_
#define TRAVERSE_ENGINE_BASE_RNG_H_

#include <cassert>
#include <cstdint>

namespace traverse {

// One step of SplitMix64: returns a well-mixed value for `state` and advances it.
inline uint64_t SplitMix64(uint64_t& state) {
  state += 0x9e3779b97f4a7c15u;
  uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// The seed of a separate stream for item `index`, such as a layer of a job seeded with `seed`. So
// threads may work on items in any order.
inline uint64_t StreamSeed(uint64_t seed, uint64_t index) {
  uint64_t state = seed;
  uint64_t mixed = SplitMix64(state) ^ (index * 0xd1342543de82ef95u);
  return SplitMix64(mixed);
}

// Random generator. Not thread-safe; each layer has its own.
class Rng {
 public:
  explicit Rng(uint64_t seed) {
    for (uint64_t& word : state_) word = SplitMix64(seed);
  }

  uint64_t Next() {
    const uint64_t result = Rotate(state_[0] + state_[3], 23) + state_[0];
    const uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = Rotate(state_[3], 45);
    return result;
  }

  // Uniform in [0, bound). REQUIRES: 0 < bound.
  uint32_t Below(uint32_t bound) {
    assert(bound > 0);
    uint64_t product = (Next() >> 32) * bound;
    const uint32_t threshold = (0u - bound) % bound;
    while (static_cast<uint32_t>(product) < threshold) product = (Next() >> 32) * bound;
    return static_cast<uint32_t>(product >> 32);
  }

  // Uniform in [first, last]. REQUIRES: first <= last.
  int Between(int first, int last) {
    assert(first <= last);
    return first + static_cast<int>(Below(static_cast<uint32_t>(last - first) + 1u));
  }

  // Uniform in [0, 1).
  double Unit() { return static_cast<double>(Next() >> 11) * 0x1.0p-53; }

 private:
  static uint64_t Rotate(uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }

  uint64_t state_[4];
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_RNG_H_
