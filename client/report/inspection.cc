#include "client/report/inspection.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/files/read_file.h"
#include "client/formats/detect.h"
#include "client/report/numbers.h"
#include "client/report/table.h"

namespace traverse::report {
namespace {

struct Counts {
  uint64_t islands = 0;
  uint64_t contours = 0;
  uint64_t open_paths = 0;
  uint64_t points = 0;

  void Add(const v1::Contour& contour) {
    ++contours;
    points += static_cast<uint64_t>(contour.points_size()) / 2;
  }
  void Add(const v1::OpenPath& path) {
    ++open_paths;
    points += static_cast<uint64_t>(path.points_size()) / 2;
  }
  void Add(const Counts& other) {
    islands += other.islands;
    contours += other.contours;
    open_paths += other.open_paths;
    points += other.points;
  }
};

Counts CountLayer(const v1::Layer& layer) {
  Counts counts;
  counts.islands = static_cast<uint64_t>(layer.islands_size());
  for (const v1::Island& island : layer.islands()) {
    for (const v1::Contour& contour : island.contours()) counts.Add(contour);
    for (const v1::OpenPath& raster : island.rasters()) counts.Add(raster);
  }
  for (const v1::PlanPath& path : layer.plan().paths()) {
    if (path.has_contour()) counts.Add(path.contour());
    if (path.has_open_path()) counts.Add(path.open_path());
  }
  return counts;
}

std::string LayerTable(const InputJob& job, const std::vector<Counts>& counts,
                       const JobResult& given) {
  Table table({"layer", "id", "z mm", "islands", "contours", "rasters", "points", "travel mm"});
  for (size_t i = 0; i < counts.size(); ++i) {
    table.Add({{absl::StrFormat("%d", job.first_layer + i + 1)},
               {absl::StrFormat("%d", job.layers[i].id())},
               {absl::StrFormat("%g", job.layers[i].z_mm())},
               {absl::StrFormat("%d", counts[i].islands)},
               {absl::StrFormat("%d", counts[i].contours)},
               {absl::StrFormat("%d", counts[i].open_paths)},
               {absl::StrFormat("%d", counts[i].points)},
               {absl::StrFormat("%.2f", given.layers[i].given().total_mm())}});
  }
  return table.Text();
}

}  // namespace

std::string InspectionText(const InputJob& job, const JobResult& given, size_t max_rows) {
  std::vector<Counts> counts;
  Counts total;
  for (const v1::Layer& layer : job.layers) {
    counts.push_back(CountLayer(layer));
    total.Add(counts.back());
  }
  const v1::JobSummary& summary = given.summary;
  std::vector<std::pair<std::string, std::string>> rows = job.facts;
  const auto add = [&](const char* name, std::string value) {
    rows.emplace_back(name, std::move(value));
  };
  if (job.envelope) {
    add("envelope", absl::StrFormat("%g x %g mm", job.envelope->x_mm(), job.envelope->y_mm()));
  }
  add("layers", absl::StrFormat("%d", job.layers.size()));
  if (total.islands > 0) add("islands", absl::StrFormat("%d", total.islands));
  add("paths", absl::StrFormat("%d contours, %d rasters", total.contours, total.open_paths));
  add("points", absl::StrFormat("%d", total.points));
  add("travel",
      absl::StrFormat("%s: contours %s, rasters %s, links %s", Length(summary.given().total_mm()),
                      Length(summary.given().contours_mm()), Length(summary.given().rasters_mm()),
                      Length(summary.given().links_mm())));
  add("idle", Duration(summary.idle_seconds_given()));

  size_t width = 0;
  for (const auto& [name, value] : rows) width = std::max(width, name.size());
  std::string out = absl::StrFormat("%s: %s\n", DisplayName(job.name), FormatName(job.format));
  for (const auto& [name, value] : rows) {
    absl::StrAppendFormat(&out, "%-*s  %s\n", static_cast<int>(width), name, value);
  }
  if (counts.size() <= max_rows) absl::StrAppend(&out, "\n", LayerTable(job, counts, given));
  return out;
}

}  // namespace traverse::report
