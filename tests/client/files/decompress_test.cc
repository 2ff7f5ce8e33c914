// Compressed texts: client/files/decompress.

#include "client/files/decompress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/client/files/compressed.h"

namespace traverse {
namespace {

using ::testing::EndsWith;

constexpr size_t kLimit = size_t{1} << 20;

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

TEST_P(Compressed, IsPassedOnWithoutBeingKept) {
  for (const size_t size : {size_t{0}, size_t{5}, size_t{65536}, size_t{1000000}}) {
    std::string text(size, 'x');
    if (size > 2) text[2] = 'y';
    const std::string bytes = GetParam()(text);
    const Compression compression = DetectCompression(bytes);

    std::string found;
    const auto take = [&found](std::string_view piece) { found += piece; };

    ASSERT_EQ(DecompressInPieces(bytes, compression, kLimit, take), absl::OkStatus());

    EXPECT_EQ(found, text);
    if (size == 0) continue;
    EXPECT_EQ(DecompressInPieces(bytes, compression, size - 1, take).code(),
              absl::StatusCode::kResourceExhausted);
    const std::string half = bytes.substr(0, bytes.size() / 2);
    EXPECT_EQ(DecompressInPieces(half, compression, kLimit, take),
              Decompress(half, compression, kLimit).status());
  }
}

INSTANTIATE_TEST_SUITE_P(, Compressed, ::testing::Values(&Gzipped, &Xzipped),
                         [](const auto& info) { return info.index == 0 ? "Gzip" : "Xz"; });

}  // namespace
}  // namespace traverse
