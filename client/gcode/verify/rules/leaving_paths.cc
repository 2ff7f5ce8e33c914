// Travel that leaves a wall before it retracts, so that nothing of that shows, leaves it that way
// in any order: to the same side, and along a loop by the same length, wherever that ends. From a
// loop that begins elsewhere the move inwards leads as the start does (turned_departures.h), or is
// left out.

#include <algorithm>
#include <optional>

#include "absl/strings/str_format.h"
#include "absl/types/span.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/match/turned_departures.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

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
  return Distance(was, is) < kSamePointMm;
}

// Travel leaves the path by a short move that it does not have in the original: another one than
// there, or, where the path ends elsewhere, one that leads neither along it nor to where that
// move would be there.
bool LeavesUnlike(const LayerPair& layer, const Visit& visit, bool same_end,
                  const absl::flat_hash_set<uint32_t>& turned) {
  const TraceMove* departs = DepartureOf(layer.is(), visit.last_path + 1);
  if (departs == nullptr || layer.IsKnown(*departs)) return false;
  if (!same_end) {
    if (turned.contains(visit.last_path + 1)) return false;
    const auto along = layer.Side(false).MovesAlong(visit.last_path + 1);
    return std::ranges::none_of(along, &TraceMove::sideways);
  }
  const absl::Span<const TraceMove> had = layer.was().MovesOf(visit.path + 1);
  const auto first = std::ranges::find_if(had, &TraceMove::sideways);
  return first == had.end() || Distance(departs->to, first->to) > kSamePointMm;
}

bool RetractsAtOnce(const TraceChunk& chunk, uint32_t link) {
  const absl::Span<const TraceMove> moves = chunk.MovesOf(link);
  return !moves.empty() && Retracts(moves.front());
}

// How far off the end of the path travel retracts that an open nozzle begins; nothing if it does
// not.
std::optional<double> RetractsAwayBy(const TraceChunk& chunk, uint32_t link) {
  double mm = 0;
  const Point end = chunk.EndOf(chunk.paths[link - 1]);
  for (const TraceMove& move : chunk.MovesOf(link)) {
    if (Retracts(move)) return mm;
    if (!move.sideways()) continue;
    if (move.kind != MoveKind::kTravel || !move.in_print) return std::nullopt;
    mm = Distance(end, move.to);
  }
  return std::nullopt;
}

// Travel from the same point of the path retracts in both files, but farther behind it than in the
// original: by so much.
double RetractsLaterBy(const LayerPair& layer, const Visit& visit) {
  const auto was = RetractsAwayBy(layer.was(), visit.path + 1);
  const auto is = RetractsAwayBy(layer.is(), visit.last_path + 1);
  if (!was || !is || layer.is().links[visit.last_path + 1].scripted) return 0;
  return *is > *was + kLateMm ? *is - *was : 0;
}

void NoteDeparture(const LayerPair& layer, uint32_t path, Observations& seen) {
  const bool departs = DepartureOf(layer.was(), path + 1) != nullptr;
  if (!layer.Outer(path)) {
    seen.departs_inside |= departs;
  } else if (departs) {
    ++seen.departures_outside;
  } else if (RetractsAtOnce(layer.was(), path + 1)) {
    ++seen.retractions_outside;
  }
}

// From the same point travel leaves a path as it did, if it retracts.
void CheckDeparture(const LayerPair& layer, const Visit& visit,
                    const absl::flat_hash_set<uint32_t>& turned, LayerFindings& findings) {
  const TraceChunk& is = layer.is();
  const uint32_t link_is = visit.last_path + 1;
  const TraceMove* was = DepartureOf(layer.was(), visit.path + 1);
  NoteDeparture(layer, visit.path, findings.was);
  if (!layer.EndsPath(visit)) return;
  const bool alike = EndAlike(layer, visit);
  const uint32_t end_was = layer.was().paths[visit.path].end_segment - 1;
  const uint32_t line_was = was != nullptr ? was->line : layer.was().segments[end_was].line;
  const bool as_sliced = alike && visit.forward && visit.entry == 0;
  if (LeavesUnlike(layer, visit, as_sliced, turned)) {
    findings.breaks.push_back({VerifyRule::kPathEnds, line_was, DepartureOf(is, link_is)->line,
                               "leaves the path by a short move that the original does not have"});
    return;
  }
  if (const double later_mm = as_sliced ? RetractsLaterBy(layer, visit) : 0; later_mm > 0) {
    findings.breaks.push_back(
        {VerifyRule::kPathEnds, line_was, is.MovesOf(link_is).front().line,
         absl::StrFormat("retracts %.2f mm farther behind the path than the original", later_mm)});
    return;
  }
  if (was == nullptr || !RetractsAtOnce(is, link_is)) return;
  const Place at{is.MovesOf(link_is).front().line, layer.index()};
  const Finding lost{VerifyRule::kPathEnds, line_was, at,
                     "retracts at the end of the path; the original leaves it before"};
  if (alike && LeadAlike(layer, visit)) {
    findings.breaks.push_back(lost);
  } else if (alike && layer.Outer(visit.path)) {
    findings.is.lost_departures.push_back(lost);
  }
}

