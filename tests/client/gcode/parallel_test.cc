#include "client/gcode/parallel.h"

#include <sys/resource.h>

#include <atomic>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "tests/support/sanitizers.h"

namespace traverse::gcode {
namespace {

// Bytes of addresses that this process has.
rlim_t Addresses() {
  std::ifstream file("/proc/self/statm");
  rlim_t pages = 0;
  file >> pages;
  return pages * 4096;
}

TEST(ParallelFor, DoesEachRoundOnce) {
  std::vector<std::atomic<int>> done(1000);
  ParallelFor(done.size(), 8, [&](size_t i) { ++done[i]; });
  for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
}

TEST(ParallelFor, GoesOnWithTheThreadsThatThereAre) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer needs all addresses";
  rlimit usual;
  ASSERT_EQ(getrlimit(RLIMIT_AS, &usual), 0);
  const rlimit few = {Addresses() + (rlim_t{24} << 20), usual.rlim_max};  // a stack has 8 MB
  std::vector<std::atomic<int>> done(1000);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &few), 0);
  ParallelFor(done.size(), 200, [&](size_t i) { ++done[i]; });
  ASSERT_EQ(setrlimit(RLIMIT_AS, &usual), 0);
  for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
}

TEST(ParallelFor, HandsOnThatThereIsNoMemory) {
  const auto body = [](size_t i) {
    if (i == 500) throw std::bad_alloc();
  };
  EXPECT_THROW(ParallelFor(1000, 4, body), std::bad_alloc);
}

}  // namespace
}  // namespace traverse::gcode
