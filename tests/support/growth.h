// How work grows with its size, told by processor time: a machine may be slow or busy, and a test
// of growth is the same on all.

#ifndef TRAVERSE_TESTS_SUPPORT_GROWTH_H_
#define TRAVERSE_TESTS_SUPPORT_GROWTH_H_

#include <algorithm>
#include <ctime>
#include <limits>

namespace traverse::testing {

// Between n log n, for which GrowthOfFour is about 5, and n^2, for which it is 16.
inline constexpr double kSlowGrowth = 9;

// How many times longer `work` takes for 4 * `n` than for `n`: the least of up to four pairs, of
// which one that shows slow growth is the last. Other programs take the cache that the larger one
// needs, and may do so in one pair; growth shows in all of them.
template <typename Work>
double GrowthOfFour(int n, Work work) {
  const auto seconds = [&work](int size) {
    const std::clock_t begin = std::clock();
    work(size);
    return static_cast<double>(std::max<std::clock_t>(1, std::clock() - begin));
  };
  work(n);  // the first one in a process pays for memory that the next ones find
  double least = std::numeric_limits<double>::infinity();
  for (int pair = 0; pair < 4 && least >= kSlowGrowth; ++pair) {
    const double small = seconds(n);
    least = std::min(least, seconds(4 * n) / small);
  }
  return least;
}

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_GROWTH_H_
