// A move that continues along a path's end without filament (the wipe of an outer wall, coasting)
// stays with that end; if the seam moves or the path is reversed, there is one of the same length
// at the new end.

#include <cmath>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/way_ends.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr double kShortestMm = 0.015;
constexpr double kSlackMm = 0.02;
constexpr double kPokeMm = 0.05;

// A move along a path of two decimals that is turned is longer by less.
constexpr double kLengthSlackMm = 0.011;

struct Tail {
  double length_mm = 0;
  Point end;
  uint32_t line = 0;
  Micro feed = 0;
  bool known = true;
};

Tail TailOf(const LayerPair& layer, const TraceChunk& chunk, uint32_t path,
            absl::Span<const Piece> pieces) {
  Tail tail;
  const uint32_t first = chunk.links[path + 1].first_move;
  const uint32_t n = LayerPair::TailMoves(chunk, path, pieces);
  for (uint32_t m = first; m < first + n; ++m) {
    const TraceMove& move = chunk.moves[m];
    tail.length_mm += move.length_mm();
    tail.end = move.to;
    tail.feed = move.feed;
    tail.known &= layer.IsKnown(move);
    if (tail.line == 0) tail.line = move.line;
  }
  return tail;
}

// Whether the tail goes on beyond the end of the path, not back along it.
bool GoesBeyond(const TraceChunk& chunk, uint32_t path, const Tail& tail) {
  const TracePath& traced = chunk.paths[path];
  const Point end = chunk.EndOf(traced);
  const Point before = chunk.StartOf(traced, traced.end_segment - 1);
  return (tail.end.x - end.x) * (end.x - before.x) + (tail.end.y - end.y) * (end.y - before.y) > 0;
}

// True if everything after the path leads to the next one: there is such travel between lines of a
// zigzag where slicers round the deposit to nothing.
bool LeadsOn(const TraceChunk& chunk, uint32_t path, absl::Span<const Piece> pieces) {
  if (path + 1 >= chunk.paths.size()) return false;
  const TraceLink& link = chunk.links[path + 1];
  return link.first_move + LayerPair::TailMoves(chunk, path, pieces) == link.end_move;
}

// Whether travel from the path leads to the same point in both files, maybe of the next layer.
bool LeadAlike(const LayerPair& layer, const Visit& visit) {
  const uint32_t link_was = visit.path + 1;
  const uint32_t link_is = visit.last_path + 1;
  const bool ends = link_was == layer.end_path_was();
  return ends == (link_is == layer.end_path_is()) && link_was < layer.was().paths.size() &&
         link_is < layer.is().paths.size() &&
         EndsOf(layer.was(), link_was) == EndsOf(layer.is(), link_is);
}

// Whether it begins at the same point.
bool EndAlike(const LayerPair& layer, const Visit& visit) {
  const Point was = layer.was().EndOf(layer.was().paths[visit.path]);
  const Point is = layer.is().EndOf(layer.is().paths[visit.last_path]);
  return DistanceOf(was, is) < kShortestMm;
}

// The first sideways move of the link; nothing if there is none.
const TraceMove* FirstMove(const TraceChunk& chunk, uint32_t link) {
  for (uint32_t m = chunk.links[link].first_move; m < chunk.links[link].end_move; ++m) {
    if (chunk.moves[m].sideways()) return &chunk.moves[m];
  }
  return nullptr;
}

// Whether travel from the path begins along it, however fast.
bool BeginsAlong(const TraceChunk& chunk, uint32_t path, absl::Span<const Piece> pieces) {
  const uint32_t first = chunk.links[path + 1].first_move;
  const uint32_t end = first + LayerPair::TailMoves(chunk, path, pieces, true);
  for (uint32_t m = first; m < end; ++m) {
    if (chunk.moves[m].sideways()) return true;
  }
  return false;
}

// Travel leaves the path by a short move that it does not have in the original: another one than
// there, or one that does not lead along the path where that ends elsewhere.
bool LeavesUnlike(const LayerPair& layer, const Visit& visit, bool same_end) {
  const TraceMove* departs = DepartureOf(layer.is(), visit.last_path + 1);
  if (departs == nullptr || layer.IsKnown(*departs)) return false;
  if (!same_end) {
    return !BeginsAlong(layer.is(), visit.last_path, layer.PiecesOf(visit.path));
  }
  const TraceMove* first = FirstMove(layer.was(), visit.path + 1);
  return first == nullptr || DistanceOf(departs->to, first->to) > kSlackMm;
}

// The move with which the open nozzle, having left the end of path `path`, is back there, although
// nothing begins there; nothing if it does not come back. What is `known` of all moves up to it
// makes it nothing too.
template <typename Known>
const TraceMove* PokeBehind(const TraceChunk& chunk, uint32_t path, const Known& known) {
  const TraceLink& link = chunk.links[path + 1];
  if (link.scripted) return nullptr;
  const Point end = chunk.EndOf(chunk.paths[path]);
  bool left = false;
  bool all_known = true;
  for (uint32_t m = link.first_move; m + 1 < link.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (move.kind != MoveKind::kTravel || !move.open || !move.in_print) return nullptr;
    all_known &= known(move);
    const double off = DistanceOf(move.to, end);
    if (left && off <= kSlackMm) return all_known ? nullptr : &move;
    left |= off > kPokeMm;
  }
  return nullptr;
}

