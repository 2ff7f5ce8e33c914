#include "client/report/reproduce/outcomes.h"

#include <cstdio>
#include <fstream>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "client/files/json.h"
#include "client/files/read_file.h"

namespace traverse::report {
namespace {

struct Corner {
  double x = 0, y = 0;
};

Corner CornerAt(const google::protobuf::RepeatedField<double>& points, int index) {
  return {points[2 * index], points[2 * index + 1]};
}

// The moves of a layer of islands.
std::vector<DrawnMove> MovesOf(const v1::Layer& layer, const v1::LayerResult& result) {
  std::vector<DrawnMove> moves;
  Corner at{result.start().x_mm(), result.start().y_mm()};
  for (const v1::Visit& visit : result.visits()) {
    const v1::Island& island = layer.islands(static_cast<int>(visit.island()));
    const bool is_contour = visit.path_case() == v1::Visit::kContour;
    Corner enter, exit;
    if (is_contour) {
      const auto& points = island.contours(static_cast<int>(visit.contour())).points();
      enter = exit = CornerAt(points, static_cast<int>(visit.vertex()));
    } else {
      const auto& points = island.rasters(static_cast<int>(visit.raster())).points();
      enter = CornerAt(points, 0);
      exit = CornerAt(points, points.size() / 2 - 1);
      if (visit.reversed()) std::swap(enter, exit);
    }
    moves.push_back({at.x, at.y, enter.x, enter.y, is_contour});
    at = exit;
  }
  return moves;
}

void AddLayer(const v1::LayerResult& layer, bool is_first, RunOutcome& outcome) {
  auto& values = outcome.values;
  const v1::Travel& travel = layer.travel();
  const double crs = travel.rasters_mm() + travel.links_mm();
  values["layers"] += 1;
  values["c_mm"] += travel.contours_mm();
  values["crs_mm"] += crs;
  values["solve_seconds"] += layer.solve_seconds();
  for (const auto& [name, value] : layer.statistics()) {
    const bool is_list =
        name.find("_incumbent_") != std::string::npos || name.starts_with("trace_");
    if (!is_list) values[name] += value;
    if (is_first) values["first." + name] = value;
  }
  if (!is_first) return;
  values["c1_mm"] = travel.contours_mm();
  values["crs1_mm"] = crs;
}

Json ToJson(const std::string& key, const RunOutcome& outcome) {
  JsonArray moves;
  for (const DrawnMove& m : outcome.first_layer) {
    moves.push_back(JsonArray{m.x1, m.y1, m.x2, m.y2, m.to_contour ? 1 : 0});
  }
  Json values = JsonObject();
  for (const auto& [name, value] : outcome.values) values.members().push_back({name, value});
  return JsonObject{{"moves", std::move(moves)}, {"run", key}, {"values", std::move(values)}};
}

// Unset unless it is what ToJson() writes.
std::optional<DrawnMove> MoveOf(const Json& json) {
  if (!json.is_array() || json.items().size() != 5) return std::nullopt;
  double numbers[5];
  for (size_t i = 0; i < 5; ++i) {
    const std::optional<double> number = json.items()[i].Number();
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return DrawnMove{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4] != 0};
}

std::optional<RunOutcome> OutcomeOf(const Json& values, const Json& moves) {
  if (!values.is_object() || !moves.is_array()) return std::nullopt;
  RunOutcome outcome;
  for (const auto& [name, value] : values.members()) {
    const std::optional<double> number = value.Number();
    if (!number) return std::nullopt;
    outcome.values[name] = *number;
  }
  for (const Json& json : moves.items()) {
    const std::optional<DrawnMove> move = MoveOf(json);
    if (!move) return std::nullopt;
    outcome.first_layer.push_back(*move);
  }
  return outcome;
}

// Adds the outcome of a line to `outcomes`; false unless it is what ToJson() writes.
bool AddLine(const std::string& line, std::map<std::string, RunOutcome>& outcomes) {
  const std::optional<Json> json = ParseJson(line);
  if (!json) return false;
  const Json* const run = json->Find("run");
  const Json* const values = json->Find("values");
  const Json* const moves = json->Find("moves");
  if (run == nullptr || run->Text() == nullptr || values == nullptr || moves == nullptr) {
    return false;
  }
  std::optional<RunOutcome> outcome = OutcomeOf(*values, *moves);
  if (!outcome) return false;
  outcomes[*run->Text()] = *std::move(outcome);
  return true;
}

}  // namespace

double RunOutcome::Get(const std::string& name, double unset) const {
  const auto found = values.find(name);
  return found == values.end() ? unset : found->second;
}

bool RunOutcome::HasRoute() const {
  for (const char* step : {"contours", "rasters"}) {
    if (Get(absl::StrCat(step, "_found")) < Get(absl::StrCat(step, "_programmes"))) return false;
  }
  return true;
}

RunOutcome OutcomeOf(const InputJob& job, const JobRun& run) {
  RunOutcome outcome;
  for (size_t i = 0; i < run.result.layers.size(); ++i) {
    AddLayer(run.result.layers[i], i == 0, outcome);
  }
  outcome.values["cleaning_mm"] = run.result.summary.cleaning_mm();
  outcome.values["wall_seconds"] = run.wall_seconds;
  if (!run.result.layers.empty()) {
    outcome.first_layer = MovesOf(job.layers.front(), run.result.layers.front());
  }
  return outcome;
}

absl::StatusOr<OutcomeFile> OutcomeFile::Open(const std::string& name) {
  OutcomeFile file;
  file.name_ = name;
  if (name.empty() || !std::ifstream(name)) return file;
  const absl::StatusOr<std::string> text = ReadWholeFile(name);
  if (!text.ok()) return text.status();
  std::vector<std::string> lines = absl::StrSplit(*text, '\n');
  for (size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    if (!AddLine(lines[i], file.outcomes_)) {
      if (i + 1 == lines.size()) break;  // writing was interrupted
      return absl::InvalidArgumentError(absl::StrFormat("%s:%d: no outcome of a run", name, i + 1));
    }
  }
  return file;
}

const RunOutcome* OutcomeFile::Find(const std::string& key) const {
  const auto found = outcomes_.find(key);
  return found == outcomes_.end() ? nullptr : &found->second;
}

absl::Status OutcomeFile::Add(const std::string& key, const RunOutcome& outcome) {
  outcomes_[key] = outcome;
  if (name_.empty()) return absl::OkStatus();
  std::ofstream out(name_, std::ios::app);
  out << JsonText(ToJson(key, outcome)) << '\n' << std::flush;
  return out ? absl::OkStatus()
             : absl::UnavailableError(absl::StrCat(name_, ": cannot be written"));
}

}  // namespace traverse::report
