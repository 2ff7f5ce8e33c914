// Flags of one command: declared in a table, parsed, and looked up by name.
//
// --name=value and --name value are the same, and so are - and _ in names. A switch
// takes no value, but --name=true and --name=false are allowed. `--` ends the flags. If
// a flag is given twice, the last one counts, unless it is repeatable. absl's own flags
// are not used: they are global, know no commands, and exit with 1 where a usage error
// is due.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_FLAGS_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_FLAGS_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "absl/types/span.h"

namespace traverse::cli {

// One flag: a row of a command's table.
struct Flag {
  std::string name;                       // "strategy"; "o" for the one-letter flag -o
  std::string value;                      // the name of its value in help: "NAME"; empty: a switch
  std::string help;                       // one line
  std::vector<std::string> choices = {};  // the allowed values; empty: any
  bool repeatable = false;

  std::string topic = "";  // help lists the flags of a topic together, under its name
};

// The topic of what concerns sliced files alone.
inline constexpr char kSlicedTopic[] = "Sliced G-code";

// `table` with all its rows of one topic.
std::vector<Flag> OfTopic(const std::string& topic, std::vector<Flag> table);

// The rows of `table`, followed by those of `more`.
std::vector<Flag> Joined(std::vector<Flag> table, const std::vector<Flag>& more);

// The flags given to a command, all of them in its table, and its operands.
class Flags {
 public:
  // InvalidArgument for an unknown flag, with the nearest known one as a suggestion; for a missing,
  // superfluous or unknown value.
  static absl::StatusOr<Flags> Parse(absl::Span<const Flag> table,
                                     absl::Span<const std::string> arguments);

  const std::vector<std::string>& operands() const { return operands_; }

  bool Has(const std::string& name) const { return values_.contains(name); }

  // The value, the last one if repeated; `unset` if it was not given.
  std::string Text(const std::string& name, const std::string& unset = "") const;

  // All values of a repeatable flag.
  std::vector<std::string> All(const std::string& name) const;

  // True if the switch is given (and not as --name=false).
  bool Switch(const std::string& name) const { return Text(name, "false") != "false"; }

  // The value as a number in [least, most], a duration above 0, a point "X,Y" in mm. Unset if the
  // flag is not given; InvalidArgument, with the flag's name, if the value is not valid.
  absl::StatusOr<std::optional<double>> Number(const std::string& name, double least,
                                               double most) const;
  absl::StatusOr<std::optional<uint64_t>> Integer(const std::string& name, uint64_t least,
                                                  uint64_t most) const;
  absl::StatusOr<std::optional<absl::Duration>> Duration(const std::string& name) const;
  absl::StatusOr<std::optional<std::pair<double, double>>> Pair(const std::string& name) const;

 private:
  std::map<std::string, std::vector<std::string>> values_;
  std::vector<std::string> operands_;
};

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_FLAGS_H_
