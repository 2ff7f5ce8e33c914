// Options of strategies: their definitions, and the values of one job.

#ifndef TRAVERSE_ENGINE_STRATEGY_OPTIONS_OPTIONS_H_
#define TRAVERSE_ENGINE_STRATEGY_OPTIONS_OPTIONS_H_

#include <cassert>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace traverse {

// One option of a strategy: a row of the strategy's table of options.
struct OptionSpec {
  enum class Type { kBool, kInt, kDouble, kChoice };

  std::string name;  // lower_case_with_underscores
  Type type = Type::kBool;
  std::string default_value;        // as text: "true", "250", "2.5", "sp"
  double minimum = 0;               // for numbers, inclusive
  double maximum = 0;               // for numbers, inclusive
  std::vector<std::string> values;  // for a choice
  std::string description;          // what it does, with its unit
};

// An option that is true or false.
OptionSpec BoolOption(const char* name, bool default_value, const char* description);

// The option `bound`, which several strategies have; see StrategyTraits::bound_effort.
OptionSpec BoundOption(bool default_value);

// The option `chain_bound`, off by default; see StrategyTraits::chain_bounding.
OptionSpec ChainBoundOption();

// The option `pure` of the sources' methods, off by default. It runs the method as published; a
// valid route is the only promise left.
OptionSpec PureOption(const char* description);

// The values of a strategy's options, all of them set. Immutable.
class StrategyOptions {
 public:
  // The defaults of `specs`, overridden by `texts`. InvalidArgument `options["tenure"]: ...` for a
  // name that is not in `specs`, or a text that is not a value of its type or is out of range.
  static absl::StatusOr<StrategyOptions> Parse(const std::vector<OptionSpec>& specs,
                                               const std::map<std::string, std::string>& texts);

  StrategyOptions() = default;

  // REQUIRES: the strategy's specs have `name`, with this type.
  bool Bool(const std::string& name) const {
    return ValueOf(name, OptionSpec::Type::kBool).boolean;
  }
  int64_t Int(const std::string& name) const {
    return ValueOf(name, OptionSpec::Type::kInt).integer;
  }
  double Double(const std::string& name) const {
    return ValueOf(name, OptionSpec::Type::kDouble).real;
  }
  const std::string& Choice(const std::string& name) const {
    return ValueOf(name, OptionSpec::Type::kChoice).text;
  }

 private:
  struct Value {
    OptionSpec::Type type = OptionSpec::Type::kBool;
    bool boolean = false;
    int64_t integer = 0;
    double real = 0;
    std::string text;
  };

  const Value& ValueOf(const std::string& name, [[maybe_unused]] OptionSpec::Type type) const {
    const Value& value = values_.at(name);
    assert(value.type == type);
    return value;
  }

  static absl::StatusOr<Value> ParseValue(const OptionSpec& spec, const std::string& text);

  std::map<std::string, Value> values_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_OPTIONS_OPTIONS_H_
