#include "client/gcode/verify/rules/obstacles.h"

#include <algorithm>
#include <optional>

#include "absl/strings/str_format.h"

namespace traverse::gcode {
namespace {

constexpr double kTipCellMm = 0.5;
constexpr double kHeadCellMm = 2;

// Half of a line, and of the flat around the hole of a nozzle.
constexpr double kTipRadiusMm = 0.4;

constexpr double kLevelMm = 0.05;

// The straight pieces of a move: an arc is two of them.
template <typename Take>
void ForEachPiece(const TraceMove& move, Take take) {
  if (!move.arc) {
    take(move.from, move.z_from_mm, move.to, move.z_to_mm);
    return;
  }
  const double z = (move.z_from_mm + move.z_to_mm) / 2;
  take(move.from, move.z_from_mm, move.middle, z);
  take(move.middle, z, move.to, move.z_to_mm);
}

// Where it begins and ends.
std::array<double, 6> EndsOf(const TraceMove& move) {
  return {move.from.x, move.from.y, move.z_from_mm, move.to.x, move.to.y, move.z_to_mm};
}

bool Moves(const TraceMove& move) {
  return move.sideways() || move.kind == MoveKind::kUp || move.kind == MoveKind::kDown;
}

}  // namespace

Obstacles::Obstacles(const SlicerSettings& settings, const WorkLimit& limit)
    : limit_(limit),
      tip_(kTipCellMm, {.base_mm = kTipRadiusMm,
                        .most_mm = std::min(kTipRadiusMm + settings.nozzle_height_mm,
                                            settings.clearance_radius_mm),
                        .slack_mm = kTipCellMm,
                        .is_tip = true}),
      head_(kHeadCellMm, {.least_excess_mm = settings.nozzle_height_mm,
                          .base_mm = settings.clearance_radius_mm,
                          .most_mm = settings.clearance_radius_mm,
                          .slack_mm = kHeadCellMm * 1.5}) {}

void Obstacles::Print(const TraceChunk& was, uint32_t first_path, uint32_t end_path) {
  std::vector<Piece> pieces;
  for (uint32_t path = first_path; path < end_path; ++path) {
    pieces.clear();
    AppendPieces(was, path, pieces);
    const double z_mm = was.paths[path].z_mm;
    for (const Piece& piece : pieces) {
      if (limit_.Ended()) return;
      tip_.Print(piece.a, piece.b, z_mm);
      head_.Print(piece.a, piece.b, z_mm);
    }
  }
}

void Obstacles::Visit(const TraceChunk& was, uint32_t link) {
  for (const TraceMove& move : was.MovesOf(link)) {
    if (limit_.Ended()) return;
    if (!Moves(move)) continue;
    moves_was_.insert(EndsOf(move));
    ForEachPiece(move, [this](Point a, double z_a, Point b, double z_b) {
      tip_.Visit(a, z_a, b, z_b);
      head_.Visit(a, z_a, b, z_b);
    });
  }
}

void Obstacles::CheckLink(const TraceChunk& is, uint32_t link, int64_t layer,
                          std::vector<Finding>& breaks) {
  std::optional<HeightGrid::Hit> hit;
  for (const TraceMove& move : is.MovesOf(link)) {
    if (limit_.Ended()) return;
    // What the original does in this layer too needs no proof.
    if (!Moves(move) || moves_was_.contains(EndsOf(move))) continue;
    ForEachPiece(move, [&](Point a, double z_a, Point b, double z_b) {
      if (!hit) hit = tip_.NearestHit(a, z_a, b, z_b);
      if (!hit) hit = head_.NearestHit(a, z_a, b, z_b);
    });
    if (!hit) continue;
    const Point at = hit->at;
    breaks.push_back(
        {VerifyRule::kObstacles,
         0,
         {move.line, layer},
         hit->off_mm > 0
             ? absl::StrFormat("leads past X%.1f Y%.1f, where something stands %.2f mm higher, at "
                               "%.1f mm, and no move of the original so near to it",
                               at.x, at.y, hit->above_mm, hit->off_mm)
             : absl::StrFormat("leads %.2f mm below the top of what stands at X%.1f Y%.1f, and no "
                               "move of the original there",
                               hit->above_mm, at.x, at.y)});
    return;
  }
}

// Whether anything stands above a move of the links.
bool Obstacles::AnyAbove(const TraceChunk& chunk, uint32_t first_link, uint32_t end_link) const {
  const double least_mm = tip_.highest_mm() - kLevelMm;
  const absl::Span<const TraceMove> moves = chunk.MovesOfLinks(first_link, end_link);
  return std::ranges::any_of(moves, [least_mm](const TraceMove& m) {
    return std::min(m.z_from_mm, m.z_to_mm) < least_mm;
  });
}

void Obstacles::CheckLayer(const TraceChunk& was, const TraceChunk& is, size_t layer,
                           std::vector<Finding>& breaks) {
  const auto paths = [layer](const TraceChunk& chunk) {
    const TraceLayer& traced = chunk.layers[layer];
    return std::pair(chunk.sections[traced.first_section].first_path,
                     chunk.sections[traced.end_section - 1].end_path);
  };
  const auto [first_was, end_was] = paths(was);
  const auto [first_is, end_is] = paths(is);
  const double z_mm = was.paths[first_was].z_mm;
  if (z_mm < z_mm_) {
    tip_.ForgetVisits();
    head_.ForgetVisits();
  }
  z_mm_ = z_mm;
  moves_was_.clear();
  if (z_mm < tip_.highest_mm() - kLevelMm || AnyAbove(is, first_is, end_is)) {
    std::vector<Piece> pieces;
    for (uint32_t path = first_was; path < end_was && !limit_.Ended(); ++path) {
      Visit(was, path);
      AppendPieces(was, path, pieces);
    }
    for (const Piece& piece : pieces) {
      if (limit_.Ended()) return;
      tip_.Visit(piece.a, z_mm, piece.b, z_mm);
      head_.Visit(piece.a, z_mm, piece.b, z_mm);
    }
    for (uint32_t link = first_is; link < end_is; ++link) {
      CheckLink(is, link, was.layers[layer].index, breaks);
    }
  }
  Print(was, first_was, end_was);
}

void Obstacles::CheckEnd(const TraceChunk& was, const TraceChunk& is,
                         std::vector<Finding>& breaks) {
  const auto link_was = static_cast<uint32_t>(was.links.size()) - 1;
  const auto link_is = static_cast<uint32_t>(is.links.size()) - 1;
  if (!AnyAbove(is, link_is, link_is + 1)) return;
  moves_was_.clear();
  Visit(was, link_was);
  CheckLink(is, link_is, -1, breaks);
}

}  // namespace traverse::gcode
