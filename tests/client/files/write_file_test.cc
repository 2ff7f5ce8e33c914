// Writing whole files: client/files/write_file.

#include "client/files/write_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "absl/strings/str_cat.h"
#include "tests/client/files/scratch_files.h"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;

using WriteFileTest = ScratchFiles;

TEST_F(WriteFileTest, WriteReplacesTheContentAndKeepsThePermissions) {
  Put("file", "old and longer");
  chmod(Path("file").c_str(), 0640);

  ASSERT_TRUE(WriteWholeFile(Path("file"), "new").ok());

  struct stat info {};
  stat(Path("file").c_str(), &info);
  EXPECT_EQ(Get("file"), "new");
  EXPECT_EQ(info.st_mode & 07777, 0640u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(WriteFileTest, WriteMakesNewFilesWithTheUsersMask) {
  const mode_t mask = umask(0027);
  ASSERT_TRUE(WriteWholeFile(Path("file"), "new").ok());
  umask(mask);

  struct stat info {};
  stat(Path("file").c_str(), &info);
  EXPECT_EQ(info.st_mode & 07777, 0640u);
}

TEST_F(WriteFileTest, WriteReplacesTheTargetOfALink) {
  Put("target", "old");
  fs::create_directory(folder_ / "sub");
  fs::create_symlink("../target", folder_ / "sub" / "link");
  fs::create_symlink("missing", folder_ / "dangling");

  ASSERT_TRUE(WriteWholeFile(Path("sub/link"), "new").ok());
  ASSERT_TRUE(WriteWholeFile(Path("dangling"), "made").ok());

  EXPECT_TRUE(fs::is_symlink(folder_ / "sub" / "link"));
  EXPECT_EQ(Get("target"), "new");
  EXPECT_EQ(Get("missing"), "made");
}

TEST_F(WriteFileTest, WriteErrorsNameTheFileAndLeaveNothing) {
  fs::create_symlink("loop", folder_ / "loop");

  EXPECT_THAT(std::string(WriteWholeFile(Path("no/such"), "x").message()),
              EndsWith("no/such: No such file or directory"));
  EXPECT_THAT(std::string(WriteWholeFile(folder_.string(), "x").message()),
              EndsWith(": Is a directory"));
  EXPECT_THAT(std::string(WriteWholeFile(Path("loop"), "x").message()), HasSubstr("loop: "));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(WriteFileTest, WriteThatFailsHalfwayLeavesTheOldFileAndNothingElse) {
  Put("file", "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{1000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);

  const absl::Status status = WriteWholeFile(Path("file"), std::string(5000, 'x'));

  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(std::string(status.message()), EndsWith("file: File too large"));
  EXPECT_EQ(Get("file"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(WriteFileTest, WritePutsANewFileInThePlaceOfTheOldOne) {
  Put("file", "old");
  std::ifstream reader(Path("file"));

  ASSERT_TRUE(WriteWholeFile(Path("file"), "new").ok());

  // Who has the old file open still reads all of it: it was not written into.
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), "old");
  EXPECT_EQ(Get("file"), "new");
}

TEST_F(WriteFileTest, WriteGoesThroughDevices) {
  EXPECT_TRUE(WriteWholeFile("/dev/null", "x").ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THAT(std::string(WriteWholeFile("/dev/full", "x").message()),
              EndsWith("/dev/full: No space left on device"));
}

// As one that was killed leaves it.
TEST_F(WriteFileTest, WriteGoesByATemporaryFileOfAnother) {
  const std::string left = absl::StrCat("file.", getpid(), "-0.tmp");
  Put(left, "half");

  ASSERT_TRUE(WriteWholeFile(Path("file"), "new").ok());

  EXPECT_EQ(Get("file"), "new");
  EXPECT_EQ(Get(left), "half");
}

}  // namespace
}  // namespace traverse
