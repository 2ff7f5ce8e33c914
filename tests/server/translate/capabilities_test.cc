// The words that ListStrategies gives are those of proto/VERSIONS.md, which says what each one
// means.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "server/translate/translate_result.h"

namespace traverse {
namespace {

// Of the table's rows, such as | `initial_route` | 0.1.0 | Layer.initial_route: ... |
std::vector<std::string> DocumentedWords() {
  std::ifstream page(TRAVERSE_PROTO_DIR "/VERSIONS.md");
  const std::regex row(R"(\| `(\w+)` \| \d+\.\d+\.\d+ \| .{20,} \|)");
  std::vector<std::string> words;
  for (std::string line; std::getline(page, line);) {
    std::smatch parts;
    if (std::regex_match(line, parts, row)) words.push_back(parts[1]);
  }
  return words;
}

TEST(Capabilities, AreTheWordsOfTheDocument) {
  v1::ListStrategiesResponse response;
  ListStrategies(response);

  EXPECT_THAT(response.capabilities(), ::testing::ElementsAreArray(DocumentedWords()));
  EXPECT_THAT(response.capabilities(), ::testing::Contains("partial_answers"));
  EXPECT_TRUE(std::is_sorted(response.capabilities().begin(), response.capabilities().end()));
}

}  // namespace
}  // namespace traverse
