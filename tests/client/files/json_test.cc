#include "client/files/json.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace traverse {
namespace {

TEST(JsonText, IsOneLineOrIndented) {
  const Json json = JsonObject{{"b", 1}, {"a", JsonArray{2}}, {"c", JsonArray()}};

  EXPECT_EQ(JsonText(json), R"({"b":1,"a":[2],"c":[]})");
  EXPECT_EQ(JsonText(json, 1), "{\n \"b\": 1,\n \"a\": [\n  2\n ],\n \"c\": []\n}");
}

TEST(JsonText, WritesEveryKindOfValue) {
  const Json json =
      JsonArray{nullptr, true,   -1,          std::numeric_limits<uint64_t>::max(), 0.1, 2.0,
                1e300,   "text", JsonObject()};

  EXPECT_EQ(JsonText(json), R"([null,true,-1,18446744073709551615,0.1,2.0,1e+300,"text",{}])");
  EXPECT_EQ(JsonText(std::numeric_limits<double>::infinity()), "null");
}

TEST(JsonText, ReplacesWhatIsNoUtf8) { EXPECT_EQ(JsonText("a\xff\n"), "\"a\uFFFD\\n\""); }

TEST(Json, AddsTheMembersThatItIsAskedFor) {
  Json json;
  json["b"]["c"] = 1;
  json["a"] = 2;
  json["b"]["c"] = 3;
  json.Append({{"d", 4}});

  EXPECT_EQ(JsonText(json), R"({"b":{"c":3},"a":2,"d":4})");
  EXPECT_EQ(json.Find("e"), nullptr);
  EXPECT_EQ(Json(1).Find("e"), nullptr);
}

TEST(ParseJson, KeepsTheOrderAndTheKindsOfNumbers) {
  const char text[] = R"({"b":1,"a":[-2,0.5,1e2,18446744073709551615,null,true,"x"],"c":{}})";

  const std::optional<Json> json = ParseJson(text);

  ASSERT_TRUE(json.has_value());
  EXPECT_EQ(JsonText(*json),
            R"({"b":1,"a":[-2,0.5,100.0,18446744073709551615,null,true,"x"],"c":{}})");
  const JsonArray& items = json->Find("a")->items();
  EXPECT_EQ(items[0].Unsigned(), nullptr);
  EXPECT_EQ(items[0].Number(), -2);
  EXPECT_EQ(items[2].Number(), 100);
  EXPECT_EQ(*items[3].Unsigned(), std::numeric_limits<uint64_t>::max());
  EXPECT_TRUE(items[4].is_null());
  EXPECT_TRUE(*items[5].Bool());
  EXPECT_EQ(*items[6].Text(), "x");
}

TEST(ParseJson, FindsTheLastOfTwoMembersOfOneName) {
  EXPECT_EQ(ParseJson(R"({"a":1,"a":2})")->Find("a")->Number(), 2);
}

TEST(ParseJson, RefusesWhatIsNoJson) {
  for (const char* const text : {"", "{", "{} {}", "nul", "\"\xff\""}) {
    EXPECT_FALSE(ParseJson(text).has_value()) << text;
  }
}

std::string Nested(size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

TEST(ParseJson, RefusesWhatIsNestedTooDeep) {
  EXPECT_TRUE(ParseJson(Nested(kMostJsonDepth)).has_value());
  EXPECT_FALSE(ParseJson(Nested(kMostJsonDepth + 1)).has_value());
  EXPECT_FALSE(ParseJson(std::string(1'000'000, '[')).has_value());
}

TEST(ParseJson, HandsTheItemsOfOneArrayOn) {
  std::vector<std::string> taken;

  const std::optional<Json> json =
      ParseJson(R"({"a":[1],"layers":[{"layers":[2]},[3]],"b":{"layers":[4]}})", "layers",
                [&](const Json& item) { taken.push_back(JsonText(item)); });

  ASSERT_TRUE(json.has_value());
  EXPECT_EQ(JsonText(*json), R"({"a":[1],"layers":[],"b":{"layers":[4]}})");
  EXPECT_EQ(taken, (std::vector<std::string>{R"({"layers":[2]})", "[3]"}));
}

}  // namespace
}  // namespace traverse
