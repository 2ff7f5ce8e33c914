#include "client/gcode/gcode_job.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/gcode/barriers.h"
#include "client/gcode/choose/rows/island_rests.h"
#include "client/gcode/link/link_looks.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/part_links.h"
#include "client/gcode/parallel.h"
#include "client/gcode/plan/layer_plan.h"
#include "client/gcode/plan/travel_model.h"
#include "client/gcode/plan/travel_rules.h"
#include "client/gcode/read/least_layer_time.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/stated_progress.h"
#include "client/input/input_job.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {
namespace gcode {
namespace {

// Paths and extruded length by feature, and what may move.
struct Census {
  std::array<int64_t, static_cast<size_t>(Feature::kCount)> paths{};
  std::array<double, static_cast<size_t>(Feature::kCount)> printed_mm{};
  int64_t movable = 0;
};

// Longer than any travel.
constexpr double kNeverMm = 1e7;

// The service knows no longer moves.
constexpr double kMostKnownSeconds = 1e7;

void SetCost(const TravelModel& model, const RetractionHabit& habit, v1::CostModel& cost) {
  v1::TimeCost& time = *cost.mutable_time();
  // The service has limits; a file may state anything.
  time.set_speed_mm_s(std::clamp(model.speed_mm_s, 0.001, 1e5));
  if (model.accel_mm_s2 > 0) time.set_accel_mm_s2(std::clamp(model.accel_mm_s2, 0.001, 1e7));
  time.set_retraction_seconds(std::clamp(model.retraction_price, 0.0, 1e4));
  time.set_retraction_threshold_mm(std::clamp(habit.threshold_mm, 0.0, kNeverMm));
}

// The rules by which travel is written (travel_rules.h), so that the search knows the cost of each.
void SetWallCost(const RetractionHabit& habit, Crossings crossings, v1::TimeCost& time) {
  time.set_crossing_seconds(crossings == Crossings::kAny ? 0 : kKeepCrossingSeconds);
  time.set_wall_slack_mm(VisibleWalls::kEndSlackMm);
  if (habit.avoids_walls) time.set_wall_clearance_mm(Detours::kBesideMm);
  time.set_exposed_retraction_threshold_mm(std::min(habit.threshold_mm, kNeverMm));
  time.set_wall_retraction_threshold_mm(0);
  if (habit.crossing_matters) {
    time.set_retraction_threshold_mm(
        std::min(std::max(habit.longest_open_mm, habit.threshold_mm), kNeverMm));
  }
  if (habit.hidden) {
    const double longest = std::max(time.retraction_threshold_mm(), habit.hidden->longest_mm());
    time.set_retraction_threshold_mm(std::min(longest, kNeverMm));
  }
}

// If retraction depends on length, it is sent as one of exposed paths, and all paths are exposed:
// only for these does travel after a wiped path pay less.
void SetWiped(const GcodeFile& file, const Layer& of_file, const RetractionHabit& habit,
              v1::Layer& layer) {
  if (habit.drops_wipes || habit.hidden) return;
  for (uint32_t b = of_file.first_block; b < of_file.end_block; ++b) {
    if (file.WipedBehind(b)) layer.add_retracted_paths(b - of_file.first_block);
  }
  if (layer.retracted_paths().empty() || habit.crossing_matters) return;
  layer.mutable_cost()->mutable_time()->set_retraction_threshold_mm(kNeverMm);
  for (uint32_t b = of_file.first_block; b < of_file.end_block; ++b) {
    layer.add_exposed_paths(b - of_file.first_block);
  }
}

void SetWalls(const TravelRules& rules, const RetractionHabit& habit,
              const std::vector<Outline>& outlines, v1::Layer& layer) {
  for (uint32_t path = 0; path < outlines.size(); ++path) {
    const Outline& outline = outlines[path];
    const auto seen = [&](Point at) { return !rules.Hides(at, at, outline.feature); };
    // Those to and from where nothing is hidden, and visible walls, if all others do not retract.
    const bool exposed = habit.crossing_matters ? rules.AlwaysRetracts(outline.feature)
                                                : habit.hidden && (seen(outline.points.front()) ||
                                                                   seen(outline.points.back()));
    if (exposed) layer.add_exposed_paths(path);
  }
  for (const Wall& visible : VisibleWallsOf(outlines)) {
    v1::Wall& wall = *layer.add_walls();
    wall.set_path(static_cast<uint32_t>(visible.path));
    wall.set_closed(visible.closed);
    for (const Point& point : visible.points) {
      wall.add_points(point.x);
      wall.add_points(point.y);
    }
  }
}

// The file's travel between two paths stays as it is where an order has it: some has bends, and
// some has no retraction where new travel would have one.
void SetKnownMoves(const GcodeFile& file, const Layer& of_file, const RetractionHabit& habit,
                   const TravelModel& travel, const TravelRules& rules,
                   const std::vector<Outline>& outlines, const VisibleWalls& walls,
                   v1::Layer& layer) {
  const bool wiped_stays = !habit.drops_wipes && !habit.hidden;
  for (uint32_t b = of_file.first_block + 1; b < of_file.end_block; ++b) {
    const Block& before = file.blocks[b - 1];
    const Block& block = file.blocks[b];
    const Point from = file.modes[before.mode].InMm(before.last);
    const Point to = file.modes[block.mode].InMm(block.first);
    const Feature feature = outlines[b - of_file.first_block].feature;
    const PlannedTravel planned_travel = rules.TravelOf(from, to, feature);
    // New travel does not include wipes either; nor what the head does at a boundary, which it does
    // in any order.
    const bool boundary = IsBoundary(block);
    const bool plain = (block.link & kLinkWipes) == 0 && !boundary;
    double seconds = plain ? TravelSeconds(file, b, travel)
                           : NewTravelSeconds(file, b - 1, planned_travel, travel);
    // A retraction because of a wipe has the price of new travel, which begins with it too.
    const bool wiped_before = wiped_stays && file.WipedBehind(b - 1);
    const bool wiped_behind = wiped_stays && file.WipedBehind(b);
    const double wiped = (wiped_before ? 0.5 : 0) + (wiped_behind ? 0.5 : 0);
    const bool retracts =
        (block.link & kLinkRetracts) != 0 && (boundary || !rules.Hides(from, to, feature));
    const bool pays = wiped_before ? planned_travel.retracts : retracts;
    if (pays) seconds += layer.cost().time().retraction_seconds() * (1 - wiped);
    v1::KnownMove& move = *layer.add_known_moves();
    move.set_from(b - 1 - of_file.first_block);
    move.set_to(b - of_file.first_block);
    move.set_seconds(std::min(kMostKnownSeconds, seconds));
    move.set_crosses(boundary ? planned_travel.crosses : MeasureLink(file, b, walls).crossings > 0);
    move.set_retracts(retracts);
  }
}

// If each prime pushes more or less than was retracted, the number of retractions in a layer is
// part of what is printed, and hardly any order found has it. Looks at a few layers, whether any
// does so.
bool KeepsRetractions(const GcodeFile& file) {
  constexpr size_t kLayers = 3;
  for (size_t i = 1; i <= kLayers; ++i) {
    const Layer& layer = file.layers[file.layers.size() * i / (kLayers + 1)];
    const Block& first = file.blocks[layer.first_block];
    const PartStart start{StateAt(file, first), file.states[first.state_in]};
    if (Measure(file, file.PathsText(layer), start).PushesExtra()) return true;
  }
  return false;
}

// What holds for all layers of a file.
struct FileHabits {
  RetractionHabit retraction;
  std::vector<TravelModel> travel;  // [layer]
  bool keeps_retractions = false;   // each layer has as many as before
};

// Fills layer `index` of `job`, which has room for it.
void FillLayer(const GcodeFile& file, size_t index, const FileHabits& habits,
               const GcodeOptions& options, InputJob& job, Census& census) {
  const Layer& layer = file.layers[index];
  LayerPlan planned = MakeLayerPlan(file, layer, options.policy, options.allow);
  v1::Layer& filled = job.layers[index];
  filled.set_id(index + 1);
  filled.set_z_mm(file.HeightMm(layer));
  *filled.mutable_plan() = std::move(planned.plan);
  SetCost(habits.travel[index], habits.retraction, *filled.mutable_cost());
  // Fewer than the file has cannot be had.
  if (habits.keeps_retractions) filled.mutable_cost()->mutable_time()->set_retraction_seconds(0);
  SetWallCost(habits.retraction, options.crossings, *filled.mutable_cost()->mutable_time());
  const VisibleWalls walls(planned.outlines);
  const TravelRules rules(file, layer, habits.retraction, planned.outlines, walls);
  SetWalls(rules, habits.retraction, planned.outlines, filled);
  SetWiped(file, layer, habits.retraction, filled);
  SetKnownMoves(file, layer, habits.retraction, habits.travel[index], rules, planned.outlines,
                walls, filled);
  PathNotes& notes = job.notes[index];
  for (size_t path = 0; path < planned.outlines.size(); ++path) {
    const auto feature = static_cast<size_t>(planned.outlines[path].feature);
    notes.feature.push_back(static_cast<uint16_t>(feature));
    notes.island.push_back(planned.freedom.island[path] + 1);
    ++census.paths[feature];
    census.printed_mm[feature] +=
        static_cast<double>(file.blocks[layer.first_block + path].length_mm);
  }
  census.movable = planned.movable;
}

// All layers of `job`, and what they add up to.
Census FillLayers(const GcodeFile& file, const GcodeOptions& options, const FileHabits& habits,
                  InputJob& job) {
  std::vector<Census> parts(file.layers.size());
  job.layers.resize(file.layers.size());
  job.notes.resize(file.layers.size());
  const auto fill = [&](size_t i) { FillLayer(file, i, habits, options, job, parts[i]); };
  ParallelFor(parts.size(), ThreadsFor(file.text.size()), fill, file.limit);
  Census all;
  for (const Census& part : parts) {
    for (size_t i = 0; i < all.paths.size(); ++i) {
      all.paths[i] += part.paths[i];
      all.printed_mm[i] += part.printed_mm[i];
    }
    all.movable += part.movable;
  }
  return all;
}

// The search of `auto` ends after so many rounds without a gain for each path: short files are
// searched as long as it pays, long ones as others are. And it ends where a round saves less than
// so much printing, or has saved less than 12 times that on the average, for of that about half is
// also found when the orders are improved as they are written: by then a second of computing saves
// more than two of printing (30 files, with 40 instead of 66 microseconds: 23 s more in 10 s more).
// What is done in any case is shared by the layers.
void SetStrategy(const GcodeFile& file, v1::Strategy& strategy) {
  constexpr double kRounds = 20000;
  constexpr double kMaxEffort = 10;
  constexpr double kSecondsPerRound = 66e-6;
  constexpr double kFreeRounds = 2500;
  constexpr double kLeastFreeRounds = 50;
  const double effort =
      std::clamp(kRounds / static_cast<double>(file.blocks.size()), 1.0, kMaxEffort);
  const double free = kFreeRounds / static_cast<double>(file.layers.size());
  strategy.set_name("auto");
  google::protobuf::Map<std::string, std::string>& options = *strategy.mutable_options();
  // A bound may take as long as the search, and the print gains nothing by it.
  options["bound"] = "false";
  options["effort"] = absl::StrFormat("%.3g", effort);
  options["least_gain_each"] = absl::StrFormat("%.3g", kSecondsPerRound);
  options["gain_window"] = absl::StrFormat("%.0f", std::max(free, kLeastFreeRounds));
}

std::string Duration(double seconds) {
  const auto whole = static_cast<int64_t>(seconds + 0.5);
  if (whole < 3600) return absl::StrFormat("%d min %02d s", whole / 60, whole % 60);
  return absl::StrFormat("%d h %02d min", whole / 3600, whole % 3600 / 60);
}

void AddFacts(const GcodeFile& file, const Census& census, Policy policy, InputJob& job) {
  const auto add = [&job](std::string key, std::string value) {
    job.facts.emplace_back(std::move(key), std::move(value));
  };
  add("slicer", file.slicer.name.empty() ? "unknown" : file.slicer.name);
  for (size_t i = 0; i < census.paths.size(); ++i) {
    if (census.paths[i] == 0) continue;
    add(std::string(FeatureName(static_cast<Feature>(i))),
        absl::StrFormat("%d paths, %.2f m", census.paths[i], census.printed_mm[i] / 1000));
  }
  add("movable under " + std::string(PolicyName(policy)),
      absl::StrFormat("%d of %d paths", census.movable, file.blocks.size()));
}

}  // namespace
}  // namespace gcode

