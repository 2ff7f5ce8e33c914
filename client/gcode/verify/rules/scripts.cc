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

// Adds a break where `was` and `is` first are not `alike`, or one of them goes on alone.
void Compare(absl::Span<const TraceMove> was, absl::Span<const TraceMove> is,
             bool (*alike)(const TraceMove&, const TraceMove&), const char* what,
             std::vector<Finding>& breaks) {
  const auto [one, other] = std::ranges::mismatch(was, is, alike);
  if (one == was.end() && other == is.end()) return;
  breaks.push_back({VerifyRule::kScripts, one == was.end() ? 0 : one->line,
                    other == is.end() ? 0 : other->line, what});
}

}  // namespace

void CheckLeaving(const TraceChunk& was, const TraceChunk& is, std::vector<Finding>& breaks) {
  Compare(Leaving(was), Leaving(is), DoTheSame, "leaves the print differently from the original",
          breaks);
}

void CheckFixedMoves(const LayerPair& layer, LayerFindings& findings) {
  for (size_t i = 0; i < layer.section_count() && !layer.Ended(); ++i) {
    Compare(FixedMoves(layer.was(), layer.SectionWas(i).first_path),
            FixedMoves(layer.is(), layer.SectionIs(i).first_path), AreEqual,
            "the moves before an unknown line differ from the original's", findings.breaks);
  }
}

}  // namespace traverse::gcode
