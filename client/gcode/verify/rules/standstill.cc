// Filament pushed at a standstill, beyond what had been retracted or short of it, is the same
// multiset of tool, layer and amount; if nothing had been retracted, in the same section at the
// same X and Y.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// How many layers of `chunk` end before that section; what has no paths belongs to the layer
// behind.
uint32_t LayerOf(const TraceChunk& chunk, uint32_t section) {
  const auto end_of = [&chunk](const TraceLayer& layer) {
    return chunk.sections[layer.end_section - 1].index;
  };
  const auto at = std::ranges::lower_bound(chunk.layers, section, {}, end_of);
  return static_cast<uint32_t>(at - chunk.layers.begin());
}

// Tool, amount and, if nothing had been retracted, the section and the position; else the layer.
using Key = std::tuple<uint64_t, uint32_t, Micro, bool, int64_t, int64_t>;

Key KeyOf(const TraceChunk& chunk, const Standstill& event) {
  constexpr Micro kSlack = VerifyMachine::kSlack;
  const auto um = [](double mm) { return static_cast<int64_t>(mm * 1000 + (mm < 0 ? -0.5 : 0.5)); };
  const Micro half = event.amount < 0 ? -kSlack / 2 : kSlack / 2;
  return {event.tool,
          event.fresh ? event.section : LayerOf(chunk, event.section),
          (event.amount + half) / kSlack,
          event.fresh,
          event.fresh ? um(event.at.x) : 0,
          event.fresh ? um(event.at.y) : 0};
}

// `amount` in 1e-6 mm.
std::string Pushes(Micro amount) {
  return absl::StrFormat("pushes %.4f mm %s than was retracted",
                         std::abs(static_cast<double>(amount)) * kMicro,
                         amount < 0 ? "less" : "more");
}

}  // namespace

void CheckStandstill(const TraceChunk& was, const TraceChunk& is, std::vector<Finding>& breaks) {
  std::map<Key, std::vector<uint32_t>> lines;
  for (const Standstill& event : was.standstills) lines[KeyOf(was, event)].push_back(event.line);
  for (const Standstill& event : is.standstills) {
    const auto known = lines.find(KeyOf(is, event));
    if (known != lines.end() && !known->second.empty()) {
      known->second.pop_back();
      continue;
    }
    breaks.push_back(
        {VerifyRule::kStandstill, 0, event.line,
         absl::StrFormat("%s, which the original does not %s", Pushes(event.amount),
                         event.fresh ? "here" : "so often in this part of the print")});
  }
  for (const auto& [key, left] : lines) {
    for (const uint32_t line : left) {
      breaks.push_back({VerifyRule::kStandstill, line, 0,
                        absl::StrFormat("the original %s, which is missing",
                                        Pushes(std::get<2>(key) * VerifyMachine::kSlack))});
    }
  }
}

}  // namespace traverse::gcode
