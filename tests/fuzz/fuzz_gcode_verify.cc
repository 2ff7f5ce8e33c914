// Bytes as G-code and the same with some lines changed, to the verifier.
//
// Rules: every text prints what it prints; of two that are said to print the same and can be read,
// the one extrudes as far as the other; breaks come with the rule, and are counted.

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/rewrite.h"
#include "client/gcode/verify/verifier.h"
#include "tests/fuzz/support/check.h"
#include "tests/fuzz/support/gcode_mutator.h"

namespace traverse::fuzz {
namespace {

std::string Changed(std::string_view text, size_t seed) {
  std::string changed(text);
  changed.resize(text.size() + 512);
  changed.resize(MutateGcode(reinterpret_cast<uint8_t*>(changed.data()), text.size(),
                             changed.size(), static_cast<unsigned int>(seed)));
  return changed;
}

VerifyReport Compare(const std::string& was, const std::string& is,
                     VerifyPermissions::Policy policy) {
  VerifyOptions options;
  options.permissions = VerifyPermissions{.policy = policy};
  return CheckGcode(was, "was", is, "is", options);
}

// A number of at most five digits before the point and five behind it: what all machines read
// alike.
bool IsPlainNumber(absl::string_view number) {
  absl::ConsumePrefix(&number, "-");
  const std::vector<absl::string_view> parts = absl::StrSplit(number, '.');
  const auto is_short = [](absl::string_view digits) {
    return digits.size() <= 5 && std::all_of(digits.begin(), digits.end(), absl::ascii_isdigit);
  };
  return parts.size() <= 2 && std::all_of(parts.begin(), parts.end(), is_short) &&
         parts.front().size() + parts.back().size() > 0;
}

// A comment, or a command of a letter and whole number, and words that follow it.
bool IsPlainLine(absl::string_view line) {
  if (line.empty() || line[0] == ';') return true;
  const std::vector<absl::string_view> words = absl::StrSplit(line.substr(0, line.find(" ;")), ' ');
  return (line[0] == 'G' || line[0] == 'M') && std::all_of(words.begin(), words.end(), [](auto w) {
           return !w.empty() && absl::ascii_isupper(static_cast<unsigned char>(w[0])) &&
                  IsPlainNumber(w.substr(1));
         });
}

// True if verifier and reader cannot but take the text for the same print. No line says how far an
// arc by two equal points goes; nor, without M82 and M83, how E counts.
bool IsPlain(absl::string_view text) {
  bool states_mode = false;
  for (const absl::string_view line : absl::StrSplit(text, '\n')) {
    if (!IsPlainLine(line) || absl::StartsWith(line, "G2") || absl::StartsWith(line, "G3")) {
      return false;
    }
    states_mode |= line == "M82" || line == "M83";
  }
  return states_mode;
}

void CheckSameLength(const std::string& was, const std::string& is) {
  if (!IsPlain(was) || !IsPlain(is)) return;
  const auto file = ReadGcode(was, "was");
  const auto other = ReadGcode(is, "is");
  if (!file.ok() || !other.ok() || !gcode::CountAlike(**file, **other)) return;
  const double before = gcode::Measure(**file, was, gcode::PartStart{}).extruded_mm;
  const double after = gcode::Measure(**other, is, gcode::PartStart{}).extruded_mm;
  Check(std::abs(before - after) <= 1e-3 * (1 + before),
        absl::StrCat("said to be the same, extrudes ", before, " mm and ", after, " mm:\n", was,
                     "\nand\n", is));
}

}  // namespace
}  // namespace traverse::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace traverse;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const size_t seed = std::hash<std::string>{}(text);
  const auto policy = static_cast<VerifyPermissions::Policy>(seed % 3);
  const VerifyReport itself = fuzz::Compare(text, text, policy);
  fuzz::Check(itself.ok(),
              itself.ok() ? "" : absl::StrCat(itself.breaks.front().message, "\n", text));
  const std::string changed = fuzz::Changed(text, seed);
  const VerifyReport report = fuzz::Compare(text, changed, policy);
  if (report.ok()) {
    fuzz::CheckSameLength(text, changed);
    return 0;
  }
  for (const VerifyBreak& found : report.breaks) {
    fuzz::Check(
        !found.message.empty() && report.counts[static_cast<size_t>(found.rule)] > 0,
        absl::StrCat("a break of ", std::string(VerifyRuleName(found.rule)), " is counted"));
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  return traverse::fuzz::MutateGcode(data, size, max_size, seed);
}
