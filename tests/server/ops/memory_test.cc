#include "server/ops/memory.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "tests/support/scratch_folder.h"

namespace traverse {
namespace {

// A machine of 8 GB, as its files tell.
class MemoryLimitTest : public ::testing::Test {
 protected:
  MemoryLimitTest() { Write("/proc/meminfo", "MemTotal:        8000000 kB\nMemFree: 1 kB\n"); }

  void Write(const std::string& path, const std::string& text) const {
    const std::filesystem::path file = folder_.path() + path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  int64_t Limit() const { return MemoryLimit(folder_.path()); }

 private:
  const testing::ScratchFolder folder_;
};

TEST_F(MemoryLimitTest, IsThatOfTheMachineWithoutGroups) { EXPECT_EQ(Limit(), 8'192'000'000); }

TEST_F(MemoryLimitTest, OfVersion2IsTheLeastOnTheWayToTheRoot) {
  Write("/proc/self/cgroup", "0::/farm/server\n");
  Write("/sys/fs/cgroup/farm/server/memory.max", "max\n");
  Write("/sys/fs/cgroup/farm/memory.max", "600000000\n");
  EXPECT_EQ(Limit(), 600'000'000);
}

TEST_F(MemoryLimitTest, OfAContainerIsThatOfItsRoot) {
  Write("/proc/self/cgroup", "0::/\n");
  Write("/sys/fs/cgroup/memory.max", "500000000\n");
  EXPECT_EQ(Limit(), 500'000'000);
}

TEST_F(MemoryLimitTest, OfVersion1IsFoundWhereTheGroupIsThatOfTheHost) {
  Write("/proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/docker/abc\n0::/\n");
  Write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "400000000\n");
  EXPECT_EQ(Limit(), 400'000'000);
  // Its word for no limit.
  Write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(Limit(), 8'192'000'000);
}

TEST(ResidentBytes, GrowWithWhatIsUsed) {
  const int64_t before = ResidentBytes();
  const std::string used(50 << 20, 'x');
  EXPECT_GT(ResidentBytes() - before, 40 << 20) << used.size();
}

TEST(GiveLargeBlocksBack, HoldsForThoseAfterTheFirst) {
  if (mallinfo2().arena == 0) GTEST_SKIP() << "not glibc's allocator";
  const auto mapped_for = [](size_t bytes) {
    const size_t before = mallinfo2().hblkhd;
    const auto block = std::make_unique<char[]>(bytes);
    return mallinfo2().hblkhd - before;
  };
  GiveLargeBlocksBack();

  for (const size_t bytes : {size_t{30} << 20, size_t{12} << 20, size_t{5} << 20}) {
    EXPECT_GE(mapped_for(bytes), bytes);
  }
  EXPECT_EQ(mapped_for(1 << 20), 0u);
}

}  // namespace
}  // namespace traverse
