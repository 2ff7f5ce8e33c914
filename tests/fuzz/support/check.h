// What a fuzz target says when a rule is broken.

#ifndef TRAVERSE_TESTS_FUZZ_SUPPORT_CHECK_H_
#define TRAVERSE_TESTS_FUZZ_SUPPORT_CHECK_H_

#include <cstdio>
#include <cstdlib>
#include <string>

namespace traverse::fuzz {

// Ends the process, which the fuzzer counts as a finding, unless `rule` holds.
inline void Check(bool rule, const std::string& what) {
  if (rule) return;
  std::fprintf(stderr, "broken: %s\n", what.c_str());
  std::abort();
}

}  // namespace traverse::fuzz

#endif  // TRAVERSE_TESTS_FUZZ_SUPPORT_CHECK_H_
