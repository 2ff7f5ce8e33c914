// Deflate and its checksum: client/containers/deflate.

#include "client/containers/deflate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/client/containers/sliced_text.h"
#include "tests/support/status_matchers.h"

namespace traverse::containers {
namespace {

using ::testing::HasSubstr;
using testing::StatusIs;

TEST(Deflate, GivesTheSameBytesOnAnyNumberOfThreads) {
  std::mt19937 random(1);
  const std::string text = SlicedText(random, 150000);  // three pieces
  for (const DeflateForm form : {DeflateForm::kRaw, DeflateForm::kZlib}) {
    const auto one = Deflate(text, form, 6, 1);
    const auto four = Deflate(text, form, 6, 4);
    ASSERT_OK(one);
    ASSERT_OK(four);
    EXPECT_EQ(*one, *four);
    const auto back = Inflate(*one, form, text.size());
    ASSERT_OK(back);
    EXPECT_EQ(*back, text);
  }
}

TEST(Deflate, GivesBackEmptyText) {
  const auto bytes = Deflate("", DeflateForm::kZlib, 6, 2);
  ASSERT_OK(bytes);
  const auto back = Inflate(*bytes, DeflateForm::kZlib, 0);
  ASSERT_OK(back);
  EXPECT_EQ(*back, "");
}

TEST(Inflate, RefusesAnotherSizeThanIsAnnounced) {
  const auto bytes = Deflate("some text", DeflateForm::kRaw, 6, 1);
  ASSERT_OK(bytes);

  EXPECT_THAT(Inflate(*bytes, DeflateForm::kRaw, 8),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("more than the 8 bytes")));
  EXPECT_THAT(Inflate(*bytes, DeflateForm::kRaw, 10),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("have 9 bytes, but the file states 10")));
  EXPECT_THAT(Inflate(*bytes + "x", DeflateForm::kRaw, 9),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("after their end")));
  EXPECT_THAT(Inflate(bytes->substr(0, 5), DeflateForm::kRaw, 9),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("too early")));
  EXPECT_THAT(Inflate(*bytes, DeflateForm::kRaw, UINT32_MAX - 1),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("cannot be")));
}

TEST(Crc32, IsTheOneOfZip) { EXPECT_EQ(Crc32("123456789"), 0xcbf43926u); }

}  // namespace
}  // namespace traverse::containers
