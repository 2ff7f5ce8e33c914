// The compression of binary G-code: client/containers/bgcode/heatshrink.

#include "client/containers/bgcode/heatshrink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/client/containers/sliced_text.h"
#include "tests/support/status_matchers.h"

namespace traverse::containers {
namespace {

using ::testing::HasSubstr;
using namespace std::string_literals;
using testing::StatusIs;

// Text of a few letters, so that it repeats itself, or of all bytes.
std::string RandomBytes(std::mt19937& random, size_t size, int letters) {
  std::string out;
  for (size_t i = 0; i < size; ++i) {
    out += static_cast<char>(static_cast<int>(random() % static_cast<unsigned>(letters)));
  }
  return out;
}

TEST(Heatshrink, WritesLettersAsNineBits) {
  EXPECT_EQ(HeatshrinkCompress("abc", {12, 4}), "\xb0\xd8\xac\x60");
}

TEST(Heatshrink, WritesARepeatAsDistanceAndLength) {
  // a, then 7 bytes from 1 back: 0, twelve bits of 0, four bits of 6.
  EXPECT_EQ(HeatshrinkCompress("aaaaaaaa", {12, 4}), "\xb0\x80\x01\x80"s);
}

TEST(Heatshrink, TakesZerosForWhatIsBeforeTheBeginning) {
  // 3 bytes from 5 back.
  const auto bytes = HeatshrinkDecompress("\x00\x21\x00"s, {12, 4}, 3);

  ASSERT_OK(bytes);
  EXPECT_EQ(*bytes, "\0\0\0"s);
}

TEST(Heatshrink, GivesBackWhatWasCompressed) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::string bytes = seed % 3 == 0
                                  ? SlicedText(random, 2000)
                                  : RandomBytes(random, random() % 9000, seed % 3 == 1 ? 3 : 256);
    for (const int window : {11, 12}) {
      const std::string packed = HeatshrinkCompress(bytes, {window, 4});
      const auto back = HeatshrinkDecompress(packed, {window, 4}, bytes.size());
      ASSERT_OK(back);
      ASSERT_EQ(*back, bytes);
    }
  }
}

TEST(Heatshrink, RefusesDataThatEndEarlyOrGoOn) {
  const std::string packed = HeatshrinkCompress("some text, some text, some other text", {12, 4});

  EXPECT_THAT(HeatshrinkDecompress(packed.substr(0, 20), {12, 4}, 37),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("too early")));
  EXPECT_THAT(HeatshrinkDecompress(packed + "more", {12, 4}, 37),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("after their end")));
}

TEST(Heatshrink, TakesNoMemoryForASizeThatCannotBe) {
  EXPECT_THAT(
      HeatshrinkDecompress("abc", {12, 4}, UINT32_MAX),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("cannot be 4294967295 bytes")));
}

}  // namespace
}  // namespace traverse::containers
