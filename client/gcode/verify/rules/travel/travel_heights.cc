// The heights of travel, whether or not travel of its kind is lifted. None is lower than the higher
// of the two paths that it connects, unless such travel of the original is; none descends over a
// longer stretch; and lifts, and all that rises near an unknown line, have heights above the layer
// that lifts of the original have.

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

TravelRise RiseOf(double from, double to) {
  if (std::abs(to - from) <= kOneHeightMm) return TravelRise::kLevel;
  return to > from ? TravelRise::kUp : TravelRise::kDown;
}

int64_t Um(double mm) { return std::llround(mm * 1000); }

// Travel from the start script is no example for other travel: it is only no higher, and no lower,
// than it was.
void ObserveFirstTravel(const LayerPair& layer, const TraceChunk& chunk, const TraceLink& traced,
                        Observations& seen) {
  for (uint32_t m = traced.first_move; m < traced.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (!move.in_print) continue;
    const ExtremePoint point{move.z_to_mm, move.line, layer.index()};
    ExtremePoint& highest = seen.first_highest;
    if (highest.line == 0 || point.z_mm > highest.z_mm) highest = point;
    ExtremePoint& lowest = seen.first_lowest;
    if (lowest.line == 0 || point.z_mm < lowest.z_mm) lowest = point;
  }
}

// How the head goes up and down on the travel of one link.
class LinkHeights {
 public:
  LinkHeights(double from, double to, bool scripted, int64_t layer, Observations& seen)
      : from_(from),
        to_(to),
        scripted_(scripted),
        seen_(seen),
        lowest_{0, 0, layer, RiseOf(from, to)},
        deepest_(lowest_),
        descent_{0, 0, layer, lowest_.rise},
        lifts_{lowest_.rise == TravelRise::kLevel, 0, 0, 0, layer} {}

  void CountLifts(const TraceMove& move) {
    if (move.kind == MoveKind::kUp && move.z_to_mm > move.z_from_mm && ++lifts_.times > 1) {
      lifts_.line = move.line;
    }
    sinks_ |= move.z_to_mm < move.z_from_mm - kHeightSlackMm;
    if (lowest_.rise != TravelRise::kDown && sinks_ &&
        move.z_to_mm > move.z_from_mm + kHeightSlackMm) {
      sinks_ = false;
      ++lifts_.dips;
      lifts_.line = move.line;
    }
  }

  void NoteRise(const TraceMove& move, bool only_new) {
    // A slope among known lines is compared with the heights of all travel moves: lifts.
    const bool rises = move.kind == MoveKind::kUp || (scripted_ && move.sideways());
    if (!rises || move.z_to_mm <= move.z_from_mm) return;
    const auto note = [&](auto& map, auto key) { NoteSeen(map, key, move.line, lifts_.layer); };
    auto& heights = seen_.rises.Of(lifts_.level);
    note(heights, Um(move.z_to_mm - to_));
    if (!only_new) note(heights, Um(move.z_to_mm - from_));
    if (move.spiral != 0) note(seen_.spirals, move.spiral);
  }

  void NoteDepth(const TraceMove& move) {
    if (move.kind == MoveKind::kDown) {
      const auto below = static_cast<float>(move.z_to_mm - std::min(from_, to_));
      if (below < deepest_.above_mm) {
        deepest_.above_mm = below;
        deepest_.line = move.line;
      }
    }
    if (move.kind != MoveKind::kTravel || move.length_mm() < kLeastMoveMm) return;
    const auto length = static_cast<float>(move.length_mm());
    if (move.z_to_mm < move.z_from_mm - kHeightSlackMm && length > descent_.length_mm) {
      descent_.length_mm = length;
      descent_.line = move.line;
    }
    const auto above = static_cast<float>(move.z_to_mm - std::max(from_, to_));
    if (above >= lowest_.above_mm) return;
    lowest_.above_mm = above;
    lowest_.line = move.line;
  }

  void Finish() {
    if (descent_.line != 0) seen_.descents.push_back(descent_);
    if (lowest_.line != 0) seen_.lowest.push_back(lowest_);
    if (deepest_.line != 0) seen_.deepest.push_back(deepest_);
    if (lifts_.line != 0) seen_.lifts_of_links.push_back(lifts_);
  }