// A point of a loop, so far behind its begin.
Point PointAlong(absl::Span<const Piece> pieces, double mm) {
  for (const Piece& piece : pieces) {
    const double length = Distance(piece.a, piece.b);
    if (length >= mm && length > 0) return Between(piece.a, piece.b, mm / length);
    mm -= length;
  }
  return pieces.back().b;
}

// How far the open nozzle goes on along the path before `link`, however fast.
double GoesOnMm(const LayerSide& side, uint32_t link) {
  double length = 0;
  for (const TraceMove& move : side.MovesAlong(link)) {
    if (move.kind != MoveKind::kTravel || !move.open || !move.in_print) break;
    length += move.length_mm();
  }
  return length;
}

// The move with which travel goes on along the begin of the loop that it leaves, however fast, and
// not to the next path. Nothing if it does not.
const TraceMove* GoesOnBy(const LayerPair& layer, uint32_t path) {
  constexpr double kLeastMm = 0.1;
  const TraceChunk& was = layer.was();
  const absl::Span<const TraceMove> moves = was.MovesOf(path + 1);
  const Point end = was.EndOf(was.paths[path]);
  if (was.paths[path].size() < 3 || Distance(was.paths[path].start, end) > kOnPathMm)
    return nullptr;
  if (moves.size() < 2) return nullptr;
  const TraceMove& first = moves.front();
  const double length = first.length_mm();
  const bool open = first.kind == MoveKind::kTravel && first.open && first.in_print;
  if (!open || length <= kLeastMm || length > kLooseMm) return nullptr;
  if (Distance(PointAlong(layer.PiecesOf(path), length), first.to) > kOnPathMm) return nullptr;
  // A straight move off a small loop ends there too, but leads across it.
  if (GoesOnMm(layer.Side(true), path + 1) <= length - kOnPathMm) return nullptr;
  return std::ranges::any_of(moves.subspan(1), &TraceMove::sideways) ? &first : nullptr;
}

// Travel that goes on along the loop that it leaves does so wherever that ends.
void CheckGoingOn(const LayerPair& layer, const Visit& visit, LayerFindings& findings) {
  if (!layer.EndsPath(visit)) return;
  const TraceMove* had = GoesOnBy(layer, visit.path);
  if (had == nullptr) return;
  const TraceChunk& is = layer.is();
  const double mm = GoesOnMm(layer.Side(false), visit.last_path + 1);
  if (mm > had->length_mm() - kOnPathMm) return;
  const absl::Span<const TraceMove> moves = is.MovesOf(visit.last_path + 1);
  const uint32_t line = moves.empty() ? is.segments[visit.last_segment].line : moves.front().line;
  findings.breaks.push_back(
      {VerifyRule::kPathEnds, had->line, line,
       absl::StrFormat("goes on along the loop for %.2f mm, but for %.2f mm in the original", mm,
                       had->length_mm())});
}

}  // namespace

void CheckDepartures(const LayerPair& layer, LayerFindings& findings) {
  const absl::flat_hash_set<uint32_t> turned = TurnedDepartures(layer);
  for (const Visit& visit : layer.visits()) {
    if (layer.Ended()) return;
    if (visit.segments != layer.was().paths[visit.path].size()) continue;
    CheckDeparture(layer, visit, turned, findings);
    CheckGoingOn(layer, visit, findings);
  }
}

// Where travel begins with such moves behind other paths than outer walls too, they may be on the
// travel to somewhere, unless nearly all travel from outer walls does so before it retracts.
void CompareDepartures(const Observations& was, const Observations& is, const RuleContext& context,
                       std::vector<Finding>& breaks) {
  constexpr int64_t kNearlyAll = 20;
  const bool nearly_all = was.departures_outside > kNearlyAll * was.retractions_outside;
  const bool leads_on = context.settings.leads_around_walls || was.departs_inside;
  if (leads_on && !nearly_all) return;
  breaks.insert(breaks.end(), is.lost_departures.begin(), is.lost_departures.end());
}

}  // namespace traverse::gcode
