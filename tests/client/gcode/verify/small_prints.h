// Prints of a few lines for the rules of the verifier, and what it says of two of them.

#ifndef TRAVERSE_TESTS_CLIENT_GCODE_VERIFY_SMALL_PRINTS_H_
#define TRAVERSE_TESTS_CLIENT_GCODE_VERIFY_SMALL_PRINTS_H_

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "client/gcode/verify/verifier.h"

namespace traverse::gcode::testing {

using Policy = VerifyPermissions::Policy;

// All rules but those by which most of what a test changes would be a break in any case.
inline constexpr uint32_t kRulesOfTheirOwn =
    ~(RuleBit(VerifyRule::kKeptTravels) | RuleBit(VerifyRule::kMadeOfParts) |
      RuleBit(VerifyRule::kRest));

// "lifts" or "order seam": those of `rules` that are broken. Each break names a line of both
// prints.
inline std::string Broken(const std::string& original, const std::string& optimised,
                          VerifyPermissions permissions = {}, uint32_t rules = kRulesOfTheirOwn) {
  VerifyOptions options;
  options.rules = rules;
  options.permissions = permissions;
  const VerifyReport report = CheckGcode(original, "a", optimised, "b", options);
  for (const VerifyBreak& found : report.breaks) {
    EXPECT_TRUE(found.original_line > 0 && found.optimised_line > 0) << found.message;
  }
  std::string names;
  for (size_t rule = 0; rule < report.counts.size(); ++rule) {
    if (report.counts[rule] == 0) continue;
    absl::StrAppend(&names, names.empty() ? "" : " ",
                    std::string(VerifyRuleName(static_cast<VerifyRule>(rule))));
  }
  return names;
}

inline std::string Broken(const std::string& original, const std::string& optimised,
                          Policy policy) {
  VerifyPermissions permissions;
  permissions.policy = policy;
  return Broken(original, optimised, permissions);
}

inline std::string FirstMessage(const std::string& original, const std::string& optimised) {
  VerifyOptions options;
  options.rules = kRulesOfTheirOwn;
  const VerifyReport report = CheckGcode(original, "a", optimised, "b", options);
  return report.ok() ? "" : report.breaks.front().message;
}

// `text` with the first `from` replaced.
inline std::string With(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline const std::string kHead = "M83\n;LAYER_CHANGE\nG1 Z.2 F9000\n";

// A travel move to a point with filament pulled back.
inline std::string Travel(const std::string& to) {
  return absl::StrCat("G1 E-1 F2100\nG1 ", to, " F9000\nG1 E1 F2100\n");
}

// A square wall of 10 mm that begins at its lower left corner; and its other entries.
inline const std::string kWall = ";TYPE:External perimeter\nG1 F1200\n";
inline const std::string kSquare =
    Travel("X10 Y10") + kWall + "G1 X20 Y10 E.4\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\nG1 X10 Y10 E.4\n";
inline const std::string kSquareElsewhere =
    Travel("X20 Y10") + kWall + "G1 X20 Y20 E.4\nG1 X10 Y20 E.4\nG1 X10 Y10 E.4\nG1 X20 Y10 E.4\n";
inline const std::string kSquareTurned =
    Travel("X10 Y10") + kWall + "G1 X10 Y20 E.4\nG1 X20 Y20 E.4\nG1 X20 Y10 E.4\nG1 X10 Y10 E.4\n";

inline std::string Line(const std::string& type, const std::string& from, const std::string& to) {
  return absl::StrCat(Travel(from), ";TYPE:", type, "\nG1 F1800\nG1 ", to, " E.3\n");
}

// One path of infill: to the right, up and back.
inline const std::string kZigzag =
    Travel("X10 Y10") +
    ";TYPE:Internal infill\nG1 F1800\nG1 X20 Y10 E.3\nG1 X20 Y11 E.1\n"
    "G1 X10 Y11 E.3\n";

// From within the square to beside it, and on within the square.
inline const std::string kAcross = kSquare + Line("Internal infill", "X15 Y15", "X16 Y15") +
                                   Line("Internal infill", "X30 Y15", "X31 Y15");

// Two lines of infill far from each other, and both with the first one the other way round.
inline const std::string kOne = Line("Internal infill", "X0 Y0", "X9 Y0");
inline const std::string kOther = Line("Internal infill", "X0 Y5", "X9 Y5");
inline const std::string kTwo = kOne + kOther;
inline const std::string kOneTurned =
    Line("Internal infill", "X9 Y0", "X0 Y0") + Line("Internal infill", "X0 Y5", "X9 Y5");

inline const std::string kNextLayer = ";LAYER_CHANGE\nG1 Z.4 F9000\n";

// A travel move that is lifted by 0.4 mm.
inline std::string Lifted(const std::string& to) {
  return absl::StrCat("G1 E-1 F2100\nG1 Z.6 F9000\nG1 ", to, " F9000\nG1 Z.2\nG1 E1 F2100\n");
}

inline std::string LiftedLine(const std::string& from, const std::string& to) {
  return absl::StrCat(Lifted(from), ";TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
}

inline const std::string kLifted =
    LiftedLine("X10 Y10", "X20 Y10") + LiftedLine("X10 Y20", "X20 Y20") +
    LiftedLine("X10 Y30", "X20 Y30") + LiftedLine("X10 Y40", "X20 Y40");

// A line that is wiped where it ends.
inline std::string Wiped(const std::string& from, const std::string& to, const std::string& back) {
  return absl::StrCat("G1 ", from, " F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 ", to,
                      " E.3\nG1 E-.5 F2100\n;WIPE_START\nG1 F7200\nG1 ", back,
                      " E-.5\n;WIPE_END\n");
}

}  // namespace traverse::gcode::testing

#endif  // TRAVERSE_TESTS_CLIENT_GCODE_VERIFY_SMALL_PRINTS_H_
