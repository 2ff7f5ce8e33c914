#include "tests/support/golden.h"

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/support/source_dir.h"

namespace traverse::testing {

std::string DataPath(const std::string& name) {
  return std::string(TRAVERSE_SOURCE_DIR) + "/tests/data/" + name;
}

bool RenewsGoldens() { return std::getenv("TRAVERSE_RENEW_GOLDEN") != nullptr; }

::testing::AssertionResult MatchesGolden(const std::string& name, const std::string& actual) {
  const std::string path = DataPath(name);
  if (RenewsGoldens()) {
    std::ofstream(path, std::ios::binary) << actual;
    return ::testing::AssertionSuccess();
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return ::testing::AssertionFailure() << path << " is missing";
  const std::string expected((std::istreambuf_iterator<char>(file)),
                             std::istreambuf_iterator<char>());
  if (actual == expected) return ::testing::AssertionSuccess();
  size_t at = 0;
  int line = 1;
  for (; at < actual.size() && at < expected.size() && actual[at] == expected[at]; ++at) {
    line += actual[at] == '\n';
  }
  return ::testing::AssertionFailure()
         << path << ":" << line << ": expected ..." << expected.substr(at, 60) << "..., found ..."
         << actual.substr(at, 60) << "...";
}

}  // namespace traverse::testing
