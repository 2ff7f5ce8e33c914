// No command within a path unless the original has it between the same two segments; none that sets
// a value and sets it back without a move between.

#include <map>

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
  const auto behind =
      std::upper_bound(layer.visits().begin(), layer.visits().end(), segment,
                       [](uint32_t s, const Visit& visit) { return s < visit.first_segment; });
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
  absl::flat_hash_set<uint64_t> places;
  bool learnt = false;
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
    if (!learnt) places = Places(layer);
    learnt = true;
    const uint32_t segment = path.first_segment + behind;
    if (places.contains(Mix(command.name, segment))) continue;
    findings.breaks.push_back(
        {VerifyRule::kCommands, was.segments[segment].line, command.line, layer.index(),
         "a command between two segments of a path that have none between them in the original"});
  }
}

void CheckSetBacks(const TraceChunk& was, const TraceChunk& is, std::vector<Finding>& breaks) {
  std::map<uint32_t, std::pair<int64_t, uint32_t>> had;  // by section: how many, the first line
  for (const SetBack& event : was.set_backs) {
    auto& [count, line] = had[event.section];
    if (count++ == 0) line = event.line;
  }
  for (const SetBack& event : is.set_backs) {
    auto& [count, line] = had[event.section];
    if (count-- > 0) continue;
    breaks.push_back({VerifyRule::kCommands, line, event.line, -1,
                      "a value is set and reset without a move in between"});
  }
}

}  // namespace traverse::gcode
