#include "server/ops/metrics.h"

#include <prometheus/text_serializer.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/ops/process_metrics.h"
#include "server/translate/translate_result.h"
#include "server/version.h"

namespace traverse {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;

// Bounds of the histograms, in s: a layer takes from microseconds to the minutes of a proof.
const prometheus::Histogram::BucketBoundaries& LayerSecondsBounds() {
  static const auto& bounds = *new prometheus::Histogram::BucketBoundaries{
      0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,
      0.25,   0.5,     1,      2.5,   5,      10,    30,   60,    300};
  return bounds;
}

const prometheus::Histogram::BucketBoundaries& JobSecondsBounds() {
  static const auto& bounds = *new prometheus::Histogram::BucketBoundaries{
      0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5,  1,
      2.5,   5,      10,    30,   60,    120,  300, 600,  1800, 3600};
  return bounds;
}

const prometheus::Histogram::BucketBoundaries& GapBounds() {
  static const auto& bounds = *new prometheus::Histogram::BucketBoundaries{
      0, 0.001, 0.0025, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5};
  return bounds;
}

}  // namespace

template <typename Builder>
auto& Metrics::Family(Builder builder, const std::string& name, const std::string& help) {
  return builder.Name(name).Help(help).Register(registry_);
}

Metrics::Metrics()
    : jobs_(Family(BuildCounter(), "traverse_jobs_total", "Jobs ended, by gRPC status.")),
      layers_(Family(BuildCounter(), "traverse_layers_total", "Layers solved, by stop reason.")),
      rpcs_(Family(BuildCounter(), "traverse_rpcs_total", "Calls ended, by method and status.")),
      rejected_(Family(BuildCounter(), "traverse_rejected_total",
                       "Jobs refused for a limit or a permission, by reason.")),
      reload_failures_(Family(BuildCounter(), "traverse_reload_failures_total",
                              "Changed files of no use, by what they are of; what was good before "
                              "stays.")),
      layer_seconds_(
          Family(BuildHistogram(), "traverse_layer_solve_seconds", "Time of work on one layer.")),
      job_seconds_(Family(BuildHistogram(), "traverse_job_seconds",
                          "Time from a job's first message to its last.")),
      travel_given_mm_(Family(BuildCounter(), "traverse_travel_given_mm_total",
                              "Travel of the orders given, cleaning included.")
                           .Add({})),
      travel_mm_(Family(BuildCounter(), "traverse_travel_mm_total",
                        "Travel of the routes answered, cleaning included.")
                     .Add({})),
      idle_seconds_saved_(Family(BuildCounter(), "traverse_idle_seconds_saved_total",
                                 "Idle time saved at the speeds stated by the jobs.")
                              .Add({})),
      invalid_routes_(Family(BuildCounter(), "traverse_invalid_routes_total",
                             "Routes that failed the validator; each one is a bug.")
                          .Add({})),
      gap_(Family(BuildHistogram(), "traverse_optimality_gap_ratio",
                  "Gap of layers with a lower bound.")
               .Add({}, GapBounds())),
      queue_layers_(
          Family(BuildGauge(), "traverse_queue_layers", "Layers accepted and not yet solved.")
              .Add({})),
      queue_points_(
          Family(BuildGauge(), "traverse_queue_points", "Points accepted and not yet solved.")
              .Add({})),
      jobs_in_flight_(
          Family(BuildGauge(), "traverse_jobs_in_flight", "Jobs accepted and not ended.").Add({})),
      workers_busy_(
          Family(BuildGauge(), "traverse_workers_busy", "Workers that run a task.").Add({})),
      workers_(Family(BuildGauge(), "traverse_workers", "Workers there are.").Add({})),
      workers_silent_(Family(BuildGauge(), "traverse_workers_silent",
                             "Workers that gave no sign of life for the time of --watchdog.")
                          .Add({})),
      ready_(Family(BuildGauge(), "traverse_ready", "1 if the server takes jobs, 0 if it drains.")
                 .Add({})),
      log_lines_lost_(Family(BuildCounter(), "traverse_log_lines_lost_total",
                             "Lines of the log dropped or not written.")
                          .Add({})),
      memory_(Family(BuildGauge(), "traverse_memory_bytes",
                     "Memory that callers make the server hold, by kind.")),
      max_memory_(
          Family(BuildGauge(), "traverse_memory_max_bytes", "Memory that the server may have.")
              .Add({})),
      connections_(Family(BuildGauge(), "traverse_connections", "Connections open.").Add({})),
      connections_cut_(Family(BuildCounter(), "traverse_connections_cut_total",
                              "Connections ended for what they sent, or to make room.")
                           .Add({})),
      certificate_expiry_(Family(BuildGauge(), "traverse_certificate_expiry_seconds",
                                 "Time until the certificate in use expires, by file.")) {
  Family(BuildGauge(), "traverse_build_info", "1, labelled with the version.")
      .Add({{"version", kVersion}})
      .Set(1);
  // Reasons are there from the start, so that rates over them are.
  for (int r = 0; r <= static_cast<int>(Refusal::kPermission); ++r) {
    rejected_.Add({{"reason", RefusalName(static_cast<Refusal>(r))}});
  }
  for (const char* what : {"certificate", "log", "tokens"}) reload_failures_.Add({{"what", what}});
}