 private:
  const double from_;
  const double to_;
  const bool scripted_;
  Observations& seen_;
  LowestTravel lowest_;
  LowestTravel deepest_;
  Descent descent_;
  RepeatedLift lifts_;
  bool sinks_ = false;
};

void Observe(const LayerPair& layer, const TraceChunk& chunk, uint32_t link, bool only_new,
             Observations& seen) {
  const TraceLink& traced = chunk.links[link];
  if (traced.first_move == traced.end_move) return;
  if (!chunk.moves[traced.first_move].in_print) {
    return ObserveFirstTravel(layer, chunk, traced, seen);
  }
  LinkHeights heights(chunk.moves[traced.first_move].z_from_mm, chunk.paths[link].z_mm,
                      traced.scripted, layer.index(), seen);
  // A new departure is as high as the path before; those of the original are examples.
  const TraceMove* departure = only_new ? DepartureOf(chunk, link) : nullptr;
  for (uint32_t m = traced.first_move; m < traced.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    heights.CountLifts(move);
    if (only_new && layer.IsKnown(move)) continue;
    heights.NoteRise(move, only_new);
    if (&move != departure) heights.NoteDepth(move);
  }
  heights.Finish();
}

// The head descends no deeper than in the original, and does not rise more often between two paths.
void CompareMoves(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  LowestTravel deepest;
  for (const LowestTravel& move : was.deepest) {
    if (move.above_mm < deepest.above_mm) deepest = move;
  }
  for (const LowestTravel& move : is.deepest) {
    if (move.above_mm >= deepest.above_mm - kHeightSlackMm) continue;
    breaks.push_back({VerifyRule::kLifts, deepest.line, move.line, move.layer,
                      absl::StrFormat("the head descends %.3f mm below the layer; in the original "
                                      "%.3f mm at most",
                                      -move.above_mm, -deepest.above_mm)});
  }
  std::array<RepeatedLift, 2> most;
  std::array<RepeatedLift, 2> dipping;
  for (const RepeatedLift& lifts : was.lifts_of_links) {
    if (lifts.times > most[lifts.level].times) most[lifts.level] = lifts;
    if (lifts.dips > dipping[lifts.level].dips) dipping[lifts.level] = lifts;
  }
  for (const RepeatedLift& lifts : is.lifts_of_links) {
    const RepeatedLift& usual = most[lifts.level];
    const uint32_t times = std::max(usual.times, 1u);
    if (lifts.dips > dipping[lifts.level].dips) {
      breaks.push_back({VerifyRule::kLifts, dipping[lifts.level].line, lifts.line, lifts.layer,
                        "the head descends and rises again between two paths, unlike in the "
                        "original"});
      continue;
    }
    if (lifts.times <= times) continue;
    breaks.push_back({VerifyRule::kLifts, usual.line, lifts.line, lifts.layer,
                      absl::StrFormat("the head rises %d times between two paths; in the original "
                                      "%d times at most",
                                      lifts.times, times)});
  }
  for (const auto& [spiral, seen] : is.spirals) {
    if (was.spirals.contains(spiral)) continue;
    AddAt(seen,
          {VerifyRule::kLifts, FirstLineOf(was.spirals), 0, -1,
           "no spiral lift of the original has this center and direction"},
          breaks);
  }
}

void CompareDescents(const Observations& was, const Observations& is,
                     std::vector<Finding>& breaks) {
  std::array<Descent, static_cast<size_t>(TravelRise::kCount)> known;
  for (const Descent& descent : was.descents) {
    Descent& longest = known[static_cast<size_t>(descent.rise)];
    if (descent.length_mm > longest.length_mm) longest = descent;
  }
  for (const Descent& descent : is.descents) {
    const Descent& longest = known[static_cast<size_t>(descent.rise)];
    if (descent.length_mm <= longest.length_mm + kLeastTravelMm) continue;
    breaks.push_back(
        {VerifyRule::kLifts, longest.line, descent.line, descent.layer,
         absl::StrFormat("the head descends over %.2f mm of travel; in the original over "
                         "%.2f mm at most",
                         descent.length_mm, longest.length_mm)});
  }
}

