// No command within a path unless the original has it between the same two segments; in no section
// more than in the original that set a value and set it back without a move between, nor more marks
// of wipes that are out of place.

#include <map>
#include <utility>

#include "absl/container/flat_hash_set.h"
#include "client/gcode/verify/rules/rules.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Where the commands within the original's paths stand: the segment after them, and what they do.
absl::flat_hash_set<uint64_t> Places(const LayerPair& layer) {
  const TraceChunk& was = layer.was();
  const uint32_t first = was.paths[layer.first_path_was()].first_segment;
  const uint32_t end = was.paths[layer.end_path_was() - 1].end_segment;
  absl::flat_hash_set<uint64_t> places;
  for (const TraceCommand& command : was.commands) {
    if (command.segment >= first && command.segment < end) {
      places.insert(Mix(command.name, command.segment));
    }
  }
  return places;
}

// The visit that has segment `segment` of the other file.
const Visit* VisitOf(const LayerPair& layer, uint32_t segment) {
  const auto behind = std::ranges::upper_bound(layer.visits(), segment, {}, &Visit::first_segment);
  if (behind == layer.visits().begin()) return nullptr;
  const Visit& visit = *(behind - 1);
  return segment <= visit.last_segment ? &visit : nullptr;
}

}  // namespace

void CheckCommands(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  const TraceChunk& is = layer.is();
  const uint32_t first = is.paths[layer.first_path_is()].first_segment;
  const uint32_t end = is.paths[layer.end_path_is() - 1].end_segment;
  const absl::flat_hash_set<uint64_t> places = Places(layer);
  for (const TraceCommand& command : is.commands) {
    if (command.segment < first || command.segment >= end) continue;
    const Visit* visit = VisitOf(layer, command.segment);
    // Where two paths of the original meet, or a loop that begins elsewhere passes its old start.
    if (visit == nullptr || command.segment == visit->first_segment) continue;
    const TracePath& path = was.paths[visit->path];
    const uint32_t n = path.size();
    const uint32_t steps = command.segment - visit->first_segment;
    const uint32_t behind =
        visit->forward ? (visit->entry + steps) % n : (visit->entry + n - steps + 1) % n;
    if (behind == 0) continue;
    const uint32_t segment = path.first_segment + behind;
    if (places.contains(Mix(command.name, segment))) continue;
    findings.breaks.push_back(
        {VerifyRule::kCommands, was.segments[segment].line, command.line,
         "a command between two segments of a path that have none between them in the original"});
  }
}

void CheckLineFaults(const TraceChunk& was, const TraceChunk& is, std::vector<Finding>& breaks) {
  // How many, and the first one.
  std::map<std::pair<uint32_t, LineFaultKind>, std::pair<int64_t, uint32_t>> had;
  for (const LineFault& fault : was.line_faults) {
    auto& [count, line] = had[{fault.section, fault.kind}];
    if (count++ == 0) line = fault.line;
  }
  for (const LineFault& fault : is.line_faults) {
    auto& [count, line] = had[{fault.section, fault.kind}];
    if (count-- > 0) continue;
    const bool sets_back = fault.kind == LineFaultKind::kSetsBack;
    breaks.push_back({sets_back ? VerifyRule::kCommands : VerifyRule::kWipes, line, fault.line,
                      sets_back ? "a value is set and reset without a move in between"
                      : fault.kind == LineFaultKind::kUnmarked
                          ? "a wipe without the marks of wipes"
                          : "a mark of a wipe's begin or end is out of place"});
  }
}

}  // namespace traverse::gcode
