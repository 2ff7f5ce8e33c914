// Which travel retracts, by the original's own habit. Travel of some kinds (to paths of one class,
// across outer walls or not) always retracts if it is longer than the slicer's threshold, in the
// whole print or in this layer. So does new travel of such a kind.

#include <algorithm>
#include <array>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/match/travel_ends.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr double kBentMm = 0.2;
constexpr int64_t kManyBent = 20;  // one in
constexpr double kBinMm = 0.1;
constexpr uint32_t kBins = 1000;

// So many retracted ones make a habit.
constexpr int64_t kEnoughOfPrint = 20;
constexpr int64_t kOneIn = 100;  // what is as rare as this is no habit
constexpr double kUsualThresholdMm = 1.5;

struct Travel {
  uint32_t kind = 0;
  double length_mm = 0;
  bool retracts = false;
  bool bent = false;
  uint32_t line = 0;
  uint64_t ends = 0;
  uint64_t ends_back = 0;
};

// The travel in `link`, from path to path; of length 0 if there is none within the layer.
Travel TravelIn(const LayerPair& layer, const TraceChunk& chunk, uint32_t link, PathClass to,
                bool only_new) {
  const TraceLink& traced = chunk.links[link];
  if (link == 0 || traced.new_layer || traced.scripted) return {};
  Travel travel;
  bool known = true;
  double length = 0;
  for (uint32_t m = traced.first_move; m < traced.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (move.kind != MoveKind::kTravel) continue;
    travel.retracts |= !move.open;
    known &= layer.IsKnown(move);
    length += move.length_mm();
    if (travel.line == 0) travel.line = move.line;
  }
  if (travel.line == 0 || (only_new && (known || travel.retracts))) return {};
  const Point from = chunk.EndOf(chunk.paths[link - 1]);
  const Point start = chunk.paths[link].start;
  travel.length_mm = DistanceOf(from, start);
  if (travel.length_mm < kLeastTravelMm) return {};
  const bool crosses = layer.CrossesOuterWall(from, start);
  travel.bent = length > travel.length_mm + kBentMm;
  travel.kind = 2 * static_cast<uint32_t>(to) + (crosses ? 1u : 0u);
  travel.ends = EndsOf(chunk, link);
  travel.ends_back = DigestOfEnds(start, from);
  return travel;
}

std::vector<Travel> TravelsOf(const LayerPair& layer) {
  std::vector<Travel> travels;
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    const Travel travel = TravelIn(layer, layer.was(), link, layer.ClassOf(link), false);
    if (travel.length_mm > 0) travels.push_back(travel);
  }
  return travels;
}

uint32_t BinOf(double length_mm) {
  return static_cast<uint32_t>(std::min<double>(length_mm / kBinMm, kBins - 1));
}

uint32_t KeyOf(uint32_t kind, uint32_t bin) { return kind * kBins + bin; }

// What the travel of a layer of the original does.
class LayerHabits {
 public:
  explicit LayerHabits(const std::vector<Travel>& travels) {
    for (const Travel& travel : travels) {
      NewOpenTravel& like = like_[travel.kind];
      if (travel.retracts) {
        ++like.retracted_in_layer;
        like.line_in_layer = travel.line;
      } else {
        open_.insert(travel.ends);
        const auto length = static_cast<float>(travel.length_mm);
        like.longest_in_layer_mm = std::max(like.longest_in_layer_mm, length);
      }
    }
  }

  // Whether there is such travel between the same two points, in either direction.
  bool HasOpen(const Travel& travel) const {
    return open_.contains(travel.ends) || open_.contains(travel.ends_back);
  }

  // `travel` with what the layer has of its kind.
  NewOpenTravel Among(const Travel& travel, int64_t layer) const {
    const auto found = like_.find(travel.kind);
    NewOpenTravel open = found != like_.end() ? found->second : NewOpenTravel{};
    open.kind = travel.kind;
    open.length_mm = static_cast<float>(travel.length_mm);
    open.line = travel.line;
    open.layer = layer;
    return open;
  }

 private:
  absl::flat_hash_set<uint64_t> open_;                 // Travel::ends
  absl::flat_hash_map<uint32_t, NewOpenTravel> like_;  // by kind
};

