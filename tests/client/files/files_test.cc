// Reading and writing whole files: client/files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lzma.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "absl/strings/str_cat.h"
#include "client/files/decompress.h"
#include "client/files/read_file.h"
#include "client/files/write_file.h"
#include "tests/support/scratch_folder.h"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr size_t kLimit = size_t{1} << 20;

std::string Gzipped(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, text.size()) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string Xzipped(const std::string& text) {
  std::string out(lzma_stream_buffer_bound(text.size()), '\0');
  size_t used = 0;
  EXPECT_EQ(lzma_easy_buffer_encode(6, LZMA_CHECK_CRC64, nullptr,
                                    reinterpret_cast<const uint8_t*>(text.data()), text.size(),
                                    reinterpret_cast<uint8_t*>(out.data()), &used, out.size()),
            LZMA_OK);
  out.resize(used);
  return out;
}

class Files : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return scratch_.Path(name); }
  void Put(const std::string& name, const std::string& bytes) const {
    std::ofstream(Path(name), std::ios::binary) << bytes;
  }
  std::string Get(const std::string& name) const {
    std::ifstream file(Path(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }

  const testing::ScratchFolder scratch_;
  const fs::path folder_ = scratch_.path();
};

class Compressed : public ::testing::TestWithParam<std::string (*)(const std::string&)> {};

TEST_P(Compressed, GivesBackTheText) {
  for (const size_t size : {size_t{0}, size_t{1}, size_t{65536}, size_t{1000000}}) {
    std::string text(size, 'x');
    for (size_t i = 0; i < size; i += 7) text[i] = static_cast<char>(i * i % 251);
    const std::string bytes = GetParam()(text);

    const absl::StatusOr<std::string> plain = Decompress(bytes, DetectCompression(bytes), kLimit);

    ASSERT_TRUE(plain.ok()) << plain.status();
    EXPECT_TRUE(*plain == text) << size;
  }
}

TEST_P(Compressed, GivesBackTwoStreamsOneAfterAnother) {
  const std::string bytes = GetParam()("one ") + GetParam()("two");

  EXPECT_EQ(*Decompress(bytes, DetectCompression(bytes), kLimit), "one two");
}

TEST_P(Compressed, RefusesEveryCut) {
  const std::string bytes = GetParam()("some text that is worth the trouble");

  for (size_t length = 6; length < bytes.size(); ++length) {
    const absl::StatusOr<std::string> plain =
        Decompress(bytes.substr(0, length), DetectCompression(bytes), kLimit);
    EXPECT_EQ(plain.status().code(), absl::StatusCode::kInvalidArgument) << length;
    EXPECT_THAT(std::string(plain.status().message()), EndsWith("end too early")) << length;
  }
}

TEST_P(Compressed, RefusesDamage) {
  std::string bytes = GetParam()(std::string(10000, 'x') + "y" + std::string(999, 'z'));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);

  EXPECT_EQ(Decompress(bytes, DetectCompression(bytes), kLimit).status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST_P(Compressed, LimitsTheResultToTheByte) {
  const std::string bytes = GetParam()(std::string(kLimit, ' '));

  EXPECT_EQ(Decompress(bytes, DetectCompression(bytes), kLimit)->size(), kLimit);
  EXPECT_EQ(Decompress(bytes, DetectCompression(bytes), kLimit - 1).status().code(),
            absl::StatusCode::kResourceExhausted);
}

TEST_P(Compressed, IsMeasuredWithoutBeingKept) {
  for (const size_t size : {size_t{0}, size_t{5}, size_t{65536}, size_t{1000000}}) {
    std::string text(size, 'x');
    if (size > 2) text[2] = 'y';
    const std::string bytes = GetParam()(text);
    const Compression compression = DetectCompression(bytes);

    const absl::StatusOr<DecompressedSize> found = MeasureDecompressed(bytes, compression, kLimit);

    ASSERT_TRUE(found.ok()) << found.status();
    EXPECT_EQ(found->bytes, size);
    EXPECT_EQ(found->first, text.substr(0, 16));
    if (size == 0) continue;
    EXPECT_EQ(MeasureDecompressed(bytes, compression, size - 1).status().code(),
              absl::StatusCode::kResourceExhausted);
    EXPECT_EQ(MeasureDecompressed(bytes.substr(0, bytes.size() / 2), compression, kLimit).status(),
              Decompress(bytes.substr(0, bytes.size() / 2), compression, kLimit).status());
  }
}

INSTANTIATE_TEST_SUITE_P(, Compressed, ::testing::Values(&Gzipped, &Xzipped),
                         [](const auto& info) { return info.index == 0 ? "Gzip" : "Xz"; });

TEST_F(Files, ReadsPlainAndCompressedAlike) {
  Put("plain", "text\n");
  Put("zipped", Gzipped("text\n"));
  Put("xzipped", Xzipped("text\n"));
  Put("empty", "");

  EXPECT_EQ(*ReadWholeFile(Path("plain")), "text\n");
  EXPECT_EQ(*ReadWholeFile(Path("zipped")), "text\n");
  EXPECT_EQ(*ReadWholeFile(Path("xzipped")), "text\n");
  EXPECT_EQ(*ReadWholeFile(Path("empty")), "");
}

TEST_F(Files, ReadErrorsNameTheFile) {
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

TEST_F(Files, WriteReplacesTheContentAndKeepsThePermissions) {
  Put("file", "old and longer");
  chmod(Path("file").c_str(), 0640);

  ASSERT_TRUE(WriteWholeFile(Path("file"), "new").ok());

  struct stat info {};
  stat(Path("file").c_str(), &info);
  EXPECT_EQ(Get("file"), "new");
  EXPECT_EQ(info.st_mode & 07777, 0640u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(Files, WriteMakesNewFilesWithTheUsersMask) {
  const mode_t mask = umask(0027);
  ASSERT_TRUE(WriteWholeFile(Path("file"), "new").ok());
  umask(mask);

  struct stat info {};
  stat(Path("file").c_str(), &info);
  EXPECT_EQ(info.st_mode & 07777, 0640u);
}

TEST_F(Files, WriteReplacesTheTargetOfALink) {
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

TEST_F(Files, WriteErrorsNameTheFileAndLeaveNothing) {
  fs::create_symlink("loop", folder_ / "loop");

  EXPECT_THAT(std::string(WriteWholeFile(Path("no/such"), "x").message()),
              EndsWith("no/such: No such file or directory"));
  EXPECT_THAT(std::string(WriteWholeFile(folder_.string(), "x").message()),
              EndsWith(": Is a directory"));
  EXPECT_THAT(std::string(WriteWholeFile(Path("loop"), "x").message()), HasSubstr("loop: "));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(Files, WriteThatFailsHalfwayLeavesTheOldFileAndNothingElse) {
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

TEST_F(Files, WritePutsANewFileInThePlaceOfTheOldOne) {
  Put("file", "old");
  std::ifstream reader(Path("file"));

  ASSERT_TRUE(WriteWholeFile(Path("file"), "new").ok());

  // Who has the old file open still reads all of it: it was not written into.
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), "old");
  EXPECT_EQ(Get("file"), "new");
}

TEST_F(Files, WriteGoesThroughDevices) {
  EXPECT_TRUE(WriteWholeFile("/dev/null", "x").ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THAT(std::string(WriteWholeFile("/dev/full", "x").message()),
              EndsWith("/dev/full: No space left on device"));
}

// As one that was killed leaves it.
TEST_F(Files, WriteGoesByATemporaryFileOfAnother) {
  const std::string left = absl::StrCat("file.", getpid(), "-0.tmp");
  Put(left, "half");

  ASSERT_TRUE(WriteWholeFile(Path("file"), "new").ok());

  EXPECT_EQ(Get("file"), "new");
  EXPECT_EQ(Get(left), "half");
}

}  // namespace
}  // namespace traverse
