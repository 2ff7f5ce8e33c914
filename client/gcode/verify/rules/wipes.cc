// A wipe lies within 0.05 mm of its own path, turns back only where that does, and paths that were
// wiped stay wiped; if it is allowed to leave wipes out, then where the travel behind the path
// retracts.

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr double kTurnedMm = 0.012;  // rounded arcs lie this much nearer to one side
constexpr float kPullSlack = 1.02f;
constexpr float kGentleShare = 0.5f;
constexpr float kAmountSlackMm = 0.005f;
constexpr float kAsLong = 0.9f;
constexpr float kUnevenSlackMm = 0.01f;
constexpr float kTellingMm = 0.3f;  // rounding is nothing compared with the filament of such a move

// Of the angle by which the travel from `a` over `b` to `c` turns at `b`; 1 if it does not move
// there.
double CosineOfTurn(Point a, Point b, Point c) {
  const double product = Distance(a, b) * Distance(b, c);
  if (!(product > 0)) return 1;
  return ((b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y)) / product;
}

// A distance of up to `enough_mm` may be a larger one.
double DistanceTo(Point p, absl::Span<const Piece> pieces, double enough_mm = kOnPathMm) {
  double nearest = 1e9;
  for (const Piece& piece : pieces) {
    nearest = std::min(nearest, DistanceToPiece(p, piece.a, piece.b));
    if (nearest <= enough_mm) break;
  }
  return nearest;
}

// By how much the arc would lie nearer to the path if it went the other way: mirrored, or round the
// rest of its circle. Arcs of wipes may be so short that they nowhere lie far from their path.
double TurnedMm(const TraceMove& arc, absl::Span<const Piece> pieces) {
  const Point chord{(arc.from.x + arc.to.x) / 2, (arc.from.y + arc.to.y) / 2};
  const Point rise{arc.middle.x - chord.x, arc.middle.y - chord.y};
  const double height = std::hypot(rise.x, rise.y);
  if (height <= 0) return 0;
  const double half = arc.length_mm() / 2;
  const double rest = half * half / (height * height);
  const Point mirrored{chord.x - rise.x, chord.y - rise.y};
  const Point round{chord.x - rest * rise.x, chord.y - rest * rise.y};
  const auto distance = [pieces](Point p) { return DistanceTo(p, pieces, 0); };
  return distance(arc.middle) - std::min(distance(mirrored), distance(round));
}

// Whether the wipe turns back between the two moves, where its path has no such corner.
bool TurnsBackBetween(const TraceMove& before, const TraceMove& move,
                      absl::Span<const Piece> pieces) {
  constexpr double kTurn = -0.985;        // of 170 degrees
  constexpr double kNearlyTurn = -0.866;  // of 150 degrees
  if (before.arc || move.arc) return false;
  if (CosineOfTurn(before.from, move.from, move.to) >= kTurn) return false;
  for (size_t i = 0; i < pieces.size(); ++i) {
    const Piece& next = pieces[i + 1 < pieces.size() ? i + 1 : 0];
    if (Distance(pieces[i].b, move.from) > kOnPathMm) continue;
    if (CosineOfTurn(pieces[i].a, pieces[i].b, next.b) < kNearlyTurn) return false;
  }
  return true;
}

// The moves of the wipe after path `path`. Behind the first prime, as beside what is finished,
// those of the original follow no path.
std::vector<const TraceMove*> WipeMoves(const LayerPair& layer, const TraceChunk& chunk,
                                        uint32_t path) {
  std::vector<const TraceMove*> moves;
  bool primed = false;
  for (const TraceMove& move : chunk.MovesOf(path + 1)) {
    primed |= move.kind == MoveKind::kPriming;
    if (move.kind != MoveKind::kWipe || move.length_mm() <= 0) continue;
    if (!primed || !layer.IsKnown(move)) moves.push_back(&move);
  }
  return moves;
}

// By how much, at some point of `wipe`, the retracted filament is off an even rate.
float Unevenness(const std::vector<const TraceMove*>& moves, const Wipe& wipe) {
  double pulled = 0;
  double length = 0;
  double most = 0;
  const auto pull = static_cast<double>(wipe.pull());
  for (const TraceMove* move : moves) {
    pulled -= static_cast<double>(move->filament) * kMicro;
    length += move->length_mm();
    most = std::max(most, std::abs(pulled - pull * length));
  }
  return static_cast<float>(most);
}

