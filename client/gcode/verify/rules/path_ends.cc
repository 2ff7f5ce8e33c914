// A move that continues along a path's end without filament (the wipe of an outer wall, coasting)
// stays with that end; if the seam moves or the path is reversed, there is one of the same length
// at the new end.

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// A move along a path of two decimals that is turned is longer by less.
constexpr double kLengthSlackMm = 0.011;

struct Tail {
  double length_mm = 0;
  Point begun;  // where the first of its moves leads
  Point end;
  uint32_t line = 0;
  Micro feed = 0;
  bool known = true;
};

// Of the path before `link`, up to `most_mm` of it.
Tail TailBefore(const LayerPair& layer, const LayerSide& side, uint32_t link,
                double most_mm = HUGE_VAL) {
  Tail tail;
  for (const TraceMove& move : side.chunk.MovesOf(link).first(side.TailOf(link))) {
    if (tail.length_mm + move.length_mm() > most_mm) break;
    tail.length_mm += move.length_mm();
    tail.end = move.to;
    tail.feed = move.feed;
    tail.known &= layer.IsKnown(move);
    if (tail.line != 0) continue;
    tail.line = move.line;
    tail.begun = move.to;
  }
  return tail;
}

// Whether the tail begins beyond the end of the path, not back along it.
bool GoesBeyond(const TraceChunk& chunk, uint32_t path, const Tail& tail) {
  const TracePath& traced = chunk.paths[path];
  const Point end = chunk.EndOf(traced);
  const Point before = chunk.StartOf(traced, traced.end_segment - 1);
  return (tail.begun.x - end.x) * (end.x - before.x) + (tail.begun.y - end.y) * (end.y - before.y) >
         0;
}

// True if the open head leads to the next path no faster than this one was printed: then nobody can
// tell where travel begins. There is such travel between lines of a zigzag where slicers round the
// deposit to nothing, and where travel is as fast as printing.
bool LeadsOn(const TraceChunk& chunk, uint32_t path) {
  if (path + 1 >= chunk.paths.size()) return false;
  const absl::Span<const TraceMove> moves = chunk.MovesOf(path + 1);
  return std::ranges::all_of(moves, [&](const TraceMove& move) {
    return move.kind == MoveKind::kTravel && move.open && move.feed <= chunk.paths[path].feed;
  });
}

// The move with which the open nozzle, having left the end of path `path`, is back there, although
// nothing begins there; nothing if it does not come back, or no move up to it counts.
const TraceMove* PokeBehind(const LayerPair& layer, const LayerSide& side, uint32_t path) {
  if (side.chunk.links[path + 1].scripted) return nullptr;
  const absl::Span<const TraceMove> moves = side.chunk.MovesOf(path + 1);
  const Point end = side.chunk.EndOf(side.chunk.paths[path]);
  bool left = false;
  bool counts = false;
  for (const TraceMove& move : moves.first(moves.size() - (moves.empty() ? 0 : 1))) {
    if (move.kind != MoveKind::kTravel || !move.open || !move.in_print) return nullptr;
    counts |= layer.Counts(side, move);
    const double off = Distance(move.to, end);
    if (left && off <= kSamePointMm) return counts ? &move : nullptr;
    left |= off > kOnPathMm;
  }
  return nullptr;
}

// An open nozzle that goes back along what it printed, and returns, leaves something there.
// Travel that turns back (travel/travel_lengths.cc) is another matter: that counts behind the moves
// along a path's end, where those stand for no travel, and not for less than 0.5 mm at first, for
// the next path may begin there; and retracted travel that turns back excuses it, but no poke.
void CheckPoke(const LayerPair& layer, const Visit& visit, LayerFindings& findings) {
  bool& poked = findings.was.poked;
  poked = poked || PokeBehind(layer, layer.Side(true), visit.path) != nullptr;
  if (!layer.EndsPath(visit)) return;
  const TraceMove* is = PokeBehind(layer, layer.Side(false), visit.last_path);
  if (is == nullptr) return;
  const TracePath& path = layer.was().paths[visit.path];
  findings.is.pokes.push_back({VerifyRule::kPathEnds,
                               layer.was().segments[path.end_segment - 1].line,
                               {is->line, layer.index()},
                               "leaves the path and comes back to its end"});
}

}  // namespace

void CheckPathEnds(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  const TraceChunk& is = layer.is();
  for (const Visit& visit : layer.visits()) {
    if (layer.Ended()) return;
    const TracePath& path = was.paths[visit.path];
    if (visit.segments != path.size()) continue;
    CheckPoke(layer, visit, findings);
    if (LeadsOn(was, visit.path)) continue;
    const Tail had = TailBefore(layer, layer.Side(true), visit.path + 1);
    const double slack = std::max(kLengthSlackMm, 0.02 * had.length_mm);
    const bool leads_on = LeadsOn(is, visit.last_path);
    Tail has;
    if (layer.EndsPath(visit)) {
      has = TailBefore(layer, layer.Side(false), visit.last_path + 1,
                       leads_on ? had.length_mm + slack : HUGE_VAL);
    }
    const uint32_t end_line = is.segments[visit.last_segment].line;
    const auto report = [&](uint32_t original, uint32_t optimised, std::string what) {
      findings.breaks.push_back({VerifyRule::kPathEnds, original, optimised, std::move(what)});
    };
    const bool same_end = visit.forward && visit.entry == 0;
    if (had.length_mm < kLeastDepartureMm) {
      // Where the path ends elsewhere, it may cross the gap of a loop or lead back to a zigzag.
      const double gap = layer.Closed(visit.path)
                             ? Distance(was.EndOf(path), path.start) + kLeastDepartureMm
                             : LoopGapMm(was, visit.path);
      const bool longer = has.length_mm > (same_end ? kLeastDepartureMm : gap);
      if (longer && !has.known && has.feed == path.feed && !leads_on) {
        report(was.segments[path.end_segment - 1].line, has.line,
               absl::StrFormat("continues along the path for %.2f mm, but not in the original",
                               has.length_mm));
      }
      continue;
    }
    if (std::abs(has.length_mm - had.length_mm) > slack) {
      report(
          had.line, has.line != 0 ? has.line : end_line,
          absl::StrFormat("continues along the path for %.2f mm, but for %.2f mm in the original",
                          has.length_mm, had.length_mm));
    } else if (has.feed != had.feed) {
      report(had.line, has.line,
             absl::StrFormat("continues along the path at F%g, but at F%g in the original",
                             static_cast<double>(has.feed) * kMicro,
                             static_cast<double>(had.feed) * kMicro));
    } else if (!layer.Closed(visit.path) &&
               GoesBeyond(was, visit.path, had) != GoesBeyond(is, visit.last_path, has)) {
      report(had.line, has.line, "continues from the path to the other side, unlike the original");
    } else if (same_end && Distance(has.end, had.end) > kSamePointMm) {
      report(had.line, has.line, "continues from the path to a different point from the original");
    }
  }
}

// What the original does elsewhere too is no break.
void ComparePokes(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  if (!was.poked) breaks.insert(breaks.end(), is.pokes.begin(), is.pokes.end());
}

}  // namespace traverse::gcode