// An open nozzle that goes back along what it printed, and returns, leaves something there.
void CheckPoke(const LayerPair& layer, const Visit& visit, LayerFindings& findings) {
  if (findings.was.pokes.empty()) {
    const TraceMove* was =
        PokeBehind(layer.was(), visit.path, [](const TraceMove&) { return false; });
    if (was != nullptr) {
      findings.was.pokes.push_back({VerifyRule::kPathEnds, was->line, 0, layer.index(), ""});
    }
  }
  if (!layer.EndsPath(visit)) return;
  const TraceMove* is = PokeBehind(layer.is(), visit.last_path,
                                   [&layer](const TraceMove& m) { return layer.IsKnown(m); });
  if (is == nullptr) return;
  const TracePath& path = layer.was().paths[visit.path];
  findings.is.pokes.push_back({VerifyRule::kPathEnds,
                               layer.was().segments[path.end_segment - 1].line, is->line,
                               layer.index(), "leaves the path and comes back to its end"});
}

// From the same point travel leaves a path as it did, if it retracts.
void CheckDeparture(const LayerPair& layer, const Visit& visit, LayerFindings& findings) {
  const TraceChunk& is = layer.is();
  const uint32_t link_is = visit.last_path + 1;
  const TraceMove* was = DepartureOf(layer.was(), visit.path + 1);
  if (was != nullptr) findings.was.departs_inside |= !layer.Outer(visit.path);
  if (!layer.EndsPath(visit)) return;
  const bool alike = EndAlike(layer, visit);
  const uint32_t end_was = layer.was().paths[visit.path].end_segment - 1;
  const uint32_t line_was = was != nullptr ? was->line : layer.was().segments[end_was].line;
  if (LeavesUnlike(layer, visit, alike && visit.forward && visit.entry == 0)) {
    findings.breaks.push_back({VerifyRule::kPathEnds, line_was, DepartureOf(is, link_is)->line,
                               layer.index(),
                               "leaves the path by a short move that the original does not have"});
    return;
  }
  const TraceLink& link = is.links[link_is];
  if (was == nullptr || link.first_move == link.end_move) return;
  if (!Retracts(is.moves[link.first_move])) return;
  const Finding lost{VerifyRule::kPathEnds, line_was, is.moves[link.first_move].line, layer.index(),
                     "retracts at the end of the path; the original leaves it before"};
  if (alike && LeadAlike(layer, visit)) {
    findings.breaks.push_back(lost);
  } else if (alike && layer.Outer(visit.path)) {
    findings.is.lost_departures.push_back(lost);
  }
}

}  // namespace

void CheckPathEnds(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  const TraceChunk& is = layer.is();
  for (const Visit& visit : layer.visits()) {
    const TracePath& path = was.paths[visit.path];
    if (visit.segments != path.size()) continue;
    CheckDeparture(layer, visit, findings);
    CheckPoke(layer, visit, findings);
    const absl::Span<const Piece> pieces = layer.PiecesOf(visit.path);
    const Tail had = TailOf(layer, was, visit.path, pieces);
    const Tail has = TailOf(layer, is, visit.last_path, pieces);
    const uint32_t end_line = is.segments[visit.last_segment].line;
    const auto report = [&](uint32_t original, uint32_t optimised, std::string what) {
      findings.breaks.push_back(
          {VerifyRule::kPathEnds, original, optimised, layer.index(), std::move(what)});
    };
    const bool same_end = visit.forward && visit.entry == 0;
    if (had.length_mm < kShortestMm) {
      // Where the path ends elsewhere, it may cross the gap of a loop or lead back to a zigzag.
      const double gap = layer.Closed(visit.path)
                             ? DistanceOf(was.EndOf(path), path.start) + kShortestMm
                             : kLoopGapMm;
      const bool longer = has.length_mm > (same_end ? kShortestMm : gap);
      const bool new_tail =
          longer && !has.known && has.feed == path.feed && !LeadsOn(is, visit.last_path, pieces);
      if (new_tail) {
        report(was.segments[path.end_segment - 1].line, has.line,
               absl::StrFormat("continues along the path for %.2f mm, but not in the original",
                               has.length_mm));
      }
      continue;
    }
    if (has.length_mm < kShortestMm && !layer.Closed(visit.path) &&
        LeadsOn(was, visit.path, pieces)) {
      continue;
    }
    const double slack = std::max(kLengthSlackMm, 0.02 * had.length_mm);
    if (std::abs(has.length_mm - had.length_mm) > slack) {
      report(
          had.line, has.line != 0 ? has.line : end_line,
          absl::StrFormat("continues along the path for %.2f mm, but for %.2f mm in the original",
                          has.length_mm, had.length_mm));
    } else if (has.feed != had.feed) {
      report(had.line, has.line,
             absl::StrFormat("continues along the path at F%g, but at F%g in the original",
                             static_cast<double>(has.feed) * 1e-6,
                             static_cast<double>(had.feed) * 1e-6));
    } else if (!layer.Closed(visit.path) && !LeadsOn(was, visit.path, pieces) &&
               GoesBeyond(was, visit.path, had) != GoesBeyond(is, visit.last_path, has)) {
      report(had.line, has.line, "continues from the path to the other side, unlike the original");
    } else if (same_end && DistanceOf(has.end, had.end) > kSlackMm) {
      report(had.line, has.line, "continues from the path to a different point from the original");
    }
  }
}

// Where travel begins with such moves behind other paths than outer walls too, they are on the way
// to somewhere.
void ComparePathEnds(const Observations& was, const Observations& is, const RuleContext& context,
                     std::vector<Finding>& breaks) {
  if (was.pokes.empty()) breaks.insert(breaks.end(), is.pokes.begin(), is.pokes.end());
  if (context.settings.leads_around_walls || was.departs_inside) return;
  breaks.insert(breaks.end(), is.lost_departures.begin(), is.lost_departures.end());
}

}  // namespace traverse::gcode
