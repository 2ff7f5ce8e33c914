#include "server/net/open_files.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace traverse {
namespace {

// Has its own limit of open files.
class OpenFilesTest : public ::testing::Test {
 protected:
  OpenFilesTest() { getrlimit(RLIMIT_NOFILE, &usual_); }
  ~OpenFilesTest() override { setrlimit(RLIMIT_NOFILE, &usual_); }

  void Limit(rlim_t files) const {
    const rlimit limit{files, usual_.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
  }

 private:
  rlimit usual_{};
};

TEST_F(OpenFilesTest, SomeAreTheProcesssOwn) {
  Limit(1024);
  EXPECT_EQ(MaxOpenFiles(), 1024);
  EXPECT_EQ(FilesFor(1), 1024 - 128);
  EXPECT_EQ(FilesFor(0.25), (1024 - 128) / 4);
  Limit(400);
  EXPECT_EQ(FilesFor(1), 300);
}

TEST_F(OpenFilesTest, PlacesAreAsManyAsTheyHaveRoomFor) {
  Limit(400);
  EXPECT_EQ(PlacesFor(0.5, 2, 1000), 75);
  EXPECT_EQ(PlacesFor(0.5, 2, 10), 10);
  EXPECT_EQ(PlacesFor(0.001, 2, 10), 1);
}

TEST_F(OpenFilesTest, ALimitThatChangesCounts) {
  Limit(400);
  EXPECT_EQ(PlacesFor(1, 1, 1000), 300);
  Limit(200);
  EXPECT_EQ(PlacesFor(1, 1, 1000), 150);
}

}  // namespace
}  // namespace traverse
