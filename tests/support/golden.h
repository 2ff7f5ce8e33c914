// Comparison with files that were checked by eye once.

#ifndef TRAVERSE_TESTS_SUPPORT_GOLDEN_H_
#define TRAVERSE_TESTS_SUPPORT_GOLDEN_H_

#include <string>

#include "gtest/gtest.h"

namespace traverse::testing {

// The path of a file under tests/data.
std::string DataPath(const std::string& name);

// True if TRAVERSE_RENEW_GOLDEN=1 is in the environment.
bool RenewsGoldens();

// Success if the file `name` under tests/data holds exactly `actual`. With TRAVERSE_RENEW_GOLDEN=1
// in the environment the file is written instead; the change is then reviewed in the diff.
::testing::AssertionResult MatchesGolden(const std::string& name, const std::string& actual);

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_GOLDEN_H_