InputJob MakeGcodeJob(std::shared_ptr<const GcodeFile> file, const GcodeOptions& options) {
  InputJob job;
  job.name = file->name;
  job.format = InputFormat::kGcode;
  for (size_t i = 0; i < static_cast<size_t>(gcode::Feature::kCount); ++i) {
    job.features.emplace_back(gcode::FeatureName(static_cast<gcode::Feature>(i)));
  }
  const gcode::Allowance allow = gcode::AllowedUnder(options.policy, options.allow);
  gcode::FileHabits habits;
  const int threads = gcode::ThreadsFor(file->text.size());
  habits.retraction = gcode::HabitOfNewTravels(*file, allow, threads);
  habits.travel = gcode::LearnTravel(*file, threads);
  habits.keeps_retractions = gcode::KeepsRetractions(*file);
  if (habits.keeps_retractions) habits.retraction.hidden = nullptr;
  const gcode::Census census = gcode::FillLayers(*file, options, habits, job);
  // The first path is pinned; the travel to it from the start script is not ours.
  const gcode::Outline first = gcode::OutlineOf(*file, file->blocks.front());
  job.options.mutable_start()->set_x_mm(first.points.front().x);
  job.options.mutable_start()->set_y_mm(first.points.front().y);
  gcode::SetCost(habits.travel.back(), habits.retraction, *job.options.mutable_cost());
  gcode::SetStrategy(*file, *job.options.mutable_strategy());
  job.options.set_idle_speed_mm_s(std::clamp(habits.travel.back().speed_mm_s, 0.001, 1e5));
  gcode::AddFacts(*file, census, options.policy, job);
  job.gcode = std::move(file);
  job.hidden = habits.retraction.hidden;
  return job;
}

