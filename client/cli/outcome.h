// How a command ended.

#ifndef TRAVERSE_CLIENT_CLI_OUTCOME_H_
#define TRAVERSE_CLIENT_CLI_OUTCOME_H_

#include <string>
#include <utility>
#include <variant>

#include "absl/status/status.h"

namespace traverse::cli {

// The exit codes that scripts rely on.
enum ExitCode {
  kDone = 0,
  kInputFault = 1,   // the input could not be read, optimised or verified
  kUsageFault = 2,   // the command line is wrong
  kServerFault = 3,  // the server cannot be reached or refused
};

// An exit code, and the line that explains it; no line for kDone.
struct Outcome {
  ExitCode code = kDone;
  std::string message;
};

inline Outcome Done() { return {}; }
inline Outcome InputFault(const absl::Status& status) {
  return {kInputFault, std::string(status.message())};
}
inline Outcome UsageFault(std::string message) { return {kUsageFault, std::move(message)}; }
inline Outcome UsageFault(const absl::Status& status) {
  return {kUsageFault, std::string(status.message())};
}

// A value, or how the command ends without one.
template <typename T>
using Expected = std::variant<T, Outcome>;

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_OUTCOME_H_
