// No move between paths comes from the start or the end script, nor from those at tool changes and
// changes of layers.

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {

void CompareScripts(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  for (const auto& [signature, seen] : is.signatures) {
    if (was.signatures.contains(signature) || !was.script_signatures.contains(signature)) continue;
    breaks.push_back({VerifyRule::kScripts, 0, seen.line, seen.layer,
                      "moves filament as nothing but a script of the original does"});
  }
}

}  // namespace traverse::gcode
