#include "client/gateway/http/target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace traverse::gateway {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(Target, PathAndQueryWithTheirEscapesUndone) {
  const auto target = ParseTarget("/v1/a%20b?policy=safe&name=a+b%2Fc&flag&empty=&&x==");

  ASSERT_TRUE(target.ok());
  EXPECT_EQ(target->path, "/v1/a b");
  EXPECT_THAT(target->query, ElementsAre(Pair("policy", "safe"), Pair("name", "a b/c"),
                                         Pair("flag", ""), Pair("empty", ""), Pair("x", "=")));
}

TEST(Target, AnAbsoluteOneHasAHost) {
  for (const auto& [target, host, rest] : std::vector<std::array<std::string, 3>>{
           {"http://a.lan:8080/v1?x=1", "a.lan:8080", "/v1?x=1"},
           {"HTTPS://[::1]", "[::1]", "/"},
           {"http:///v1", "", "/v1"},
           {"/http://a", "", "/http://a"},
           {"*", "", "*"}}) {
    std::string_view left = target;
    EXPECT_EQ(TakeOrigin(left), host) << target;
    EXPECT_EQ(left, rest) << target;
  }
}

TEST(Target, RefusesWhatLeadsElsewhere) {
  for (const char* target : {"", "v1", "*", "http://x/", "/..", "/a/../b", "/%2e%2e/b", "/.",
                             "/a%00", "/a%0a", "/%", "/%a", "/%gg", "/a?b=%", "/a?b=%0d%0a"}) {
    EXPECT_FALSE(ParseTarget(target).ok()) << target;
  }
}

TEST(FileName, IsOneSegmentOfUtf8) {
  for (const char* name : {"a.gcode", "a b (1).gcode", "T\xc3\xbcr.gcode", "...", "\xe2\x82\xac"}) {
    EXPECT_TRUE(CheckFileName(name).ok()) << name;
  }
  for (const std::string name : {"", ".", "..", "a/b", "a\\b", "../a", "C:\\a", "a\nb", "a\x7f",
                                 "\xff", "\xc3", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80"}) {
    EXPECT_FALSE(CheckFileName(name).ok()) << name;
  }
  EXPECT_FALSE(CheckFileName(std::string("a\0b", 3)).ok());
  EXPECT_FALSE(CheckFileName(std::string(256, 'a')).ok());
}

}  // namespace
}  // namespace traverse::gateway
