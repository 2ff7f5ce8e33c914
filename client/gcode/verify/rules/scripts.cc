// Moves before a line that is not known are as they were, and so is how the head leaves the print.

#include <algorithm>

#include "absl/types/span.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

bool ChangesHeight(const TraceMove& move) { return move.z_to_mm != move.z_from_mm; }

// What follows the last path, from where the head first leaves its height: what stands before it
// belongs to the path, and may be that of another one.
absl::Span<const TraceMove> Leaving(const TraceChunk& chunk) {
  const absl::Span<const TraceMove> moves = chunk.MovesOfLast();
  const auto first = std::ranges::find_if(moves, ChangesHeight);
  return moves.subspan(static_cast<size_t>(first - moves.begin()));
}

// The start of a travel move depends on which path is the last one.
bool DoTheSame(const TraceMove& was, const TraceMove& is) {
  if (was.kind != is.kind || was.filament != is.filament || was.z_to_mm != is.z_to_mm) return false;
  if (!was.sideways()) return true;
  const bool same_begin = was.from.x == is.from.x && was.from.y == is.from.y;
  return !same_begin || was.identity == is.identity;
}

// The moves between a path and a line that is not known, before which the path stays as it is.
absl::Span<const TraceMove> FixedMoves(const TraceChunk& chunk, uint32_t path) {
  return chunk.MovesOf(path).first(chunk.links[path].fixed);
}

bool AreEqual(const TraceMove& one, const TraceMove& other) {
  return one.identity == other.identity;
}

}  // namespace

void CheckLeaving(const TraceChunk& was, const TraceChunk& is, std::vector<Finding>& breaks) {
  const absl::Span<const TraceMove> moves = Leaving(was);
  const absl::Span<const TraceMove> others = Leaving(is);
  const auto [a, b] = std::ranges::mismatch(moves, others, DoTheSame);
  if (a == moves.end() && b == others.end()) return;
  breaks.push_back({VerifyRule::kScripts, a == moves.end() ? 0 : a->line,
                    b == others.end() ? 0 : b->line,
                    "leaves the print differently from the original"});
}

void CheckFixedMoves(const LayerPair& layer, LayerFindings& findings) {
  for (size_t i = 0; i < layer.section_count(); ++i) {
    if (layer.Ended()) return;
    const absl::Span<const TraceMove> moves =
        FixedMoves(layer.was(), layer.SectionWas(i).first_path);
    const absl::Span<const TraceMove> others =
        FixedMoves(layer.is(), layer.SectionIs(i).first_path);
    const auto [a, b] = std::ranges::mismatch(moves, others, AreEqual);
    if (a == moves.end() && b == others.end()) continue;
    findings.breaks.push_back({VerifyRule::kScripts, a == moves.end() ? 0 : a->line,
                               b == others.end() ? 0 : b->line,
                               "the moves before an unknown line differ from the original's"});
  }
}

}  // namespace traverse::gcode
