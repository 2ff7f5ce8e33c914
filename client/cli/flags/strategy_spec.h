// Strategies in the form of the command line.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_STRATEGY_SPEC_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_STRATEGY_SPEC_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::cli {

// A strategy with its options: `tabu:representation=nrp:polish=false`. The name of an option alone
// turns a switch on: `greedy:pure` is `greedy:pure=true`.
struct StrategySpec {
  std::string label;      // as the user wrote it; the row's name in tables
  v1::Strategy strategy;  // name and options
};

// The strategies in "SPEC[,SPEC...]". InvalidArgument for an empty name.
absl::StatusOr<std::vector<StrategySpec>> ParseStrategySpecs(const std::string& text);

// An option of --option: "name=value".
absl::StatusOr<std::pair<std::string, std::string>> ParseOption(const std::string& text);

// Gives `options` to each of `specs` whose strategy has an option of that name and does not set
// it itself. Checks all names against the server's `known`. InvalidArgument, with the nearest
// known name, for an unknown strategy, or an option that none of them has. The server checks the
// values.
absl::Status ResolveStrategies(const v1::ListStrategiesResponse& known,
                               absl::Span<const std::pair<std::string, std::string>> options,
                               std::vector<StrategySpec>& specs);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_STRATEGY_SPEC_H_
