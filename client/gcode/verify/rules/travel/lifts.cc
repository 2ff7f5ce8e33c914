// Lifts, by kind of travel: if at least 99 % of the original's are lifted, every sideways move
// outside wipes ends at the least such lift, and only a little of the travel is lower. Heights that
// moves state are heights above the layer that the original has too.

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "absl/types/span.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr float kLiftedMm = 0.015f;  // travel that rises this high is lifted
constexpr float kLowShare = 0.1f;
// A slope of two stretches becomes a straight one, which rises later.
constexpr float kLowFactor = 1.25f;
constexpr double kTellingMm = 2;  // slopes of shorter moves tell little

struct Height {
  float apex_mm = 0;
  float length_mm = 0;
};

Height HeightOf(const TravelProfile& travel) {
  Height height;
  for (const TravelProfile::Piece& piece : travel.pieces) {
    height.apex_mm = std::max(height.apex_mm, piece.to_mm);
    height.length_mm += piece.length_mm;
  }
  return height;
}

// The length of the pieces of travel that is lower than `lift`.
float LowLength(absl::Span<const TravelProfile::Piece> pieces, float lift) {
  float low = 0;
  for (const TravelProfile::Piece& piece : pieces) {
    const float from = piece.from_mm - lift + static_cast<float>(kHeightSlackMm);
    const float to = piece.to_mm - lift + static_cast<float>(kHeightSlackMm);
    if (from >= 0 && to >= 0) continue;
    low += from < 0 && to < 0
               ? piece.length_mm
               : piece.length_mm * std::min(from, to) / (std::min(from, to) - std::max(from, to));
  }
  return low;
}

bool EndsLow(const TravelProfile& travel, float lift) {
  return std::ranges::any_of(travel.pieces, [lift](const auto& piece) {
    return piece.to_mm < lift - kHeightSlackMm && piece.length_mm > kLeastTravelMm;
  });
}

// What travel of one kind does.
struct Habit {
  bool lifts = false;
  float least_mm = 0;
  uint32_t least_line = 0;
  float low_mm = static_cast<float>(kLeastTravelMm);
  float low_share = kLowShare;
  bool may_end_low = false;
};

Habit HabitOf(absl::Span<const TravelProfile> travels) {
  Habit habit;
  size_t lifted = 0;
  for (const TravelProfile& travel : travels) {
    const float apex = HeightOf(travel).apex_mm;
    if (apex < kLiftedMm) continue;
    if (++lifted == 1 || apex < habit.least_mm) {
      habit.least_mm = apex;
      habit.least_line = travel.at.line;
    }
  }
  habit.lifts = lifted > 0 &&
                static_cast<double>(lifted) >= kUsualShare * static_cast<double>(travels.size());
  if (!habit.lifts) return habit;
  std::vector<float> low_mm;
  std::vector<float> low_share;
  size_t end_low = 0;
  for (const TravelProfile& travel : travels) {
    const Height height = HeightOf(travel);
    if (height.apex_mm < kLiftedMm) continue;
    low_mm.push_back(LowLength(travel.pieces, habit.least_mm));
    low_share.push_back(low_mm.back() / height.length_mm);
    if (EndsLow(travel, habit.least_mm)) ++end_low;
  }
  habit.may_end_low =
      static_cast<double>(end_low) > (1 - kUsualShare) * static_cast<double>(lifted);
  habit.low_mm =
      std::max(static_cast<float>(kLeastTravelMm), UsualOf(std::move(low_mm)) * kLowFactor);
  habit.low_share = std::max(kLowShare, UsualOf(std::move(low_share)) * 1.01f);
  return habit;
}

