// The options of the thesis's framework, which `tabu` and `exact` share.

#ifndef TRAVERSE_ENGINE_STRATEGY_OPTIONS_FRAMEWORK_OPTIONS_H_
#define TRAVERSE_ENGINE_STRATEGY_OPTIONS_FRAMEWORK_OPTIONS_H_

#include <map>
#include <string>
#include <vector>

#include "engine/strategy/options/options.h"
#include "engine/weller/framework_search.h"

namespace traverse {

// Rows of a strategy's table: representation, Dp, neighborhoods. Descriptions begin with `of`.
std::vector<OptionSpec> FrameworkOptionSpecs(const char* of);

// Their values; everything else has its default.
FrameworkOptions FrameworkOptionsFrom(const StrategyOptions& values);

// Adds to a solution's statistics how many points each reduction left and how long each step took.
void DescribeFramework(const FrameworkResult& result, const FrameworkOptions& options,
                       std::map<std::string, double>& statistics);

// A row for a number, and one for a switch.
OptionSpec NumberOption(const char* name, OptionSpec::Type type, const char* default_value,
                        double minimum, double maximum, const char* description);
OptionSpec SwitchOption(const char* name, const char* default_value, const char* description);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_OPTIONS_FRAMEWORK_OPTIONS_H_
