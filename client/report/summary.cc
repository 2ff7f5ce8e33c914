#include "client/report/summary.h"

#include <vector>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/files/read_file.h"
#include "client/gtsp/tour.h"
#include "client/report/json.h"
#include "client/report/numbers.h"

namespace traverse::report {
namespace {

// "LOCAL_OPTIMUM 398, TIME_LIMIT 2".
std::string Stops(const v1::JobSummary& summary) {
  std::vector<std::string> parts;
  for (const v1::StopCount& stop : summary.stops()) {
    parts.push_back(absl::StrFormat("%s %d", StopName(stop.stop_reason()), stop.layers()));
  }
  return absl::StrJoin(parts, ", ");
}

}  // namespace

std::string GapText(const v1::JobSummary& summary) {
  if (!summary.has_lower_bound()) return "";
  if (summary.cost() <= 0) return "0.0 %";
  return absl::StrFormat("%.1f %%",
                         100 * (summary.cost() - summary.lower_bound()) / summary.cost());
}

std::string OptimizeSummary(const InputJob& job, const JobRun& run,
                            const gcode::Forecast* forecast) {
  const v1::JobSummary& summary = run.result.summary;
  const double given = summary.given().total_mm() + summary.cleaning_given_mm();
  const double travel = summary.travel().total_mm() + summary.cleaning_mm();
  std::string out =
      absl::StrFormat("%s: %d layers, %s, %s\n", DisplayName(job.name), job.layers.size(),
                      summary.strategy(), Duration(run.wall_seconds));
  if (forecast == nullptr) {
    absl::StrAppendFormat(&out, "travel   %s -> %s  (%s)\n", Length(given), Length(travel),
                          Change(given, travel));
    absl::StrAppendFormat(&out, "idle     %s -> %s\n", Duration(summary.idle_seconds_given()),
                          Duration(summary.idle_seconds()));
  }
  if (job.options.cost().has_time()) {
    const double cost_given = forecast ? forecast->given_seconds : summary.cost_given();
    const double cost = forecast ? forecast->seconds : summary.cost();
    absl::StrAppendFormat(&out, "cost     %s -> %s  (%s)\n", Duration(cost_given), Duration(cost),
                          Change(cost_given, cost));
  }
  if (job.gtsp != nullptr) {
    absl::StrAppendFormat(&out, "tour     %d by rounded distances (EUC_2D)\n",
                          gtsp::BestTour(*job.gtsp, run.result.layers).rounded_length);
  }
  // In sliced files the bound is one of what the rules allow: none left of it says nothing of what
  // keeps more from moving.
  const bool reached = GapText(summary) == "0.0 %";
  if (summary.has_lower_bound() && !(forecast != nullptr && reached)) {
    absl::StrAppendFormat(&out, "gap      %s to a proven lower bound%s\n", GapText(summary),
                          forecast == nullptr ? "" : " of what the rules allow");
  }
  if (forecast == nullptr && summary.has_chain_lower_bound() && summary.cost() > 0) {
    absl::StrAppendFormat(&out, "chain    %.1f %% to a proven lower bound of all layers together\n",
                          100 * (summary.cost() - summary.chain_lower_bound()) / summary.cost());
  }
  if (summary.stops_size() > 0) absl::StrAppendFormat(&out, "ended    %s\n", Stops(summary));
  return out;
}

}  // namespace traverse::report
