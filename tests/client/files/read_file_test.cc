// Reading whole files: client/files/read_file.

#include "client/files/read_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/client/files/compressed.h"
#include "tests/client/files/scratch_files.h"

namespace traverse {
namespace {

using ::testing::EndsWith;

using ReadFileTest = ScratchFiles;

TEST_F(ReadFileTest, ReadsPlainAndCompressedAlike) {
  Put("plain", "text\n");
  Put("zipped", Gzipped("text\n"));
  Put("xzipped", Xzipped("text\n"));
  Put("empty", "");

  EXPECT_EQ(*ReadWholeFile(Path("plain")), "text\n");
  EXPECT_EQ(*ReadWholeFile(Path("zipped")), "text\n");
  EXPECT_EQ(*ReadWholeFile(Path("xzipped")), "text\n");
  EXPECT_EQ(*ReadWholeFile(Path("empty")), "");
}

TEST_F(ReadFileTest, ReadErrorsNameTheFile) {
  Put("big", std::string(1000, 'x'));
  Put("cut.gz", Gzipped("text").substr(0, 12));

  EXPECT_EQ(ReadWholeFile("no/such").status().message(), "no/such: No such file or directory");
  EXPECT_THAT(std::string(ReadWholeFile(folder_.string()).status().message()),
              EndsWith(": Is a directory"));
  EXPECT_THAT(std::string(ReadWholeFile(Path("big"), 999).status().message()),
              EndsWith("big: longer than 0 MiB"));
  EXPECT_EQ(ReadWholeFile(Path("big"), 1000)->size(), 1000u);
  EXPECT_THAT(std::string(ReadWholeFile(Path("cut.gz")).status().message()),
              EndsWith("cut.gz: gzip data end too early"));
}

}  // namespace
}  // namespace traverse