// How far a move rises in 10 mm; 0 if it does not, or is shorter than `least_mm`.
int64_t SlopeOf(double rise_mm, double length_mm, double least_mm) {
  if (rise_mm <= 0 || length_mm < least_mm) return 0;
  return std::llround(rise_mm * 10'000 / length_mm);
}

// True if there is `value`, or one within `slack` of it.
bool Knows(const absl::flat_hash_set<int64_t>& known, int64_t value, int64_t slack) {
  for (int64_t near = value - slack; near <= value + slack; ++near) {
    if (known.contains(near)) return true;
  }
  return false;
}

// Travel of one link.
struct LinkTravel {
  const LayerPair& layer;
  const LayerSide& side;
  uint32_t link = 0;
  double to_mm = 0;  // the height of the path behind it
  bool level = false;
  bool retracted = false;
};

// Notes the height that `move` states, and the slope on which it reaches it.
void NoteHeight(const LinkTravel& of, const TraceMove& move, Observations& seen) {
  const int64_t um = std::llround((move.z_to_mm - of.to_mm) * 1000);
  const int64_t slope = SlopeOf(move.z_to_mm - move.z_from_mm, move.length_mm(), kTellingMm);
  if (!of.side.original) {
    seen.stated.push_back({um, slope, of.level, {move.line, of.layer.index()}});
    return;
  }
  StatedHeights& heights = of.level ? seen.level_heights : seen.other_heights;
  if (heights.um.empty()) heights.first_line = move.line;
  heights.um.insert(um);
  if (slope > 0) seen.slopes.insert(slope);
}

// Appends the profile of the travel among `moves`, which begin at `z_mm`.
void ObserveStretch(const LinkTravel& of, absl::Span<const TraceMove> moves, double z_mm,
                    Observations& seen) {
  const double base_mm = std::max(of.to_mm, z_mm);
  TravelProfile travel{.at = {0, of.layer.index()}};
  if (of.link > 0) travel.ends = EndsOf(of.side.chunk, of.link);
  double length_mm = 0;
  bool any_counts = false;
  for (const TraceMove& move : moves) {
    if (move.kind != MoveKind::kTravel || !move.in_print || move.open == of.retracted) continue;
    if (travel.at.line == 0) travel.at.line = move.line;
    length_mm += move.length_mm();
    travel.pieces.push_back({static_cast<float>(move.z_from_mm - base_mm),
                             static_cast<float>(move.z_to_mm - base_mm),
                             static_cast<float>(move.length_mm())});
    if (!of.layer.Counts(of.side, move)) continue;
    any_counts = true;
    if (move.states_z) NoteHeight(of, move, seen);
  }
  if (length_mm < kLeastMoveMm || !any_counts) return;
  const bool between = of.side.chunk.links[of.link].new_layer || !of.level;
  const bool crossing = of.layer.CrossesOuterWalls(of.side.chunk, of.link, !of.retracted);
  seen.travels[(of.retracted ? 4u : 0u) + (between ? 2u : 0u) + (crossing ? 1u : 0u)].push_back(
      std::move(travel));
}

// The travel in `link`, up to where the nozzle is opened and from there on, as where the head comes
// down on its way to the next object.
void Observe(const LayerPair& layer, const LayerSide& side, uint32_t link, Observations& seen) {
  const TraceLink& traced = side.chunk.links[link];
  absl::Span<const TraceMove> moves = side.chunk.MovesOf(link);
  // The travel to the first path shows nothing about travel between layers.
  if (moves.empty() || traced.first || traced.scripted || !moves.front().in_print) return;
  const double to_mm = side.chunk.paths[link].z_mm;
  double z_mm = moves.front().z_from_mm;
  const bool level = std::abs(z_mm - to_mm) <= kOneHeightMm;
  const bool retracted = std::ranges::any_of(moves, [](const TraceMove& move) {
    return move.kind == MoveKind::kTravel && move.in_print && !move.open;
  });
  for (;;) {
    const auto prime = std::ranges::find(moves, MoveKind::kPriming, &TraceMove::kind);
    const auto stretch = static_cast<size_t>(prime - moves.begin());
    ObserveStretch({layer, side, link, to_mm, level, retracted}, moves.first(stretch), z_mm, seen);
    if (prime == moves.end()) return;
    z_mm = prime->z_to_mm;
    moves.remove_prefix(stretch + 1);
  }
}

std::string KindText(size_t kind) {
  return absl::StrFormat("%s travel %s%s", (kind & 4) != 0 ? "retracted" : "unretracted",
                         (kind & 2) != 0 ? "between layers" : "within a layer",
                         (kind & 1) != 0 ? " across outer walls" : "");
}

absl::Span<const TravelProfile> OfLayer(const std::vector<TravelProfile>& travels, int64_t layer) {
  const auto layer_of = [](const TravelProfile& travel) { return travel.at.layer; };
  const auto first = std::ranges::lower_bound(travels, layer, {}, layer_of) - travels.begin();
  const auto end = std::ranges::upper_bound(travels, layer, {}, layer_of) - travels.begin();
  return absl::MakeConstSpan(travels).subspan(static_cast<size_t>(first),
                                              static_cast<size_t>(end - first));
}

// Some slicers lift only in some layers: above a height, or below it.
Habit HabitOfLayer(const std::vector<TravelProfile>& travels, int64_t layer) {
  const absl::Span<const TravelProfile> own = OfLayer(travels, layer);
  return own.size() < kFewestOfLayer ? Habit() : HabitOf(own);
}

// Whether the original has equally low travel between the same two points of the layer.
bool WasAsLow(const std::vector<TravelProfile>& were, const TravelProfile& travel, float lift) {
  const absl::Span<const TravelProfile> travels = OfLayer(were, travel.at.layer);
  const Height now = HeightOf(travel);
  return std::ranges::any_of(travels, [&](const TravelProfile& before) {
    if (before.ends != travel.ends) return false;
    const Height then = HeightOf(before);
    return now.apex_mm >= then.apex_mm - kHeightSlackMm &&
           LowLength(travel.pieces, lift) <= LowLength(before.pieces, lift) + kLeastMoveMm &&
           (!EndsLow(travel, lift) || EndsLow(before, lift));
  });
}

// True if the travel begins with a slope as steep as one of the original's.
bool BeginsWithUsualSlope(const Observations& was, const TravelProfile& travel) {
  const TravelProfile::Piece& piece = travel.pieces.front();
  const int64_t slope = SlopeOf(piece.to_mm - piece.from_mm, piece.length_mm, kLeastTravelMm);
  // Heights are rounded to micrometres.
  const auto rounded = static_cast<int64_t>(10 / piece.length_mm);
  return slope > 0 && Knows(was.slopes, slope, kSlackUm + rounded);
}

// The same, and it is not low behind that slope: on the slope itself it is no lower than such
// travel of the original, whatever part of it that is.
bool RisesAsUsual(const Observations& was, const TravelProfile& travel, float lift) {
  const absl::Span<const TravelProfile::Piece> pieces = travel.pieces;
  return BeginsWithUsualSlope(was, travel) && LowLength(pieces.subspan(1), lift) <= kLeastMoveMm;
}

// All of it is a slope, as short as it is, where longer travel begins with one.
bool RisesAllAlong(const Observations& was, const TravelProfile& travel) {
  const TravelProfile::Piece& piece = travel.pieces.front();
  return travel.pieces.size() == 1 && piece.to_mm > piece.from_mm && !was.slopes.empty();
}

void CompareKind(const Observations& was, const Observations& is, size_t kind,
                 std::vector<Finding>& breaks) {
  // Of a kind that the original has none of, the nearest one tells.
  const Habit of_print = HabitOf(was.travels[was.travels[kind].empty() ? kind ^ 1 : kind]);
  Habit of_layer;
  int64_t layer = -1;
  for (const TravelProfile& travel : is.travels[kind]) {
    if (!of_print.lifts && travel.at.layer != layer) {
      layer = travel.at.layer;
      of_layer = HabitOfLayer(was.travels[kind], layer);
    }
    const Habit& habit = of_print.lifts ? of_print : of_layer;
    if (!habit.lifts) continue;
    const Height height = HeightOf(travel);
    const float low = LowLength(travel.pieces, habit.least_mm);
    const bool ends_low = !habit.may_end_low && EndsLow(travel, habit.least_mm);
    const bool lies_low = low > kLeastTravelMm && !RisesAsUsual(was, travel, habit.least_mm) &&
                          (low > habit.low_mm || (low / height.length_mm > habit.low_share &&
                                                  !RisesAllAlong(was, travel)));
    const bool never = height.apex_mm < habit.least_mm - kHeightSlackMm;
    if (!ends_low && !lies_low && !never) continue;
    if (WasAsLow(was.travels[kind], travel, habit.least_mm)) continue;
    breaks.push_back({VerifyRule::kLifts, habit.least_line, travel.at,
                      absl::StrFormat("%.2f of %.2f mm of this travel are less than %.2f mm above "
                                      "the layer, the least lift of %s",
                                      low, height.length_mm, habit.least_mm, KindText(kind))});
  }
}

}  // namespace

