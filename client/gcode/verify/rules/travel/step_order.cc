// In which order travel takes its steps: it retracts, rises, leads to the next path, goes down and
// primes. New travel takes them in an order that travel of the original has.

#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// One letter a step; 0: it does not count.
char StepOf(const TraceMove& move) {
  switch (move.kind) {
    case MoveKind::kWipe:
      return move.filament < 0 ? 'R' : 0;
    case MoveKind::kUp:
      // A feed rate alone moves nothing.
      return move.z_to_mm > move.z_from_mm ? 'U' : 0;
    case MoveKind::kDown:
      return 'D';
    case MoveKind::kRetraction:
      return 'R';
    case MoveKind::kPriming:
      return 'P';
    case MoveKind::kDwell:
      return 'w';
    default:
      break;
  }
  if (move.z_to_mm > move.z_from_mm + kHeightSlackMm) return 'u';
  if (move.z_to_mm < move.z_from_mm - kHeightSlackMm) return 'd';
  if (!move.open) return 't';
  return move.length_mm() < kLeastMoveMm ? 0 : 'o';
}

// The steps of `link`, several alike as one. The short moves by which it leaves a path, and others
// before the head rises or filament is pulled, are not among them.
std::string StepsOf(const TraceChunk& chunk, uint32_t link) {
  const TraceLink& traced = chunk.links[link];
  std::string steps;
  for (uint32_t m = traced.first_move; m < traced.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (!move.in_print) continue;
    const char step = StepOf(move);
    if (step == 0 || (step == 'o' && steps.empty())) continue;
    if (steps.empty() || steps.back() != step) steps.push_back(step);
  }
  // How far from its path travel may prime is said elsewhere (retractions.cc).
  if (steps.ends_with("Po")) steps.pop_back();
  return steps;
}

// Of the steps to another layer, which depend on how the two paths lie to each other, only what
// comes too early: the head rises before it retracts, or primes before it is there.
std::string EarlyStepsOf(const std::string& steps) {
  const size_t first = steps.find_first_of("Uu");
  const size_t pull = steps.find('R');
  const size_t prime = steps.rfind('P');
  const bool lifts = first < pull && pull != std::string::npos;
  const bool primes =
      prime != std::string::npos && steps.find_first_of("UuDdt", prime) != std::string::npos;
  if (!lifts && !primes) return "";
  return absl::StrCat(lifts ? "UR" : "", primes ? steps.substr(prime) : "", "l");
}

// Whether the head waits behind what pulls filament back, or pushes it, at a standstill.
std::vector<std::string> DwellsOf(const TraceChunk& chunk, uint32_t link) {
  const TraceLink& traced = chunk.links[link];
  std::vector<std::string> dwells;
  for (uint32_t m = traced.first_move; m < traced.end_move; ++m) {
    const MoveKind kind = chunk.moves[m].kind;
    if (kind != MoveKind::kRetraction && kind != MoveKind::kPriming) continue;
    const bool waits = m + 1 < traced.end_move && chunk.moves[m + 1].kind == MoveKind::kDwell;
    dwells.push_back(absl::StrCat(kind == MoveKind::kRetraction ? "R" : "P", waits ? "w" : "-"));
  }
  return dwells;
}

const char* NameOfStep(char step) {
  switch (step) {
    case 'U':
      return "up";
    case 'D':
      return "down";
    case 'R':
      return "retraction";
    case 'P':
      return "priming";
    case 'w':
      return "dwell";
    case '-':
      return "no dwell";
    case 'u':
      return "travel that rises";
    case 'd':
      return "travel that sinks";
    case 'o':
      return "travel without a retraction";
    case 't':
      return "travel";
    case 'l':
      return "next layer";
    default:
      return "next path";
  }
}

std::string InWords(const std::string& steps) {
  std::string words;
  for (const char step : steps) {
    absl::StrAppend(&words, words.empty() ? "" : ", ", NameOfStep(step));
  }
  return words;
}

bool AllKnown(const LayerPair& layer, uint32_t link) {
  const TraceChunk& is = layer.is();
  for (uint32_t m = is.links[link].first_move; m < is.links[link].end_move; ++m) {
    if (!layer.IsKnown(is.moves[m])) return false;
  }
  return true;
}

}  // namespace

void ObserveStepOrder(const LayerPair& layer, LayerFindings& findings) {
  const auto add = [&](const TraceChunk& chunk, uint32_t link, const std::string& steps,
                       Observations& seen) {
    if (steps.empty()) return;
    NoteSeen(seen.step_orders, steps, chunk.moves[chunk.links[link].first_move].line,
             layer.index());
  };
  // The first link of all comes from the start script.
  const uint32_t scripts = layer.index() == 0 ? 1 : 0;
  for (uint32_t link = layer.first_path_was() + scripts; link < layer.end_path_was(); ++link) {
    if (layer.Ended()) return;
    const std::string steps = StepsOf(layer.was(), link);
    add(layer.was(), link, steps, findings.was);
    for (const std::string& dwell : DwellsOf(layer.was(), link)) {
      add(layer.was(), link, dwell, findings.was);
    }
    if (layer.was().links[link].new_layer) {
      add(layer.was(), link, EarlyStepsOf(steps), findings.was);
    }
  }
  for (uint32_t link = layer.first_path_is() + scripts; link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    if (layer.is().links[link].scripted || layer.IsHidden(link) || AllKnown(layer, link)) continue;
    const std::string steps = StepsOf(layer.is(), link);
    const bool to_layer = layer.is().links[link].new_layer;
    for (const std::string& dwell : DwellsOf(layer.is(), link)) {
      add(layer.is(), link, dwell, findings.is);
    }
    add(layer.is(), link, to_layer ? EarlyStepsOf(steps) : steps, findings.is);
  }
}

void CompareStepOrder(const Observations& was, const Observations& is,
                      std::vector<Finding>& breaks) {
  for (const auto& [steps, seen] : is.step_orders) {
    if (was.step_orders.contains(steps)) continue;
    AddAt(seen,
          {VerifyRule::kStepOrder, 0, 0, -1,
           absl::StrCat("steps in an order that no travel of the original has: ", InWords(steps))},
          breaks);
  }
}

}  // namespace traverse::gcode
