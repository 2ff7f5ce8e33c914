#include "client/view/scene/job_scene.h"

#include <cassert>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/api/job_result.h"
#include "client/files/read_file.h"
#include "client/gcode/link/link_looks.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/parallel.h"
#include "client/gcode/read/reader.h"
#include "client/view/scene/drawn_arcs.h"
#include "client/view/scene/layer_paths.h"
#include "client/view/scene/printed_route.h"

namespace traverse::view {
namespace {

DrawnRoute RouteOf(const VisitReader& reader, const v1::LayerResult& result) {
  DrawnRoute route;
  route.start = {result.start().x_mm(), result.start().y_mm()};
  route.visits.reserve(static_cast<size_t>(result.visits_size()));
  for (const v1::Visit& visit : result.visits()) route.visits.push_back(reader.Read(visit));
  return route;
}

// Seconds of `travel_mm` at the speed that the summary uses for idle time.
double IdleSeconds(const v1::JobSummary& summary, double travel_mm) {
  const double all = summary.travel().total_mm() + summary.cleaning_mm();
  return all > 0 ? summary.idle_seconds() * travel_mm / all : 0;
}

// The notes without the figures.
RouteNotes NotesWithoutFigures(const NamedRun& named) {
  const v1::JobSummary& summary = named.run->result.summary;
  RouteNotes notes;
  notes.label = named.label;
  if (summary.has_lower_bound()) {
    notes.gap =
        summary.cost() > 0 ? (summary.cost() - summary.lower_bound()) / summary.cost() : 0.0;
  }
  notes.compute_seconds = named.run->wall_seconds;
  return notes;
}

RouteNotes NotesOf(const NamedRun& named) {
  const JobResult& result = named.run->result;
  const v1::JobSummary& summary = result.summary;
  RouteNotes notes = NotesWithoutFigures(named);
  notes.total = {summary.travel().total_mm() + summary.cleaning_mm(), summary.idle_seconds()};
  for (const v1::LayerResult& layer : result.layers) {
    const double travel = layer.travel().total_mm();
    notes.layers.push_back({travel, IdleSeconds(summary, travel)});
  }
  return notes;
}

Figures FiguresOf(const gcode::PrintTotals& totals, const gcode::HiddenCounts& hidden) {
  return {totals.travel_mm, totals.seconds, totals.retractions, totals.crossings,
          std::accumulate(hidden.begin(), hidden.end(), int64_t{0})};
}

// The figures of the layers of `file` from `first` on.
std::vector<Figures> LayerFigures(const GcodeFile& file, size_t first, size_t count,
                                  const gcode::HiddenCounts& hidden) {
  const std::vector<gcode::PrintTotals> totals =
      gcode::MeasureLayers(file, gcode::DefaultThreads());
  std::vector<Figures> figures;
  for (size_t i = first; i < first + count; ++i) {
    figures.push_back(FiguresOf(totals[i], {hidden[i]}));
  }
  return figures;
}

// [path] The length that each path of a layer extrudes.
std::vector<double> LengthsOf(const GcodeFile& file, size_t layer) {
  std::vector<double> lengths;
  for (uint32_t i = file.layers[layer].first_block; i < file.layers[layer].end_block; ++i) {
    lengths.push_back(static_cast<double>(file.blocks[i].length_mm));
  }
  return lengths;
}

// The visits of an order of layer `layer` of `file`, which is not empty.
std::vector<DrawnVisit> VisitsOf(const GcodeFile& file, size_t layer,
                                 const gcode::LayerOrder& order) {
  std::vector<DrawnVisit> visits;
  for (const gcode::Placement& placement : order) {
    visits.push_back({placement.block - file.layers[layer].first_block, placement.entry, {}});
  }
  return visits;
}

// The name without its folders, because people may pass the report on.
std::string BaseName(const std::string& name) {
  return std::filesystem::path(name).filename().string();
}

// The fields that all scenes of a job share.
Scene EmptyScene(const InputJob& job) {
  Scene scene;
  scene.title = job.name == "-" ? DisplayName(job.name) : BaseName(job.name);
  scene.seconds_name = "idle time";
  scene.moves_note = "Travel moves are straight, as the service counts them.";
  scene.features = FeatureNames(job);
  scene.first_layer = job.first_layer;
  for (const v1::Layer& layer : job.layers) {
    scene.layer_ids.push_back(layer.id());
    scene.layer_z_mm.push_back(layer.z_mm());
  }
  return scene;
}

// The lines that a terminal shows one below the other, as sentences.
std::string Sentences(std::vector<std::string> lines) {
  for (std::string& line : lines) {
    line[0] = absl::ascii_toupper(static_cast<unsigned char>(line[0]));
  }
  return absl::StrCat(absl::StrJoin(lines, ". "), ".");
}

}  // namespace

Scene JobScene(const InputJob& job, const report::JobRun& given,
               const std::vector<NamedRun>& runs) {
  Scene scene = EmptyScene(job);
  std::vector<const report::JobRun*> results = {&given};
  scene.routes.push_back(NotesOf({"as given", &given}));
  for (const NamedRun& named : runs) {
    results.push_back(named.run);
    scene.routes.push_back(NotesOf(named));
  }
  scene.layer = [&job, results = std::move(results)](size_t i) {
    DrawnLayer layer;
    layer.paths = PathsOf(job, i);
    const VisitReader reader(job.layers[i]);
    for (const report::JobRun* run : results) {
      assert(CheckVisits(job.layers[i], run->result.layers[i]).ok());
      layer.routes.push_back(RouteOf(reader, run->result.layers[i]));
    }
    return layer;
  };
  return scene;
}

absl::StatusOr<Scene> GcodeScene(const InputJob& job, const std::string& label,
                                 const report::JobRun& run, const GcodeRewrite& rewrite) {
  Scene scene = EmptyScene(job);
  scene.seconds_name = "print time";
  scene.moves_note = "The moves are those of both files, including wipes.";
  const std::string rest = DescribeRest(rewrite);
  if (!rest.empty()) absl::StrAppend(&scene.moves_note, " Cooling: ", rest, ".");
  const std::vector<std::string> left = DescribeLeft(rewrite);
  if (!left.empty()) absl::StrAppend(&scene.moves_note, " What stays: ", Sentences(left));
  std::shared_ptr<const GcodeFile> printed = job.gcode;
  if (rewrite.layers_changed > 0) {
    absl::StatusOr<std::shared_ptr<GcodeFile>> read = ReadGcode(rewrite.text, job.name);
    if (!read.ok()) return read.status();
    (*read)->profile = job.gcode->profile;  // it may know more of the machine than the text says
    printed = *std::move(read);
  }
  // Both files have the same layers, and so hide the same.
  const auto habit = std::make_shared<const gcode::RetractionHabit>(gcode::HabitOfLooks(
      *job.gcode, job.hidden ? job.hidden->longest_mm() : gcode::kMaxHiddenTravelMm,
      gcode::DefaultThreads(), job.hidden));
  const auto hidden = [&habit](const GcodeFile& file) {
    return gcode::CountHiddenRetractions(file, *habit, gcode::DefaultThreads());
  };
  RouteNotes given;
  given.label = "as given";
  const gcode::HiddenCounts were = hidden(*job.gcode);
  given.total = FiguresOf(rewrite.before, were);
  given.layers = LayerFigures(*job.gcode, job.first_layer, job.layers.size(), were);
  RouteNotes after = NotesWithoutFigures({label, &run});
  // The gap belongs to the routes found; the file may keep some layers' order and bend moves.
  after.gap.reset();
  const gcode::HiddenCounts are = hidden(*printed);
  after.total = FiguresOf(rewrite.after, are);
  after.layers = LayerFigures(*printed, job.first_layer, job.layers.size(), are);
  scene.routes = {std::move(given), std::move(after)};

  scene.layer = [&job, orders = rewrite.orders, printed = std::move(printed), habit](size_t i) {
    DrawnLayer layer;
    layer.paths = PathsOf(job, i);
    const size_t in_file = job.first_layer + i;
    const std::vector<DrawnVisit> sliced = InOrder(layer.paths.size());
    const std::vector<DrawnVisit> written =
        orders[in_file].empty() ? sliced : VisitsOf(*job.gcode, in_file, orders[in_file]);
    const SlicedPaths paths = {layer.paths, LengthsOf(*job.gcode, in_file)};
    layer.routes.push_back(PrintedRoute(*job.gcode, in_file, paths, sliced,
                                        gcode::LooksOfLinks(*job.gcode, in_file, *habit)));
    layer.routes.push_back(PrintedRoute(*printed, in_file, paths, written,
                                        gcode::LooksOfLinks(*printed, in_file, *habit)));
    DrawArcs(*job.gcode, in_file, layer);
    return layer;
  };
  return scene;
}

}  // namespace traverse::view
