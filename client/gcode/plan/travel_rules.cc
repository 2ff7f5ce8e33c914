#include "client/gcode/plan/travel_rules.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "absl/container/inlined_vector.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/model/part_links.h"

namespace traverse::gcode {
namespace {

// Layers from which habits are learnt.
constexpr size_t kSampledLayers = 24;

// Travel to such paths lies inside an island where it crosses no visible wall, which it need not
// between parts of a support or a brim; and where it oozes hardly anybody sees it, as one does at
// the start of an outer wall.
bool IsInside(Feature feature) {
  return feature == Feature::kLoop || feature == Feature::kLine || feature == Feature::kInnerWall ||
         feature == Feature::kGapFill || feature == Feature::kSparseInfill ||
         feature == Feature::kSolidInfill || feature == Feature::kBottomInfill ||
         feature == Feature::kTopInfill;
}

// Of all features, or of those inside.
RetractionCount SumOf(const RetractionCounts& counts, bool inside) {
  RetractionCount sum;
  for (size_t i = 0; i < counts.size(); ++i) {
    if (inside && !IsInside(static_cast<Feature>(i))) continue;
    sum.retracted += counts[i].retracted;
    sum.not_retracted += counts[i].not_retracted;
  }
  return sum;
}

// Calls visit(block, from, to) for the links inside a layer that have no marks in them.
template <typename Visit>
void ForEachTravel(const GcodeFile& file, const Layer& layer, Visit visit) {
  for (uint32_t b = layer.first_block + 1; b < layer.end_block; ++b) {
    const Block& block = file.blocks[b];
    if (IsBoundary(block)) continue;
    const MachineState& mode = file.modes[block.mode];
    visit(block, mode.InMm(file.blocks[b - 1].last), mode.InMm(block.first), b);
  }
}

void Count(const GcodeFile& file, const Layer& layer, const std::vector<Outline>& outlines,
           const VisibleWalls& walls, double threshold_mm, RetractionCounts& counts) {
  ForEachTravel(file, layer, [&](const Block& block, Point from, Point to, uint32_t b) {
    if (Distance(from, to) < threshold_mm || walls.Crossed(from, to)) return;
    const Feature feature = outlines[b - layer.first_block].feature;
    RetractionCount& count = counts[static_cast<size_t>(feature)];
    ++((block.link & kLinkRetracts) != 0 ? count.retracted : count.not_retracted);
  });
}

// By how much new unretracted travel may exceed the file's longest: less than the verifier
// allows.
constexpr double kLongestOpenFactor = 1.9;
constexpr double kLongestOpenSlackMm = 0.95;

double LongestOpenMm(const GcodeFile& file) {
  double longest = 0;
  for (const Layer& layer : file.layers) {
    ForEachTravel(file, layer, [&](const Block& block, Point, Point, uint32_t) {
      if ((block.link & kLinkRetracts) != 0) return;
      longest = std::max(longest, static_cast<double>(block.travel_mm));
    });
  }
  return kLongestOpenFactor * longest + kLongestOpenSlackMm;
}

// Whether any travel of the part, be it to a layer, goes without a retraction.
bool TravelsOpen(const GcodeFile& file) {
  for (uint32_t b = 1; b < file.blocks.size(); ++b) {
    const Block& block = file.blocks[b];
    const bool open = (block.link & kLinkRetracts) == 0 && block.travel_mm > 0;
    if (open && LeadsWithinPart(file, b)) return true;
  }
  return false;
}

// A shorter move is none.
constexpr double kShortestTravelMm = 0.001;

// The usual setting of slicers.
constexpr double kUsualThresholdMm = 1.5;

// Straight unretracted moves across walls that show the shortest retracted is no accident.
constexpr int64_t kEnough = 3;

// Its travel is longer than a straight line of that length.
bool IsBent(const Block& block, double straight_mm) {
  return static_cast<double>(block.travel_mm) > straight_mm * 1.01 + 0.01;
}

double LearnThreshold(const GcodeFile& file, const std::vector<size_t>& sample) {
  if (file.profile.retract_before_travel) return *file.profile.retract_before_travel;
  double shortest = 1e9;
  for (const Layer& layer : file.layers) {
    ForEachTravel(file, layer, [&](const Block& block, Point from, Point to, uint32_t) {
      if ((block.link & kLinkRetracts) != 0) shortest = std::min(shortest, Distance(from, to));
    });
  }
  if (shortest <= kUsualThresholdMm || shortest >= 1e9) return std::min(shortest, 1e6);
  int64_t crossing = 0;
  for (const size_t i : sample) {
    const VisibleWalls walls(OutlinesOf(file, file.layers[i]));
    ForEachTravel(file, file.layers[i], [&](const Block& block, Point from, Point to, uint32_t) {
      const double length = Distance(from, to);
      if ((block.link & kLinkRetracts) == 0 && !IsBent(block, length) &&
          length > kUsualThresholdMm && length < shortest && walls.Crossed(from, to)) {
        ++crossing;
      }
    });
  }
  return crossing >= kEnough ? shortest : kUsualThresholdMm;
}

std::vector<size_t> SampledLayers(const GcodeFile& file) {
  std::vector<size_t> sample;
  const size_t step = std::max<size_t>(1, file.layers.size() / kSampledLayers);
  for (size_t i = 0; i < file.layers.size(); i += step) sample.push_back(i);
  return sample;
}

// By the slicer's setting if the file has it; else if a good part of the travel that would cross a
// visible wall has bends. Wipes and inward moves look like bends, but CuraEngine makes neither.
bool AvoidsWalls(const GcodeFile& file) {
  if (file.profile.avoid_crossing) return *file.profile.avoid_crossing;
  if (!file.slicer.combs) return false;
  int64_t crossing = 0;
  int64_t bent = 0;
  for (const size_t i : SampledLayers(file)) {
    const VisibleWalls walls(OutlinesOf(file, file.layers[i]));
    ForEachTravel(file, file.layers[i], [&](const Block& block, Point from, Point to, uint32_t) {
      if (!walls.Crossed(from, to)) return;
      ++crossing;
      if (IsBent(block, Distance(from, to))) ++bent;
    });
  }
  return bent >= kEnough && bent * 4 >= crossing;
}

// How far hidden moves keep from the middle of visible walls: a little more than they must
// (hidden/layer_cover.h), as bends are rounded.
double BesideWallsMm(const std::vector<Outline>& outlines) {
  constexpr double kMoreThanHalfMm = 0.15;
  double widest = 0;
  for (const Outline& outline : outlines) {
    if (IsVisibleWall(outline.feature)) widest = std::max(widest, outline.width_mm);
  }
  return std::max(widest / 2 + kMoreThanHalfMm, Detours::kBesideMm);
}

}  // namespace

RetractionHabit LearnRetraction(const GcodeFile& file) {
  RetractionHabit habit;
  habit.avoids_walls = AvoidsWalls(file);
  for (const Block& block : file.blocks) {
    habit.retracts = habit.retracts || (!IsBoundary(block) && (block.link & kLinkRetracts) != 0);
  }
  if (!habit.retracts) return habit;
  const std::vector<size_t> sample = SampledLayers(file);
  habit.threshold_mm = TravelsOpen(file) ? LearnThreshold(file, sample) : kShortestTravelMm;
  habit.longest_open_mm = LongestOpenMm(file);
  for (const size_t i : sample) {
    const std::vector<Outline> outlines = OutlinesOf(file, file.layers[i]);
    Count(file, file.layers[i], outlines, VisibleWalls(outlines), habit.threshold_mm, habit.inside);
  }
  habit.all_inside = SumOf(habit.inside, /*inside=*/true);
  const RetractionCount all = SumOf(habit.inside, /*inside=*/false);
  habit.crossing_matters = all.not_retracted * 10 >= all.total() && all.not_retracted > 0;
  return habit;
}

RetractionHabit HabitOfNewTravels(const GcodeFile& file, const Allowance& allow, int threads,
                                  std::shared_ptr<const HiddenMoves> hidden) {
  RetractionHabit habit = LearnRetraction(file);
  habit.spares_walls = true;
  habit.drops_wipes = allow.wipes;
  if (habit.retracts && allow.hidden_retractions && allow.max_hidden_travel_mm > 0) {
    const bool known = hidden != nullptr && hidden->longest_mm() == allow.max_hidden_travel_mm;
    habit.hidden =
        known ? std::move(hidden)
              : std::make_shared<const HiddenMoves>(file, allow.max_hidden_travel_mm, threads);
    habit.inner_detours = allow.inner_detours;
  }
  return habit;
}

TravelRules::TravelRules(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
                         const std::vector<Outline>& outlines, const VisibleWalls& walls)
    : habit_(habit),
      walls_(walls),
      layer_(static_cast<size_t>(&layer - file.layers.data())),
      detours_(habit.avoids_walls ? std::optional<Detours>(std::in_place, walls) : std::nullopt),
      within_(habit.hidden != nullptr && habit.inner_detours
                  ? std::optional<Detours>(std::in_place, walls, BesideWallsMm(outlines))
                  : std::nullopt) {
  if (habit.crossing_matters) {
    Count(file, layer, outlines, walls, habit.threshold_mm, inside_);
    all_inside_ = SumOf(inside_, /*inside=*/true);
  }
}

// Where the file has no travel to such paths that is long enough, it goes by that to others: a
// slicer that does not retract inside an island does so whatever follows.
const RetractionCount& TravelRules::CountOf(Feature feature) const {
  const RetractionCount& here = inside_[static_cast<size_t>(feature)];
  const RetractionCount& everywhere = habit_.inside[static_cast<size_t>(feature)];
  if (here.total() >= kEnough) return here;
  if (everywhere.total() > 0 || !IsInside(feature)) return everywhere;
  return all_inside_.total() >= kEnough ? all_inside_ : habit_.all_inside;
}

bool TravelRules::AlwaysRetracts(Feature feature) const {
  assert(habit_.crossing_matters);
  const RetractionCount& count = CountOf(feature);
  return count.total() > 0 && count.Mostly();
}

bool TravelRules::Hides(Point a, Point b, Feature feature) const {
  const Point ends[] = {a, b};
  return Hides(ends, feature);
}

bool TravelRules::Hides(absl::Span<const Point> line, Feature feature) const {
  assert(line.size() >= 2);
  if (habit_.hidden == nullptr || IsVisibleWall(feature)) return false;
  for (size_t i = 1; i < line.size(); ++i) {
    if (walls_.Crossed(line[i - 1], line[i])) return false;
    const bool leaves_wall = i == 1 && walls_.IsOnOne(line[0]);
    if (!habit_.hidden->Hides(layer_, line[i - 1], line[i], leaves_wall)) return false;
  }
  return LengthMm(line) <= habit_.hidden->longest_mm();
}

std::vector<Point> TravelRules::HiddenBends(Point a, Point b, Feature feature) const {
  if (!within_ || IsVisibleWall(feature) || Distance(a, b) > habit_.hidden->longest_mm()) return {};
  if (!habit_.hidden->Hides(layer_, b, b, /*leaves_wall=*/false)) return {};
  std::vector<Point> line = within_->Around(a, b);
  if (line.empty()) return {};
  line.insert(line.begin(), a);
  line.push_back(b);
  if (!Hides(line, feature)) return {};
  return {line.begin() + 1, line.end() - 1};
}

PlannedTravel TravelRules::TravelOf(Point a, Point b, Feature feature) const {
  PlannedTravel travel;
  travel.from = a;
  travel.to = b;
  travel.crosses = walls_.Crossed(a, b);
  absl::InlinedVector<Point, 2> line = {a, b};
  if (travel.crosses && detours_) {
    travel.via = detours_->Around(a, b);
    travel.crosses = travel.via.empty();
    line.insert(line.end() - 1, travel.via.begin(), travel.via.end());
  }
  travel.mm = LengthMm(line);
  if (!habit_.retracts) return travel;
  const bool far = Distance(a, b) >= habit_.threshold_mm;
  travel.retracts = far && (!habit_.crossing_matters || CountOf(feature).Mostly());
  travel.retracts = travel.retracts || ((far || habit_.spares_walls) && travel.crosses) ||
                    (far && travel.mm > habit_.longest_open_mm);
  travel.retracts = travel.retracts || (!travel.crosses && walls_.Touched(line));
  return travel;
}

}  // namespace traverse::gcode
