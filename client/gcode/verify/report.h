// The findings of a verification.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_REPORT_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_REPORT_H_

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "client/gcode/verify/permissions.h"

namespace traverse {

// The rules. kSamePrint is the basis of the others: a different print is not examined any
// further.
enum class VerifyRule : uint8_t {
  kSamePrint,    // the same deposits under the same conditions, and the same lines beside them
  kWholePaths,   // what adjoins in a path still adjoins; a loop may be cut once
  kOrder,        // paths side by side keep the order that the slicer has reasons for
  kDirection,    // of open walls, overhanging and outer loops
  kSeam,         // where outer walls begin
  kOpenTravels,  // across outer walls
  kLifts,        // no travel is lower than such travel is
  kRetractions,  // primes give back what was retracted, all in all and at labels
  kStandstill,   // filament pushed while the head stands still
  kSpeeds,       // the acceleration of everything but deposits
  kWipes,        // along the path that they follow, and after those that had them
  kCommands,     // none within a path, none without effect
  kProgress,     // M73 and what else tells how far the print is
  kScripts,      // the moves beside them
  kPathEnds,     // moves that continue along a path
  kBounds,       // new travel is straight
  kMadeOfParts,  // new travel leaves, goes and arrives as travel of the original does
  kKeptTravels,  // between two paths that follow each other as in the original
  kObstacles,    // nothing that stands is in the way of the head
  kRest,         // of islands before they are printed on
  kCount,
};

constexpr uint32_t RuleBit(VerifyRule rule) { return 1u << static_cast<uint32_t>(rule); }

// "whole_paths".
std::string_view VerifyRuleName(VerifyRule rule);

// "what adjoins in a path stays adjoined".
std::string_view VerifyRuleText(VerifyRule rule);

struct VerifyBreak {
  VerifyRule rule = VerifyRule::kSamePrint;
  size_t original_line = 0;   // 0: none
  size_t optimised_line = 0;  // 0: none
  int64_t layer = -1;         // from 0, as the verifier counts them; -1: in no layer
  std::string message;        // with both files and lines
  size_t before_line = 0;     // of the optimised file: what has to come before that; 0: nothing
};

struct VerifyReport {
  VerifyPermissions permissions;
  std::array<int64_t, static_cast<size_t>(VerifyRule::kCount)> counts{};

  // By rule, and then by line; the first kMostBreaks of each rule.
  std::vector<VerifyBreak> breaks;

  static constexpr size_t kMostBreaks = 10'000;

  bool ok() const { return breaks.empty(); }
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_REPORT_H_