// The wipe after path `path` of `side`, whose pieces are `pieces`. How it follows them is measured
// only if it is an example for others, or new.
Wipe WipeBehind(const LayerPair& layer, const LayerSide& side, uint32_t path,
                absl::Span<const Piece> pieces) {
  Wipe wipe{.at = {0, layer.index()}};
  const std::vector<const TraceMove*> moves = WipeMoves(layer, side.chunk, path);
  wipe.known =
      std::ranges::all_of(moves, [&](const TraceMove* move) { return layer.IsKnown(*move); });
  const bool measure = side.original || !wipe.known;
  const TraceMove* last = nullptr;
  for (const TraceMove* each : moves) {
    const TraceMove& move = *each;
    const TraceMove* before = std::exchange(last, each);
    const bool returns = wipe.at.line == 0 && DepartureOf(side.chunk, path + 1) != nullptr;
    if (wipe.at.line == 0) wipe.at.line = move.line;
    ++wipe.moves;
    wipe.length_mm += static_cast<float>(move.length_mm());
    const auto pulled = static_cast<float>(static_cast<double>(-move.filament) * kMicro);
    wipe.pulled_mm += pulled;
    const auto length = static_cast<float>(move.length_mm());
    if (length >= kTellingMm) wipe.steepest = std::max(wipe.steepest, pulled / length);
    if (!measure || wipe.moves > kMostAlong) continue;
    wipe.turns_back |= before != nullptr && TurnsBackBetween(*before, move, pieces);
    wipe.off_mm = std::max(wipe.off_mm, static_cast<float>(DistanceTo(move.to, pieces)));
    // A chord of the path has both its ends on it, but where it returns from a short move away.
    if (returns) continue;
    wipe.astray_mm = std::max(wipe.astray_mm, static_cast<float>(DistanceTo(move.middle, pieces)));
    if (!move.arc) continue;
    wipe.turned_mm = std::max(wipe.turned_mm, static_cast<float>(TurnedMm(move, pieces)));
  }
  if (measure && wipe.at.line != 0) wipe.uneven_mm = Unevenness(moves, wipe);
  return wipe;
}

// A bound of `deviation` that all but a few wipes of the original keep, but at least `least_mm`.
float LimitOf(const std::vector<Wipe>& wipes, float Wipe::*deviation, double least_mm) {
  const auto least = static_cast<float>(least_mm);
  if (wipes.empty()) return least;
  std::vector<float> values;
  for (const Wipe& wipe : wipes) values.push_back(wipe.*deviation);
  return std::max(least, UsualOf(std::move(values)) + 0.002f) + 1e-4f;
}

// How wipes pull filament back.
struct Pulls {
  std::vector<float> longest;        // their lengths, descending
  std::vector<const Wipe*> fastest;  // [i] of the i + 1 longest ones
  float steepest = 0;
  float gentlest = 0;
  float uneven_mm = 0;
  float most_mm = 0;
  bool turns_back = false;

  // Some are cut short, and pull as much: that tells nothing of longer ones.
  const Wipe& FastestOfLength(float length_mm) const {
    const auto behind = std::ranges::partition_point(
        longest, [length_mm](float l) { return l >= kAsLong * length_mm; });
    const auto as_long = static_cast<size_t>(behind - longest.begin());
    return *fastest[(as_long == 0 ? fastest.size() : as_long) - 1];
  }

  bool Unlike(const Wipe& wipe) const {
    return wipe.steepest > std::max(steepest, fastest.back()->pull()) * kPullSlack ||
           wipe.pull() < gentlest * kGentleShare || wipe.uneven_mm > uneven_mm + kUnevenSlackMm ||
           wipe.pulled_mm > most_mm + kAmountSlackMm;
  }
};

Pulls PullsOf(const std::vector<Wipe>& wipes) {
  Pulls pulls;
  for (const Wipe& wipe : wipes) {
    pulls.gentlest = pulls.fastest.empty() ? wipe.pull() : std::min(pulls.gentlest, wipe.pull());
    pulls.fastest.push_back(&wipe);
    pulls.steepest = std::max(pulls.steepest, wipe.steepest);
    pulls.uneven_mm = std::max(pulls.uneven_mm, wipe.uneven_mm);
    pulls.most_mm = std::max(pulls.most_mm, wipe.pulled_mm);
    pulls.turns_back |= wipe.turns_back;
  }
  std::ranges::sort(pulls.fastest, std::greater(), &Wipe::length_mm);
  for (size_t i = 0; i < pulls.fastest.size(); ++i) {
    pulls.longest.push_back(pulls.fastest[i]->length_mm);
    if (i > 0 && pulls.fastest[i - 1]->pull() >= pulls.fastest[i]->pull())
      pulls.fastest[i] = pulls.fastest[i - 1];
  }
  return pulls;
}

bool PullsBack(const TraceChunk& chunk, uint32_t link) {
  const absl::Span<const TraceMove> moves = chunk.MovesOf(link);
  return std::ranges::any_of(moves, Retracts);
}

