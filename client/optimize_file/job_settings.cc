#include "client/optimize_file/job_settings.h"

#include <cstddef>

#include "absl/strings/str_format.h"

namespace traverse {
namespace {

// A fast desktop printer of today.
constexpr double kDefaultSpeedMmS = 130;
constexpr double kDefaultAccelMmS2 = 1250;
constexpr double kDefaultRetractionSeconds = 0.1;
constexpr double kDefaultRetractionThresholdMm = 2;

// Overrides `model` with the settings. A time model that the file does not state begins with the
// defaults.
void ApplyCost(const CostSettings& settings, v1::CostModel& model) {
  const bool by_time = settings.by_time.value_or(model.has_time());
  if (!by_time) {
    model.mutable_length();
    return;
  }
  if (!model.has_time()) {
    v1::TimeCost& time = *model.mutable_time();
    time.set_speed_mm_s(kDefaultSpeedMmS);
    time.set_accel_mm_s2(kDefaultAccelMmS2);
    time.set_retraction_seconds(kDefaultRetractionSeconds);
    time.set_retraction_threshold_mm(kDefaultRetractionThresholdMm);
  }
  v1::TimeCost& time = *model.mutable_time();
  if (settings.speed_mm_s) time.set_speed_mm_s(*settings.speed_mm_s);
  if (settings.accel_mm_s2) time.set_accel_mm_s2(*settings.accel_mm_s2);
  if (settings.retraction_seconds) time.set_retraction_seconds(*settings.retraction_seconds);
  if (settings.retraction_threshold_mm) {
    time.set_retraction_threshold_mm(*settings.retraction_threshold_mm);
  }
}

// States idle time at the speed that the cost uses, if there is one. Parts in DAMAT are those of
// the machine of the sources, which moves at 20.32 mm/s.
void ApplyIdleSpeed(const CostSettings& settings, InputFormat format, v1::JobOptions& options) {
  constexpr double kDamatSpeedMmS = 20.32;
  if (settings.speed_mm_s) {
    options.set_idle_speed_mm_s(*settings.speed_mm_s);
  } else if (options.cost().has_time() && !options.has_idle_speed_mm_s()) {
    options.set_idle_speed_mm_s(options.cost().time().speed_mm_s());
  } else if (format == InputFormat::kDamat && !options.has_idle_speed_mm_s()) {
    options.set_idle_speed_mm_s(kDamatSpeedMmS);
  }
}

google::protobuf::Duration ToProto(absl::Duration duration) {
  const int64_t nanos = absl::ToInt64Nanoseconds(duration);
  google::protobuf::Duration out;
  out.set_seconds(nanos / 1'000'000'000);
  out.set_nanos(static_cast<int32_t>(nanos % 1'000'000'000));
  return out;
}

}  // namespace

absl::Status SelectLayers(const JobSettings& settings, InputJob& job) {
  if (!settings.layers) return absl::OkStatus();
  const auto [first, last] = *settings.layers;
  if (last > job.layers.size()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("layers=%d-%d: the file has %d layers", first, last, job.layers.size()));
  }
  const auto cut = [first = first, last = last](auto& list) {
    if (list.empty()) return;
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(last), list.end());
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(first - 1));
  };
  cut(job.layers);
  cut(job.notes);
  job.first_layer = first - 1;
  return absl::OkStatus();
}

absl::Status ApplySettings(const JobSettings& settings, InputJob& job) {
  if (absl::Status status = SelectLayers(settings, job); !status.ok()) return status;
  v1::JobOptions& options = job.options;
  if (settings.deposition) options.set_deposition(*settings.deposition);
  if (settings.cleaning) *options.mutable_cleaning() = *settings.cleaning;
  if (settings.start) *options.mutable_start() = *settings.start;
  if (settings.seed) options.set_seed(*settings.seed);
  if (settings.time_limit) *options.mutable_time_limit() = ToProto(*settings.time_limit);
  if (settings.layer_time_limit) {
    *options.mutable_layer_time_limit() = ToProto(*settings.layer_time_limit);
  }
  ApplyCost(settings.cost, *options.mutable_cost());
  ApplyIdleSpeed(settings.cost, job.format, options);
  for (v1::Layer& layer : job.layers) {
    if (layer.has_cost()) ApplyCost(settings.cost, *layer.mutable_cost());
  }
  return absl::OkStatus();
}

}  // namespace traverse
