// How work grows with its size, told by processor time: a machine may be slow or busy, and a test
// of growth is the same on all.

#ifndef TRAVERSE_TESTS_SUPPORT_GROWTH_H_
#define TRAVERSE_TESTS_SUPPORT_GROWTH_H_

#include <algorithm>
#include <ctime>

namespace traverse::testing {

// Between n log n, for which GrowthOfFour is about 5, and n^2, for which it is 16.
inline constexpr double kSlowGrowth = 9;

// How many times longer `work` takes for 4 * `n` than for `n`. Each is the least of two runs, for
// the first one in a process pays for memory that the next ones find.
template <typename Work>
double GrowthOfFour(int n, Work work) {
  const auto least = [&work](int size) {
    std::clock_t best = 0;
    for (int run = 0; run < 2; ++run) {
      const std::clock_t begin = std::clock();
      work(size);
      const std::clock_t took = std::clock() - begin;
      best = run == 0 ? took : std::min(best, took);
    }
    return static_cast<double>(std::max<std::clock_t>(1, best));
  };
  const double small = least(n);
  return least(4 * n) / small;
}

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_GROWTH_H_