absl::StatusOr<gcode::PrintTotals> AddMeasuredFacts(InputJob& job, const GcodeOptions& options) {
  const auto add = [&job](std::string key, std::string value) {
    job.facts.emplace_back(std::move(key), std::move(value));
  };
  const int threads = gcode::ThreadsFor(job.gcode->text.size());
  const gcode::PrintTotals totals = gcode::Sum(gcode::MeasureLayers(*job.gcode, threads));
  add("extruded", absl::StrFormat("%.2f m", totals.extruded_mm / 1000));
  add("travel", absl::StrFormat("%.2f m", totals.travel_mm / 1000));
  const gcode::RetractionHabit looks =
      gcode::HabitOfLooks(*job.gcode, options.allow.max_hidden_travel_mm, threads, job.hidden);
  const gcode::HiddenCounts hidden = gcode::CountHiddenRetractions(*job.gcode, looks, threads);
  add("retractions",
      absl::StrFormat("%d, %d of them for travel that nobody would see", totals.retractions,
                      std::accumulate(hidden.begin(), hidden.end(), int64_t{0})));
  add("visible walls crossed", absl::StrFormat("%d times, %d of them without a retraction",
                                               totals.crossings, totals.open_crossings));
  add("estimated print time",
      gcode::Duration(totals.seconds) + " (trapezoidal speeds with look-ahead, without heating)");
  for (std::string& odd : DescribeOddLines(*job.gcode)) add("held", std::move(odd));
  for (std::string& barrier : DescribeBarriers(*job.gcode, options.policy, options.allow)) {
    add("held", std::move(barrier));
  }
  for (std::string& fault : DescribeProgressFaults(*job.gcode)) add("progress", std::move(fault));
  if (const auto rest = gcode::LeastRestOf(*job.gcode, threads)) {
    add("least rest of an island",
        absl::StrFormat("%.1f s before layer %d; least layer time %.4g s", rest->seconds,
                        rest->layer + 1, gcode::LeastLayerSeconds(job.gcode->text)));
  }
  if (absl::Status status = job.gcode->limit.status(); !status.ok()) return status;
  return totals;
}

gcode::LayerOrder OrderOf(const GcodeFile& file, size_t layer, const v1::LayerResult& answer) {
  assert(static_cast<uint32_t>(answer.visits_size()) ==
         file.layers[layer].end_block - file.layers[layer].first_block);
  gcode::LayerOrder order;
  order.reserve(static_cast<size_t>(answer.visits_size()));
  for (const v1::Visit& visit : answer.visits()) {
    const bool closed = visit.has_vertex();
    const uint32_t entry = closed ? visit.vertex() : visit.reversed() ? 1 : 0;
    order.push_back({file.layers[layer].first_block + visit.plan_path(), entry, closed});
  }
  return order;
}

absl::StatusOr<InputJob> ReadGcodeJob(std::string text, const std::string& name,
                                      const GcodeOptions& options) {
  absl::StatusOr<std::shared_ptr<GcodeFile>> file = ReadGcode(std::move(text), name, options.limit);
  if (!file.ok()) return file.status();
  if (options.machine) gcode::ApplyLimits(*options.machine, (*file)->profile);
  InputJob job = MakeGcodeJob(*std::move(file), options);
  if (absl::Status status = options.limit.status(); !status.ok()) return status;
  return job;
}

}  // namespace traverse
