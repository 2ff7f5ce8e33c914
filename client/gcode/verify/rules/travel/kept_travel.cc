// Where two segments follow one another as in the original, nothing between them has a reason to
// change: the same steps lead from the one to the other.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Straight travel may come in several pieces.
bool GoesOn(const TraceMove& before, const TraceMove& move) {
  return before.kind == MoveKind::kTravel && move.kind == MoveKind::kTravel && !before.arc &&
         !move.arc && before.open == move.open && before.feed == move.feed &&
         before.acceleration == move.acceleration &&
         std::abs(before.z_from_mm - move.z_to_mm) <= kHeightSlackMm &&
         std::abs(before.z_to_mm - move.z_to_mm) <= kHeightSlackMm &&
         DistanceToPiece(before.to, before.from, move.to) <= kSamePointMm;
}

std::vector<TraceMove> MovesOf(const TraceChunk& chunk, uint32_t link) {
  std::vector<TraceMove> moves;
  for (const TraceMove& move : chunk.MovesOf(link)) {
    if (move.IsNothing(kSamePointMm)) continue;
    if (!moves.empty() && GoesOn(moves.back(), move)) {
      moves.back().to = move.to;
      moves.back().middle = {(moves.back().from.x + move.to.x) / 2,
                             (moves.back().from.y + move.to.y) / 2};
    } else {
      moves.push_back(move);
    }
  }
  return moves;
}

bool SameMove(const TraceMove& a, const TraceMove& b) {
  return AreAlike(a, b) && a.firmware == b.firmware && a.acceleration == b.acceleration &&
         Distance(a.to, b.to) <= kSamePointMm && Distance(a.middle, b.middle) <= kSamePointMm;
}

// Of the segments between which `link` stands.
uint64_t DigestOfLink(const TraceChunk& chunk, uint32_t link) {
  const TraceSegment& before = chunk.segments[chunk.paths[link - 1].end_segment - 1];
  const TraceSegment& behind = chunk.segments[chunk.paths[link].first_segment];
  return Mix(EndsOf(chunk, link), Mix(before.digest, behind.digest));
}

// The original's links by the segments between which they stand. Not of paths that end or begin
// with a segment as another path of the layer does: some slicers print a line several times in one
// place, and then nobody can say which of them the next path follows.
absl::flat_hash_map<uint64_t, uint32_t> LinksOf(const LayerPair& layer) {
  const TraceChunk& was = layer.was();
  const auto end_of = [&was](uint32_t path) {
    return was.segments[was.paths[path].end_segment - 1].digest;
  };
  const auto begin_of = [&was](uint32_t path) {
    return was.segments[was.paths[path].first_segment].digest;
  };
  // The first link of a chunk follows a path of the chunk before.
  const uint32_t first = std::max(layer.first_path_was(), 1u);
  absl::flat_hash_map<uint64_t, int> ends;
  absl::flat_hash_map<uint64_t, int> begins;
  for (uint32_t path = first - 1; path < layer.end_path_was(); ++path) {
    ++ends[end_of(path)];
    ++begins[begin_of(path)];
  }
  absl::flat_hash_map<uint64_t, uint32_t> links;
  for (uint32_t link = first; link < layer.end_path_was(); ++link) {
    if (ends[end_of(link - 1)] > 1 || begins[begin_of(link)] > 1) continue;
    links.emplace(DigestOfLink(was, link), link);
  }
  return links;
}

// A path that leads back along itself is the same the other way round, and may have been turned.
bool LeadsBack(const TraceChunk& chunk, uint32_t path) {
  const TracePath& traced = chunk.paths[path];
  for (uint32_t k = 0; k <= traced.size() / 2; ++k) {
    const Point one = chunk.StartOf(traced, traced.first_segment + k);
    const Point other = chunk.segments[traced.end_segment - 1 - k].end;
    if (Distance(one, other) > kSamePointMm) return false;
  }
  return true;
}

std::string_view NameOf(const std::vector<TraceMove>& moves,
                        std::vector<TraceMove>::const_iterator move) {
  return move == moves.end() ? "path" : MoveKindName(move->kind);
}

}  // namespace

void CheckKeptTravels(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  const TraceChunk& is = layer.is();
  const absl::flat_hash_map<uint64_t, uint32_t> links = LinksOf(layer);
  for (uint32_t link = std::max(layer.first_path_is(), 1u); link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    if (layer.IsHidden(link)) continue;
    const auto found = links.find(DigestOfLink(is, link));
    if (found == links.end() || LeadsBack(is, link - 1) || LeadsBack(is, link)) continue;
    const std::vector<TraceMove> has = MovesOf(is, link);
    const std::vector<TraceMove> had = MovesOf(was, found->second);
    const auto [one, other] = std::ranges::mismatch(had, has, SameMove);
    if (one == had.end() && other == has.end()) continue;
    const bool more = other != has.end();
    findings.breaks.push_back(
        {VerifyRule::kKeptTravels, one == had.end() ? was.LineOf(found->second) : one->line,
         more ? other->line : is.LineOf(link),
         absl::StrFormat("a %s between two paths that follow each other in the original too, "
                         "which has another %s there",
                         NameOf(has, other), NameOf(had, one))});
  }
}

}  // namespace traverse::gcode