void CompareFirstTravel(const Observations& was, const Observations& is,
                        std::vector<Finding>& breaks) {
  const auto compare = [&breaks](const ExtremePoint& had, const ExtremePoint& has, double side,
                                 const char* leads) {
    if (had.line == 0 || has.line == 0 || side * (has.z_mm - had.z_mm) <= kHeightSlackMm) return;
    breaks.push_back({VerifyRule::kLifts, had.line, has.line, has.layer,
                      absl::StrFormat("travel from the start script %s to Z%.3f; in the original "
                                      "to Z%.3f",
                                      leads, has.z_mm, had.z_mm)});
  };
  compare(was.first_highest, is.first_highest, 1, "rises");
  compare(was.first_lowest, is.first_lowest, -1, "descends");
}

void CompareRises(const Observations& was, const Observations& is, bool level,
                  std::vector<Finding>& breaks) {
  for (const auto& [um, seen] : is.rises.Of(level)) {
    if (was.rises.Have(um, level) || was.heights.Have(um, level)) continue;
    AddAt(seen,
          {VerifyRule::kLifts, was.rises.FirstLine(), 0, -1,
           absl::StrFormat("a lift of %.3f mm above the layer; no such lift of the original has "
                           "this height",
                           static_cast<double>(um) / 1000)},
          breaks);
  }
}

// How travel to a path that is lower than the one before gets there.
struct Sinking {
  bool sinks = false;
  Point at;           // where it first is lower than the path before
  double low_mm = 0;  // the length of the travel that is lower than that
  uint32_t line = 0;
};

Sinking SinkingTo(const TraceChunk& chunk, uint32_t path) {
  const TraceLink& link = chunk.links[path];
  Sinking travel;
  if (link.first_move == link.end_move || !chunk.moves[link.first_move].in_print) return travel;
  const double level = chunk.moves[link.first_move].z_from_mm - kHeightSlackMm;
  if (chunk.paths[path].z_mm >= level) return travel;
  for (uint32_t m = link.first_move; m < link.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (move.z_to_mm >= level && move.z_from_mm >= level) continue;
    if (!travel.sinks) travel = {true, move.from, 0, move.line};
    travel.low_mm += move.sideways() ? move.length_mm() : 0;
  }
  return travel;
}

}  // namespace

// A head that descends too early hits what was printed before.
void CheckSinking(const LayerPair& layer, LayerFindings& findings) {
  for (size_t i = 0; i < layer.section_count(); ++i) {
    if (layer.Ended()) return;
    const Sinking was = SinkingTo(layer.was(), layer.SectionWas(i).first_path);
    const Sinking is = SinkingTo(layer.is(), layer.SectionIs(i).first_path);
    if (!was.sinks || !is.sinks || DistanceOf(is.at, was.at) <= kLeastMoveMm ||
        is.low_mm <= was.low_mm + kLeastTravelMm) {
      continue;
    }
    findings.breaks.push_back(
        {VerifyRule::kLifts, was.line, is.line, layer.index(),
         absl::StrFormat("the head descends %.2f mm before a lower path; in the original %.2f mm "
                         "before it, at another point",
                         is.low_mm, was.low_mm)});
  }
}

void ObserveHeights(const LayerPair& layer, LayerFindings& findings) {
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    if (layer.Ended()) return;
    Observe(layer, layer.was(), link, false, findings.was);
  }
  for (uint32_t link = layer.first_path_is(); link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    Observe(layer, layer.is(), link, true, findings.is);
  }
}

void CompareHeights(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  CompareMoves(was, is, breaks);
  CompareFirstTravel(was, is, breaks);
  CompareDescents(was, is, breaks);
  std::array<LowestTravel, static_cast<size_t>(TravelRise::kCount)> known;
  for (const LowestTravel& travel : was.lowest) {
    LowestTravel& lowest = known[static_cast<size_t>(travel.rise)];
    if (travel.above_mm < lowest.above_mm) lowest = travel;
  }
  for (const LowestTravel& travel : is.lowest) {
    const LowestTravel& lowest = known[static_cast<size_t>(travel.rise)];
    if (travel.above_mm >= lowest.above_mm - kHeightSlackMm) continue;
    breaks.push_back(
        {VerifyRule::kLifts, lowest.line, travel.line, travel.layer,
         absl::StrFormat("travel is %.3f mm below the paths that it connects; in the original "
                         "%.3f mm at most",
                         -travel.above_mm, -lowest.above_mm)});
  }
  CompareRises(was, is, true, breaks);
  CompareRises(was, is, false, breaks);
}

}  // namespace traverse::gcode
