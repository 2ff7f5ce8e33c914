// The document of `verify --json`.

#ifndef TRAVERSE_CLIENT_REPORT_VERIFY_JSON_H_
#define TRAVERSE_CLIENT_REPORT_VERIFY_JSON_H_

#include <string>

#include "client/gcode/verify/report.h"

namespace traverse::report {

// What a verification found, rule by rule, a line each:
//   {"original": "...", "optimised": "...", "same": false, "policy": "safe",
//    "allow": ["wall_order"],
//    "rules": [{"rule": "lifts", "states": "...", "breaks": 3,
//               "layers": [4, 7],
//               "first": {"original_line": 97, "optimised_line": 118, "layer": 4,
//                         "message": "..."}}]}
// `first` is null without breaks; lines count from 1, 0 is none; layers count from 1.
std::string VerifyJson(const std::string& original, const std::string& optimised,
                       const VerifyReport& report);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_VERIFY_JSON_H_