const LayerMetrics& Metrics::ForStrategy(const std::string& strategy) {
  MutexLock lock(mutex_);
  const auto found = by_strategy_.find(strategy);
  if (found != by_strategy_.end()) return found->second;
  LayerMetrics metrics;
  for (size_t stop = 0; stop < metrics.layers_by_stop.size(); ++stop) {
    metrics.layers_by_stop[stop] = &layers_.Add(
        {{"strategy", strategy}, {"stop", StopReasonName(static_cast<StopReason>(stop))}});
  }
  metrics.solve_seconds = &layer_seconds_.Add({{"strategy", strategy}}, LayerSecondsBounds());
  return by_strategy_.emplace(strategy, metrics).first->second;
}

void Metrics::CountLayer(const LayerMetrics& metrics, const LayerOutcome& outcome,
                         double idle_speed_mm_s) {
  metrics.layers_by_stop[static_cast<size_t>(outcome.stop)]->Increment();
  metrics.solve_seconds->Observe(outcome.solve_seconds);
  const double given_mm = outcome.given.total_mm() + outcome.cleaning_given_mm;
  const double travel_mm = outcome.travel.total_mm() + outcome.cleaning_mm;
  travel_given_mm_.Increment(given_mm);
  travel_mm_.Increment(travel_mm);
  // A counter cannot fall; a layer that came out longer (greedy can) saved nothing.
  idle_seconds_saved_.Increment(std::max(0.0, given_mm - travel_mm) / idle_speed_mm_s);
  if (outcome.lower_bound) gap_.Observe(Gap(outcome.cost, *outcome.lower_bound));
  if (!outcome.invalid_route.empty()) invalid_routes_.Increment();
}

void Metrics::CountJob(const std::string& strategy, absl::StatusCode code, double seconds) {
  jobs_.Add({{"strategy", strategy}, {"code", absl::StatusCodeToString(code)}}).Increment();
  job_seconds_.Add({{"strategy", strategy}}, JobSecondsBounds()).Observe(seconds);
}

void Metrics::CountRpc(const std::string& method, absl::StatusCode code) {
  rpcs_.Add({{"method", method}, {"code", absl::StatusCodeToString(code)}}).Increment();
}

void Metrics::CountRefusal(Refusal refusal) {
  rejected_.Add({{"reason", RefusalName(refusal)}}).Increment();
}

void Metrics::CountReloadFailure(const std::string& what) {
  reload_failures_.Add({{"what", what}}).Increment();
}

std::string Metrics::Text(const Gauges& gauges) {
  queue_layers_.Set(gauges.queue_layers);
  queue_points_.Set(gauges.queue_points);
  jobs_in_flight_.Set(gauges.jobs_in_flight);
  workers_busy_.Set(gauges.workers_busy);
  workers_.Set(gauges.workers);
  workers_silent_.Set(gauges.workers_silent);
  ready_.Set(gauges.ready);
  memory_.Add({{"kind", "jobs"}}).Set(gauges.jobs_bytes);
  memory_.Add({{"kind", "receiving"}}).Set(gauges.receiving_bytes);
  max_memory_.Set(gauges.max_memory_bytes);
  connections_.Set(gauges.connections);
  connections_cut_.Increment(gauges.connections_cut - connections_cut_.Value());
  log_lines_lost_.Increment(gauges.log_lines_lost - log_lines_lost_.Value());
  if (gauges.certificate_expiry_seconds) {
    certificate_expiry_.Add({{"file", "certificate"}}).Set(*gauges.certificate_expiry_seconds);
  }
  if (gauges.client_ca_expiry_seconds) {
    certificate_expiry_.Add({{"file", "client_ca"}}).Set(*gauges.client_ca_expiry_seconds);
  }
  std::vector<prometheus::MetricFamily> families = registry_.Collect();
  for (prometheus::MetricFamily& family : ProcessMetrics()) families.push_back(std::move(family));
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace traverse