void ObserveLifts(const LayerPair& layer, LayerFindings& findings) {
  layer.ForEachLink([&](const LayerSide& side, uint32_t link) {
    if (side.original || !layer.IsHidden(link)) Observe(layer, side, link, findings.Of(side));
  });
}

void CompareLifts(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  for (size_t kind = 0; kind < kTravelKinds; ++kind) CompareKind(was, is, kind, breaks);
  const StatedHeights& level = was.level_heights;
  const StatedHeights& other = was.other_heights;
  int64_t highest = 0;
  for (const StatedHeights* heights : {&level, &other}) {
    for (const int64_t um : heights->um) highest = std::max(highest, um);
  }
  const uint32_t first_line = (level.um.empty() ? other : level).first_line;
  for (const StatedHeight& stated : is.stated) {
    // Lifts between paths of one height are compared with their like, if there are any.
    const bool with_other = !stated.level || level.um.empty();
    bool known = Knows(level.um, stated.um, kSlackUm) ||
                 (with_other && Knows(other.um, stated.um, kSlackUm));
    // On a slope that ends with its travel, shorter travel reaches less height.
    known |= stated.slope > 0 && stated.um <= highest && Knows(was.slopes, stated.slope, kSlackUm);
    if (stated.slope > 0 && was.slopes.empty()) {
      breaks.push_back({VerifyRule::kLifts, first_line, stated.at,
                        "travel rises on its way, as none does in the original"});
      continue;
    }
    if (known) continue;
    breaks.push_back(
        {VerifyRule::kLifts, first_line, stated.at,
         absl::StrFormat("travel rises to %.3f mm above the layer; none of the original does",
                         static_cast<double>(stated.um) / 1000)});
  }
}

}  // namespace traverse::gcode
