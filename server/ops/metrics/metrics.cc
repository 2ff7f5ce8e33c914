#include "server/ops/metrics/metrics.h"

#include <algorithm>
#include <cassert>

#include "absl/strings/str_cat.h"
#include "engine/strategy/registry.h"
#include "server/translate/translate_result.h"

namespace traverse {
namespace {

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

}  // namespace

Metrics::Metrics() {
  // All reasons exist from the start, so that rates over them do.
  for (int r = 0; r <= static_cast<int>(Refusal::kPermission); ++r) {
    rejected_.Add({{"reason", RefusalName(static_cast<Refusal>(r))}});
  }
  for (const char* what : {"certificate", "log", "tokens"}) reload_failures_.Add({{"what", what}});
}

const LayerMetrics& Metrics::ForStrategy(const std::string& strategy) {
  assert(strategy == kUnknownStrategy ||
         std::any_of(Strategies().begin(), Strategies().end(),
                     [&](const StrategyEntry& entry) { return entry.name == strategy; }));
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
  return registry_.Text();
}

}  // namespace traverse