// The length from which on travel retracts if nothing else matters: as the slicer states it, or
// else the shortest that retracts, but for exceptions.
uint32_t ThresholdBin(const Observations& was, const SlicerSettings& settings) {
  if (settings.retract_before_mm > 0) return BinOf(settings.retract_before_mm);
  std::array<int64_t, kBins> retracted{};
  int64_t all = 0;
  for (const auto& [key, habit] : was.open_habits) {
    retracted[key % kBins] += habit.retracted;
    all += habit.retracted;
  }
  uint32_t bin = 0;
  for (int64_t shorter = 0; bin + 1 < kBins; ++bin) {
    shorter += retracted[bin];
    if (shorter * kOneIn > all) break;
  }
  return std::max(bin, BinOf(kUsualThresholdMm));
}

// Where slicers lead unretracted travel around walls, what travel would cross if it were straight
// tells nothing.
bool LeadsAround(const Observations& was) {
  int64_t open = 0;
  int64_t bent = 0;
  for (const auto& [key, habit] : was.open_habits) {
    open += habit.open;
    bent += habit.bent;
  }
  return bent > 0 && bent * kManyBent >= open;
}

// What travel of one kind does that is longer than the threshold.
OpenHabit HabitBeyond(const Observations& was, uint32_t kind, uint32_t threshold) {
  OpenHabit beyond;
  for (uint32_t bin = threshold + 1; bin < kBins; ++bin) {
    const auto found = was.open_habits.find(KeyOf(kind, bin));
    if (found == was.open_habits.end()) continue;
    beyond.retracted += found->second.retracted;
    beyond.open += found->second.open;
    if (beyond.line == 0) beyond.line = found->second.line;
  }
  return beyond;
}

}  // namespace

void ObserveOpenHabits(const LayerPair& layer, LayerFindings& findings) {
  const std::vector<Travel> travels = TravelsOf(layer);
  for (const Travel& travel : travels) {
    OpenHabit& habit = findings.was.open_habits[KeyOf(travel.kind, BinOf(travel.length_mm))];
    ++(travel.retracts ? habit.retracted : habit.open);
    habit.bent += travel.bent && !travel.retracts ? 1 : 0;
    if (travel.retracts && habit.line == 0) habit.line = travel.line;
  }
  const LayerHabits habits(travels);
  for (const Visit& visit : layer.visits()) {
    if (layer.Ended()) return;
    if (layer.IsHidden(visit.first_path)) continue;
    const Travel travel =
        TravelIn(layer, layer.is(), visit.first_path, layer.ClassOf(visit.path), true);
    if (travel.length_mm <= 0) continue;
    if (habits.HasOpen(travel)) continue;
    findings.is.new_open_travels.push_back(habits.Among(travel, layer.index()));
  }
}

void CompareOpenHabits(const Observations& was, const Observations& is, const RuleContext& context,
                       std::vector<Finding>& breaks) {
  if (is.new_open_travels.empty() || LeadsAround(was)) return;
  const uint32_t threshold = ThresholdBin(was, context.settings);
  absl::flat_hash_map<uint32_t, OpenHabit> habits;  // by kind
  for (const NewOpenTravel& travel : is.new_open_travels) {
    if (BinOf(travel.length_mm) <= threshold) continue;
    const auto [known, added] = habits.try_emplace(travel.kind);
    OpenHabit& habit = known->second;
    if (added) habit = HabitBeyond(was, travel.kind, threshold);
    const bool of_print =
        habit.retracted >= kEnoughOfPrint && habit.open * kOneIn <= habit.retracted;
    const bool of_layer = travel.retracted_in_layer >= kFewestOfLayer &&
                          BinOf(travel.longest_in_layer_mm) <= threshold;
    if (!of_print && !of_layer) continue;
    breaks.push_back(
        {VerifyRule::kOpenTravels, of_layer ? travel.line_in_layer : habit.line, travel.line,
         travel.layer,
         absl::StrFormat("travel of %.2f mm without a retraction; longer than %.1f mm, "
                         "this kind retracts in the original",
                         travel.length_mm, threshold * kBinMm)});
  }
}

}  // namespace traverse::gcode
