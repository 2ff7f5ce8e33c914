// How the process takes its memory: client/files/process_memory.

#include "client/files/process_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>
#include <vector>

#include "tests/support/sanitizers.h"

namespace traverse {
namespace {

constexpr size_t kBytes = size_t{24} << 20;

int64_t PagesTaken() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

// More than malloc keeps of its own accord.
size_t UseMuch() {
  std::vector<std::string> texts;
  for (int i = 0; i < 4; ++i) texts.emplace_back(kBytes, static_cast<char>('a' + i));
  return texts[1].find_first_not_of('b');
}

TEST(ProcessMemory, IsKeptWhenFreed) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers have a malloc of their own";
  KeepFreedMemory();
  UseMuch();
  UseMuch();
  const int64_t before = PagesTaken();

  EXPECT_EQ(UseMuch(), std::string::npos);

  EXPECT_LT(PagesTaken() - before, 2000);  // of 24,000
}

TEST(ProcessMemory, ReservesRoomForWhatIsThereAndMore) {
  for (const size_t bytes : {size_t{0}, size_t{100}, kBytes, kBytes + 12345}) {
    std::string text = "kept";

    ReserveLarge(text, bytes);

    EXPECT_EQ(text, "kept");
    EXPECT_GE(text.capacity(), bytes);
    const char* const room = text.data();
    text.resize(text.capacity(), 'x');
    EXPECT_EQ(text.data(), room);
    EXPECT_EQ(text.find_first_not_of('x', 4), std::string::npos);
  }
}

}  // namespace
}  // namespace traverse
