#include "client/gateway/spool/spool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "client/gateway/spool/shares.h"
#include "tests/support/scratch_folder.h"

namespace traverse::gateway {
namespace {

class SpoolTest : public ::testing::Test {
 protected:
  const testing::ScratchFolder folder_;
  const std::unique_ptr<Spool> spool_ = *Spool::Open(folder_.path(), 100);
};

TEST_F(SpoolTest, ReturnsWhatWasPutIn) {
  const std::shared_ptr<SpoolFile> file = *spool_->NewFile();

  EXPECT_TRUE(file->Append("G1 X1\n").ok());
  EXPECT_TRUE(file->Append("G1 X2\n").ok());

  EXPECT_EQ(*file->ReadAll(), "G1 X1\nG1 X2\n");
  char piece[4];
  EXPECT_EQ(*file->ReadAt(9, piece, 4), 3u);
  EXPECT_EQ(std::string(piece, 3), "X2\n");
  EXPECT_EQ(*file->ReadAt(99, piece, 4), 0u);
}

TEST_F(SpoolTest, ItsFilesHaveNoNames) {
  const std::shared_ptr<SpoolFile> file = *spool_->NewFile();
  EXPECT_TRUE(file->Append("G1 X1\n").ok());

  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(SpoolTest, AllFilesTogetherAreBounded) {
  std::shared_ptr<SpoolFile> one = *spool_->NewFile();
  const std::shared_ptr<SpoolFile> other = *spool_->NewFile();
  EXPECT_TRUE(one->Append(std::string(60, 'a')).ok());

  EXPECT_EQ(other->Append(std::string(41, 'b')).code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(spool_->used_bytes(), 60u);
  one.reset();
  EXPECT_TRUE(other->Append(std::string(100, 'b')).ok());
  EXPECT_EQ(*other->ReadAll(), std::string(100, 'b'));
}

TEST_F(SpoolTest, ACallerHasAShare) {
  const std::shared_ptr<SpoolFile> hoard = *spool_->NewFile("a");
  EXPECT_TRUE(hoard->Append(std::string(50, 'a')).ok());
  EXPECT_EQ(hoard->Append("a").code(), absl::StatusCode::kResourceExhausted);
  std::shared_ptr<SpoolFile> second = *spool_->NewFile("b");
  EXPECT_TRUE(second->Append(std::string(25, 'b')).ok());

  // The last quarter is for small ones.
  EXPECT_EQ(second->Append("b").code(), absl::StatusCode::kResourceExhausted);
  const std::shared_ptr<SpoolFile> third = *spool_->NewFile("c");
  EXPECT_TRUE(third->Append(std::string(6, 'c')).ok());
  EXPECT_EQ(third->Append("c").code(), absl::StatusCode::kResourceExhausted);
  second.reset();
  EXPECT_TRUE(third->Append(std::string(19, 'c')).ok());
}

TEST(Shares, OfAFewThingsAreOneAtLeast) {
  Shares one(1);
  EXPECT_FALSE(one.Take(1, "a").has_value());

  Shares four(4);
  for (const char* caller : {"a", "a", "b", "c"}) EXPECT_FALSE(four.Take(1, caller).has_value());
  EXPECT_TRUE(four.Take(1, "d").has_value());
}

TEST_F(SpoolTest, AFolderThatIsNotThereIsSaid) {
  const auto spool = Spool::Open("/not/there", 100);

  EXPECT_EQ(spool.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(spool.status().message()), ::testing::HasSubstr("/not/there"));
}

}  // namespace
}  // namespace traverse::gateway
