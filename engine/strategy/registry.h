// The strategies by name.

#ifndef TRAVERSE_ENGINE_STRATEGY_REGISTRY_H_
#define TRAVERSE_ENGINE_STRATEGY_REGISTRY_H_

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// All strategies of this build, in the order of growing effort.
const std::vector<StrategyEntry>& Strategies();

// The strategy of a job that does not name one.
const std::string& DefaultStrategyName();

// Makes a strategy. Errors: InvalidArgument `name: ...` for an unknown name, `options["x"]: ...`
// for bad options.
absl::StatusOr<std::unique_ptr<Strategy>> MakeStrategy(
    const std::string& name, const std::map<std::string, std::string>& options);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_REGISTRY_H_
