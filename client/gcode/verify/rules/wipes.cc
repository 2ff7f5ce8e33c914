// A wipe lies within 0.05 mm of its own path, and paths that were wiped stay wiped.

#include <algorithm>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr float kOnPathMm = 0.05f;
constexpr double kUsualShare = 0.99;

struct Wipe {
  float off_mm = 0;
  uint32_t line = 0;  // 0: none
  bool known = true;
};

// The wipe behind path `path` of `chunk`, whose pieces are `pieces`.
Wipe WipeBehind(const LayerPair& layer, const TraceChunk& chunk, uint32_t path,
                absl::Span<const Piece> pieces, bool measure) {
  Wipe wipe;
  const TraceLink& link = chunk.links[path + 1];
  for (uint32_t m = link.first_move; m < link.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (move.kind != MoveKind::kWipe || move.length_mm() <= 0) continue;
    if (wipe.line == 0) wipe.line = move.line;
    wipe.known &= layer.IsKnown(move);
    if (!measure) continue;
    double nearest = 1e9;
    for (const Piece& piece : pieces) {
      nearest = std::min(nearest, DistanceToPiece(move.to, piece.a, piece.b));
      if (nearest <= kOnPathMm) break;
    }
    wipe.off_mm = std::max(wipe.off_mm, static_cast<float>(nearest));
  }
  return wipe;
}

}  // namespace

void CheckWipes(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  std::vector<uint32_t> wiped(layer.end_path_was() - layer.first_path_was(), 0);  // line
  bool any = false;
  for (uint32_t path = layer.first_path_was(); path < layer.end_path_was(); ++path) {
    const Wipe wipe = WipeBehind(layer, was, path, layer.PiecesOf(path), true);
    wiped[path - layer.first_path_was()] = wipe.line;
    if (wipe.line == 0) continue;
    any = true;
    if (was.links[path + 1].scripted) continue;
    findings.was.wipes.push_back({wipe.off_mm, wipe.line, wipe.line, layer.index()});
  }
  for (const Visit& visit : layer.visits()) {
    const uint32_t line = wiped[visit.path - layer.first_path_was()];
    if (!any && layer.is().links[visit.last_path + 1].first_move ==
                    layer.is().links[visit.last_path + 1].end_move) {
      continue;
    }
    Wipe wipe = WipeBehind(layer, layer.is(), visit.last_path, layer.PiecesOf(visit.path), false);
    if (line != 0 && wipe.line == 0) {
      findings.breaks.push_back({VerifyRule::kWipes, line,
                                 layer.is().segments[visit.last_segment].line, layer.index(),
                                 "the wipe behind this path is gone"});
    }
    if (wipe.line == 0 || wipe.known) continue;
    wipe = WipeBehind(layer, layer.is(), visit.last_path, layer.PiecesOf(visit.path), true);
    findings.is.wipes.push_back(
        {wipe.off_mm, wipe.line, was.LineOf(was.paths[visit.path]), layer.index()});
  }
}

void CompareWipes(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  std::vector<float> off;
  for (const WipeDeviation& wipe : was.wipes) off.push_back(wipe.off_mm);
  float limit = kOnPathMm;
  if (!off.empty()) {
    const auto at = static_cast<std::ptrdiff_t>(kUsualShare * static_cast<double>(off.size() - 1));
    std::nth_element(off.begin(), off.begin() + at, off.end());
    limit = std::max(limit, off[static_cast<size_t>(at)] + 0.002f);
  }
  for (const WipeDeviation& wipe : is.wipes) {
    if (wipe.off_mm <= limit + 1e-4f) continue;
    breaks.push_back(
        {VerifyRule::kWipes, wipe.original_line, wipe.line, wipe.layer,
         absl::StrFormat("a wipe leads %.2f mm away from the path that it follows", wipe.off_mm)});
  }
}

}  // namespace traverse::gcode
