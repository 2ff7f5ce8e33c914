#include "client/api/resume.h"

#include <algorithm>
#include <map>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"

namespace traverse {
namespace {

constexpr double kDefaultIdleSpeedMmS = 20.32;

void AddTravel(const v1::Travel& from, v1::Travel& to) {
  to.set_contours_mm(to.contours_mm() + from.contours_mm());
  to.set_rasters_mm(to.rasters_mm() + from.rasters_mm());
  to.set_links_mm(to.links_mm() + from.links_mm());
  to.set_total_mm(to.total_mm() + from.total_mm());
}

}  // namespace

MissingRun FirstMissing(const std::vector<bool>& answered) {
  const auto begin = std::find(answered.begin(), answered.end(), false);
  const auto end = std::find(begin, answered.end(), true);
  return {static_cast<size_t>(begin - answered.begin()),
          static_cast<size_t>(end - answered.begin())};
}

bool CleaningDueAfter(const v1::JobOptions& options, size_t index) {
  const v1::Cleaning& cleaning = options.cleaning();
  if (cleaning.every_layers() == 0) return false;
  return (cleaning.layers_since_cleaning() + index + 1) % cleaning.every_layers() == 0;
}

v1::JobOptions ResumedOptions(const v1::JobOptions& options, size_t begin,
                              const v1::LayerResult* before, absl::Duration elapsed) {
  v1::JobOptions resumed = options;
  if (before != nullptr) {
    *resumed.mutable_start() =
        CleaningDueAfter(options, begin - 1) ? options.cleaning().point() : before->end();
    if (options.cleaning().every_layers() > 0) {
      resumed.mutable_cleaning()->set_layers_since_cleaning(
          static_cast<uint32_t>((options.cleaning().layers_since_cleaning() + begin) %
                                options.cleaning().every_layers()));
    }
  }
  if (options.has_time_limit() && begin > 0) {
    absl::Duration left = absl::Seconds(options.time_limit().seconds()) +
                          absl::Nanoseconds(options.time_limit().nanos()) - elapsed;
    left = std::max(left, absl::Milliseconds(1));
    const int64_t seconds = absl::IDivDuration(left, absl::Seconds(1), &left);
    resumed.mutable_time_limit()->set_seconds(seconds);
    resumed.mutable_time_limit()->set_nanos(static_cast<int32_t>(absl::ToInt64Nanoseconds(left)));
  }
  return resumed;
}

std::string ShiftPlace(const std::string& message, size_t begin) {
  static constexpr char kField[] = "layers[";
  constexpr size_t kLength = sizeof(kField) - 1;
  const size_t end = message.find(']');
  uint64_t index = 0;
  if (begin == 0 || message.compare(0, kLength, kField) != 0 || end == std::string::npos ||
      !absl::SimpleAtoi(message.substr(kLength, end - kLength), &index)) {
    return message;
  }
  return absl::StrCat(kField, index + begin, message.substr(end));
}

v1::JobSummary SummaryOf(const v1::JobOptions& options, absl::Span<const v1::LayerResult> layers,
                         const v1::JobSummary& last, double wall_seconds) {
  v1::JobSummary sum;
  sum.set_job_id(last.job_id());
  sum.set_strategy(last.strategy());
  std::map<v1::StopReason, uint64_t> stops;
  bool bounded = true;
  double lower_bound = 0;
  for (const v1::LayerResult& layer : layers) {
    if (!layer.fault().empty()) {
      sum.set_faulty_layers(sum.faulty_layers() + 1);
      continue;
    }
    sum.set_layers(sum.layers() + 1);
    AddTravel(layer.given(), *sum.mutable_given());
    AddTravel(layer.travel(), *sum.mutable_travel());
    sum.set_cleaning_given_mm(sum.cleaning_given_mm() + layer.cleaning_given_mm());
    sum.set_cleaning_mm(sum.cleaning_mm() + layer.cleaning_mm());
    sum.set_cost_given(sum.cost_given() + layer.cost_given());
    sum.set_cost(sum.cost() + layer.cost());
    sum.set_compute_seconds(sum.compute_seconds() + layer.solve_seconds());
    bounded = bounded && layer.has_lower_bound();
    lower_bound += layer.lower_bound();
    ++stops[layer.stop_reason()];
  }
  if (bounded) sum.set_lower_bound(lower_bound);
  const double speed =
      options.has_idle_speed_mm_s() ? options.idle_speed_mm_s() : kDefaultIdleSpeedMmS;
  sum.set_idle_seconds_given((sum.given().total_mm() + sum.cleaning_given_mm()) / speed);
  sum.set_idle_seconds((sum.travel().total_mm() + sum.cleaning_mm()) / speed);
  for (const auto& [reason, count] : stops) {
    v1::StopCount& stop = *sum.add_stops();
    stop.set_stop_reason(reason);
    stop.set_layers(count);
  }
  sum.set_wall_seconds(wall_seconds);
  return sum;
}

}  // namespace traverse
