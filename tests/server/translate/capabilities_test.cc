// The words that ListStrategies gives are those of proto/VERSIONS.md, which says what each one
// means.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_split.h"
#include "server/translate/translate_result.h"

namespace traverse {
namespace {

// Of the table's rows, such as | `initial_route` | 0.1.0 | Layer.initial_route: ... |
std::vector<std::string> DocumentedWords() {
  std::ifstream page(TRAVERSE_PROTO_DIR "/VERSIONS.md");
  std::vector<std::string> words;
  for (std::string line; std::getline(page, line);) {
    const std::vector<std::string> cells = absl::StrSplit(line, " | ");
    const bool is_row = cells.size() >= 3 && absl::StartsWith(line, "| `") &&
                        absl::EndsWith(cells[0], "`") && cells[2].size() >= 20;
    if (is_row) words.push_back(cells[0].substr(3, cells[0].size() - 4));
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
