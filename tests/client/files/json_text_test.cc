#include "client/files/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace traverse {
namespace {

TEST(JsonText, IsOneLineOrIndented) {
  const nlohmann::ordered_json json = {{"b", 1}, {"a", {2}}};

  EXPECT_EQ(JsonText(json), R"({"b":1,"a":[2]})");
  EXPECT_EQ(JsonText(json, 1), "{\n \"b\": 1,\n \"a\": [\n  2\n ]\n}");
  EXPECT_EQ(JsonText(nlohmann::json(json)), R"({"a":[2],"b":1})");
}

TEST(JsonText, ReplacesWhatIsNoUtf8) {
  const std::string name = "a\xff";

  EXPECT_EQ(JsonText(name), "\"a\uFFFD\"");
  EXPECT_EQ(JsonText(nlohmann::json(name)), "\"a\uFFFD\"");
  EXPECT_EQ(JsonText(nlohmann::ordered_json(name)), "\"a\uFFFD\"");
}

TEST(ParseJson, KeepsTheOrderWhereItIsAskedTo) {
  const char text[] = R"({"b":1,"a":[2]})";

  EXPECT_EQ(JsonText(ParseOrderedJson(text)), text);
  EXPECT_EQ(JsonText(ParseJson(text)), R"({"a":[2],"b":1})");
}

TEST(ParseJson, DiscardsWhatIsNoJson) {
  for (const char* const text : {"", "{", "{} {}", "nul", "\"\xff\""}) {
    EXPECT_TRUE(ParseJson(text).is_discarded()) << text;
    EXPECT_TRUE(ParseOrderedJson(text).is_discarded()) << text;
  }
}

}  // namespace
}  // namespace traverse
