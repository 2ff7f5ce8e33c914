#include "client/report/json.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <map>
#include <optional>

#include "absl/strings/str_format.h"
#include "client/api/job_result.h"
#include "client/files/json.h"
#include "client/gtsp/tour.h"

namespace traverse::report {
namespace {

Json PointJson(const google::protobuf::RepeatedField<double>& points, int point) {
  return JsonArray{points[2 * point], points[2 * point + 1]};
}

// The path's label, entry and place, for all kinds of layers.
JsonObject EntryJson(const v1::Contour& contour, const v1::Visit& visit) {
  return {{"id", contour.id()},
          {"entry", visit.vertex()},
          {"at", PointJson(contour.points(), static_cast<int>(visit.vertex()))}};
}
JsonObject EntryJson(const v1::OpenPath& path, const v1::Visit& visit) {
  const int last = path.points_size() / 2 - 1;
  return {{"id", path.id()},
          {"reversed", visit.reversed()},
          {"from", PointJson(path.points(), visit.reversed() ? last : 0)},
          {"to", PointJson(path.points(), visit.reversed() ? 0 : last)}};
}

Json IslandVisitJson(const v1::Layer& layer, const v1::Visit& visit) {
  const v1::Island& island = layer.islands(static_cast<int>(visit.island()));
  const bool contour = visit.path_case() == v1::Visit::kContour;
  Json out = JsonObject{{"kind", contour ? "contour" : "raster"}, {"island", island.id()}};
  out.Append(contour ? EntryJson(island.contours(static_cast<int>(visit.contour())), visit)
                     : EntryJson(island.rasters(static_cast<int>(visit.raster())), visit));
  return out;
}

Json PlanVisitJson(const v1::Layer& layer, const PathNotes* notes, const v1::Visit& visit) {
  const v1::PlanPath& path = layer.plan().paths(static_cast<int>(visit.plan_path()));
  Json out = JsonObject{{"kind", path.has_contour() ? "contour" : "raster"}};
  if (notes != nullptr && visit.plan_path() < notes->island.size()) {
    out["island"] = notes->island[visit.plan_path()];
  }
  out.Append(path.has_contour() ? EntryJson(path.contour(), visit)
                                : EntryJson(path.open_path(), visit));
  out["path"] = visit.plan_path();
  return out;
}

bool CostIsTime(const InputJob& job, const v1::Layer& layer) {
  return (layer.has_cost() ? layer.cost() : job.options.cost()).has_time();
}

// The bound of a layer in mm, if it is known and the cost is length.
std::optional<double> BoundOf(const InputJob& job, const v1::Layer& layer,
                              const v1::LayerResult& result) {
  if (CostIsTime(job, layer) || !result.has_lower_bound()) return std::nullopt;
  return result.lower_bound();
}

// What is paid where the cost is time, of a layer's result or of a job's summary.
template <typename Result>
JsonObject TimeJson(const Result& result) {
  return {{"cost_given_seconds", result.cost_given()},
          {"cost_seconds", result.cost()},
          {"lower_bound_seconds", result.has_lower_bound() ? Json(result.lower_bound()) : Json()},
          {"crossings_given", result.crossings_given()},
          {"crossings", result.crossings()},
          {"retractions_given", result.retractions_given()},
          {"retractions", result.retractions()}};
}

// The travel moves that lead around walls, each with the number of the visit that it leads to.
Json DetoursJson(const v1::LayerResult& result) {
  JsonArray detours;
  for (const v1::Detour& detour : result.detours()) {
    detours.push_back(
        JsonObject{{"visit", detour.visit()},
                   {"points", JsonArray(detour.points().begin(), detour.points().end())}});
  }
  return detours;
}

Json LayerJson(const InputJob& job, size_t i, const v1::LayerResult& result) {
  const v1::Layer& layer = job.layers[i];
  assert(CheckVisits(layer, result).ok());
  const PathNotes* notes = i < job.notes.size() ? &job.notes[i] : nullptr;
  JsonArray route;
  for (const v1::Visit& visit : result.visits()) {
    route.push_back(layer.has_plan() ? PlanVisitJson(layer, notes, visit)
                                     : IslandVisitJson(layer, visit));
  }
  Json out = JsonObject{{"id", layer.id()},
                        {"start", JsonArray{result.start().x_mm(), result.start().y_mm()}},
                        {"travel_given_mm", result.given().total_mm()},
                        {"travel_mm", result.travel().total_mm()},
                        {"lower_bound_mm", JsonOrNull(BoundOf(job, layer, result))}};
  if (CostIsTime(job, layer)) out.Append(TimeJson(result));
  out.Append({{"stop", StopName(result.stop_reason())}, {"solve_seconds", result.solve_seconds()}});
  // The statistics of the search, if it has any; sorted, because a proto map has no order.
  JsonObject statistics;
  for (const auto& [name, value] :
       std::map<std::string, double>(result.statistics().begin(), result.statistics().end())) {
    statistics.push_back({name, value});
  }
  if (!statistics.empty()) out["statistics"] = std::move(statistics);
  out["route"] = std::move(route);
  if (result.detours_size() > 0) out["detours"] = DetoursJson(result);
  return out;
}

// The sum of the layers' bounds; null if one is null.
Json TotalBoundJson(const InputJob& job, const JobResult& result) {
  double sum = 0;
  for (size_t i = 0; i < job.layers.size(); ++i) {
    const std::optional<double> bound = BoundOf(job, job.layers[i], result.layers[i]);
    if (!bound) return nullptr;
    sum += *bound;
  }
  return sum;
}

// The layers whose cost is time, of those that the job has.
size_t LayersOfTime(const InputJob& job) {
  return static_cast<size_t>(
      std::count_if(job.layers.begin(), job.layers.end(),
                    [&](const v1::Layer& layer) { return CostIsTime(job, layer); }));
}

Json TotalJson(const InputJob& job, const JobResult& result, double wall_seconds) {
  const v1::JobSummary& summary = result.summary;
  Json total =
      JsonObject{{"travel_given_mm", summary.given().total_mm() + summary.cleaning_given_mm()},
                 {"travel_mm", summary.travel().total_mm() + summary.cleaning_mm()},
                 {"cleaning_mm", summary.cleaning_mm()},
                 {"lower_bound_mm", TotalBoundJson(job, result)},
                 {"solve_seconds", summary.compute_seconds()},
                 {"wall_seconds", wall_seconds},
                 {"idle_seconds_given", summary.idle_seconds_given()},
                 {"idle_seconds", summary.idle_seconds()}};
  const size_t of_time = LayersOfTime(job);
  if (of_time == job.layers.size() && of_time > 0) total.Append(TimeJson(summary));
  if (summary.has_chain_lower_bound() && (of_time == 0 || of_time == job.layers.size())) {
    total[of_time == 0 ? "chain_lower_bound_mm" : "chain_lower_bound_seconds"] =
        summary.chain_lower_bound();
  }
  return total;
}

// A new file is what counts, not what the search knew of it: what its line of the summary and
// `inspect` state. No bound is known of what is paid for it.
void StateAsWritten(const GcodeRewrite& rewrite, Json& total) {
  for (const JsonMember& written :
       JsonObject{{"travel_given_mm", rewrite.before.travel_mm},
                  {"travel_mm", rewrite.after.travel_mm},
                  {"cost_given_seconds", rewrite.forecast.given_seconds},
                  {"cost_seconds", rewrite.forecast.seconds},
                  {"lower_bound_seconds", nullptr},
                  {"crossings_given", rewrite.before.crossings},
                  {"crossings", rewrite.after.crossings},
                  {"retractions_given", rewrite.before.retractions},
                  {"retractions", rewrite.after.retractions}}) {
    total[written.name] = written.value;
  }
}

Json GcodeTotalsJson(const gcode::PrintTotals& totals) {
  return JsonObject{{"travel_mm", totals.travel_mm},           {"extruded_mm", totals.extruded_mm},
                    {"retractions", totals.retractions},       {"crossings", totals.crossings},
                    {"open_crossings", totals.open_crossings}, {"print_seconds", totals.seconds}};
}

// Null if no island rests.
Json RestJson(const gcode::RestTotals& rest) {
  if (!rest.given || !rest.chosen) return nullptr;
  return JsonObject{{"enough_seconds", rest.required_seconds},
                    {"least_given_seconds", rest.given->seconds},
                    {"least_seconds", rest.chosen->seconds}};
}

Json RewriteJson(const GcodeRewrite& rewrite) {
  return JsonObject{{"layers_changed", rewrite.layers_changed},
                    {"island_rest", RestJson(rewrite.rest)},
                    {"found_given_seconds", rewrite.forecast.given_seconds},
                    {"found_seconds", rewrite.forecast.seconds},
                    {"given", GcodeTotalsJson(rewrite.before)},
                    {"written", GcodeTotalsJson(rewrite.after)}};
}

// Point numbers as in the file, from 1.
Json TourJson(const gtsp::Instance& instance, const JobResult& result) {
  const gtsp::Tour tour = gtsp::BestTour(instance, result.layers);
  JsonArray points;
  for (const uint32_t point : tour.points) points.push_back(uint64_t{point} + 1);
  return JsonObject{{"rounded_length", tour.rounded_length}, {"points", std::move(points)}};
}

}  // namespace

std::string StopName(v1::StopReason reason) {
  const std::string prefix = "STOP_REASON_";
  const std::string name = v1::StopReason_Name(reason);
  return name.starts_with(prefix) ? name.substr(prefix.size()) : name;
}

std::string RoutesJson(const InputJob& job, const JobRun& run, const GcodeRewrite* rewrite) {
  std::string out =
      absl::StrFormat("{\"input\": %s, \"strategy\": %s, \"seed\": %d,\n", JsonText(job.name),
                      JsonText(run.result.summary.strategy()), run.seed);
  Json total = TotalJson(job, run.result, run.wall_seconds);
  if (rewrite != nullptr) StateAsWritten(*rewrite, total);
  absl::StrAppendFormat(&out, " \"total\": %s,\n", JsonText(total));
  if (rewrite != nullptr) {
    absl::StrAppendFormat(&out, " \"gcode\": %s,\n", JsonText(RewriteJson(*rewrite)));
  }
  if (job.gtsp != nullptr) {
    absl::StrAppendFormat(&out, " \"tour\": %s,\n", JsonText(TourJson(*job.gtsp, run.result)));
  }
  out += " \"layers\": [";
  // Layer by layer: a large job as one tree of values would need many times its text's memory.
  for (size_t i = 0; i < job.layers.size(); ++i) {
    out += i == 0 ? "\n  " : ",\n  ";
    out += JsonText(LayerJson(job, i, run.result.layers[i]));
  }
  out += "\n]}\n";
  return out;
}

std::string CompareJson(const InputJob& job, const std::vector<ComparedStrategy>& strategies) {
  std::string out = absl::StrFormat("{\"input\": %s, \"runs\": [", JsonText(job.name));
  const char* divider = "\n";
  for (const ComparedStrategy& strategy : strategies) {
    for (const JobRun& run : strategy.runs) {
      absl::StrAppendFormat(&out, "%s{\"label\": %s, \"seed\": %d, \"routes\": %s}", divider,
                            JsonText(strategy.label), run.seed, RoutesJson(job, run));
      divider = ",\n";
    }
  }
  return out + "\n]}\n";
}

}  // namespace traverse::report