// Whether a wipe that the original has may be missing in `link` of the other file. Where the
// original leaves the layer without one, as slicers do that retract behind the marks of the next,
// any path may be left so. `leaves_wiping`: it does not.
bool MayLackWipe(const LayerPair& layer, uint32_t link, bool leaves_wiping,
                 const RuleContext& context) {
  if (layer.IsHidden(link)) return true;
  const TraceChunk& is = layer.is();
  if (link == layer.end_path_is() && !leaves_wiping &&
      PullsBack(layer.was(), layer.end_path_was()) && PullsBack(is, link)) {
    return true;
  }
  const TraceLink& traced = is.links[link];
  return context.permissions.drops_wipes() && !traced.new_layer && !traced.scripted &&
         !PullsBack(is, link);
}

}  // namespace

void CheckWipes(const LayerPair& layer, const RuleContext& context, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  std::vector<uint32_t> wiped;  // [path - first path of the layer] the line; 0: not wiped
  bool any = false;
  for (uint32_t path = layer.first_path_was(); path < layer.end_path_was(); ++path) {
    if (layer.Ended()) return;
    const Wipe wipe = WipeBehind(layer, layer.Side(true), path, layer.PiecesOf(path));
    wiped.push_back(wipe.at.line);
    if (wipe.at.line == 0) continue;
    any = true;
    if (!was.links[path + 1].scripted) findings.was.wipes.push_back(wipe);
  }
  for (const Visit& visit : layer.visits()) {
    if (layer.Ended()) return;
    const uint32_t had_line = wiped[visit.path - layer.first_path_was()];
    if (!any && layer.is().MovesOf(visit.last_path + 1).empty()) continue;
    // Else what follows is of the path to which the other file goes on.
    const bool ends = layer.EndsPath(visit);
    Wipe wipe;
    if (ends) {
      wipe = WipeBehind(layer, layer.Side(false), visit.last_path, layer.PiecesOf(visit.path));
    }
    const bool may_lack =
        ends ? MayLackWipe(layer, visit.last_path + 1, wiped.back() != 0, context)
             : context.permissions.drops_wipes() || context.permissions.hides_travel();
    if (had_line != 0 && wipe.at.line == 0 && !may_lack) {
      findings.breaks.push_back({VerifyRule::kWipes, had_line,
                                 layer.is().segments[visit.last_segment].line,
                                 "the wipe after this path is missing"});
    }
    if (wipe.at.line == 0 || wipe.known) continue;
    wipe.path_line = was.LineOf(visit.path);
    if (wipe.moves > kMostAlong) {
      findings.breaks.push_back(
          {VerifyRule::kWipes, wipe.path_line, wipe.at.line,
           absl::StrFormat("a new wipe of more than %d moves is not followed", kMostAlong)});
    }
    findings.is.wipes.push_back(wipe);
  }
}

void CompareWipes(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  const float off_limit = LimitOf(was.wipes, &Wipe::off_mm, kOnPathMm);
  const float astray_limit = LimitOf(was.wipes, &Wipe::astray_mm, kOnPathMm);
  const float turned_limit = LimitOf(was.wipes, &Wipe::turned_mm, kTurnedMm);
  const Pulls pulls = PullsOf(was.wipes);
  for (const Wipe& wipe : is.wipes) {
    if (!pulls.fastest.empty() && pulls.Unlike(wipe)) {
      breaks.push_back({VerifyRule::kWipes, pulls.fastest.back()->at.line, wipe.at,
                        "a wipe retracts unlike those of the original"});
    }
    const Wipe* most = pulls.fastest.empty() ? nullptr : &pulls.FastestOfLength(wipe.length_mm);
    if (most != nullptr && wipe.pull() > most->pull() * kPullSlack) {
      breaks.push_back(
          {VerifyRule::kWipes, most->at.line, wipe.at,
           absl::StrFormat("a wipe retracts %.3f mm per mm; the most in the original is %.3f mm",
                           wipe.pull(), most->pull())});
    }
    if (wipe.turns_back && !pulls.turns_back) {
      breaks.push_back({VerifyRule::kWipes, wipe.path_line, wipe.at,
                        "a wipe turns back where its path does not"});
      continue;
    }
    if (wipe.turned_mm > turned_limit) {
      breaks.push_back({VerifyRule::kWipes, wipe.path_line, wipe.at,
                        "an arc of a wipe turns away from the path that it follows"});
      continue;
    }
    if (wipe.off_mm <= off_limit && wipe.astray_mm <= astray_limit) continue;
    breaks.push_back({VerifyRule::kWipes, wipe.path_line, wipe.at,
                      absl::StrFormat("a wipe leads %.2f mm away from the path that it follows",
                                      std::max(wipe.off_mm, wipe.astray_mm))});
  }
}

}  // namespace traverse::gcode
