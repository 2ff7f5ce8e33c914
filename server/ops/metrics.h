// Every metric of the server, in one place. Names are a contract.
//
// Thread-safe.

#ifndef TRAVERSE_SERVER_OPS_METRICS_H_
#define TRAVERSE_SERVER_OPS_METRICS_H_

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "engine/base/mutex.h"
#include "engine/engine.h"
#include "server/jobs/admission.h"

namespace traverse {

// The metrics of one strategy's layers; found once a job, used for each layer.
struct LayerMetrics {
  std::array<prometheus::Counter*, 5> layers_by_stop;  // [StopReason]
  prometheus::Histogram* solve_seconds;
};

class Metrics {
 public:
  Metrics();

  // The label of jobs whose options were never read.
  static constexpr char kUnknownStrategy[] = "unknown";

  // REQUIRES: `strategy` is a name of the registry: labels must not grow with what callers send.
  const LayerMetrics& ForStrategy(const std::string& strategy);

  void CountLayer(const LayerMetrics& metrics, const LayerOutcome& outcome, double idle_speed_mm_s);
  void CountJob(const std::string& strategy, absl::StatusCode code, double seconds);
  void CountRpc(const std::string& method, absl::StatusCode code);
  void CountRefusal(Refusal refusal);

  // What an operator gave has changed, but is of no use: `what` is certificate, tokens or log.
  void CountReloadFailure(const std::string& what);

  // Gauges are read when the metrics are.
  struct Gauges {
    double queue_layers = 0;
    double queue_points = 0;
    double jobs_in_flight = 0;
    double workers_busy = 0;
    double workers = 0;
    double workers_silent = 0;
    double ready = 0;  // 1: takes jobs
    double jobs_bytes = 0;
    double receiving_bytes = 0;
    double max_memory_bytes = 0;
    double connections = 0;
    double connections_cut = 0;
    double log_lines_lost = 0;
    std::optional<double> certificate_expiry_seconds;  // from now on; unset: no TLS
    std::optional<double> client_ca_expiry_seconds;    // the same; unset: no client is asked
  };

  // The text of /metrics, with the metrics of the process.
  std::string Text(const Gauges& gauges);

 private:
  template <typename Builder>
  auto& Family(Builder builder, const std::string& name, const std::string& help);

  prometheus::Registry registry_;
  prometheus::Family<prometheus::Counter>& jobs_;
  prometheus::Family<prometheus::Counter>& layers_;
  prometheus::Family<prometheus::Counter>& rpcs_;
  prometheus::Family<prometheus::Counter>& rejected_;
  prometheus::Family<prometheus::Counter>& reload_failures_;
  prometheus::Family<prometheus::Histogram>& layer_seconds_;
  prometheus::Family<prometheus::Histogram>& job_seconds_;
  prometheus::Counter& travel_given_mm_;
  prometheus::Counter& travel_mm_;
  prometheus::Counter& idle_seconds_saved_;
  prometheus::Counter& invalid_routes_;
  prometheus::Histogram& gap_;
  prometheus::Gauge& queue_layers_;
  prometheus::Gauge& queue_points_;
  prometheus::Gauge& jobs_in_flight_;
  prometheus::Gauge& workers_busy_;
  prometheus::Gauge& workers_;
  prometheus::Gauge& workers_silent_;
  prometheus::Gauge& ready_;
  prometheus::Counter& log_lines_lost_;
  prometheus::Family<prometheus::Gauge>& memory_;
  prometheus::Gauge& max_memory_;
  prometheus::Gauge& connections_;
  prometheus::Counter& connections_cut_;
  prometheus::Family<prometheus::Gauge>& certificate_expiry_;

  Mutex mutex_;
  std::map<std::string, LayerMetrics> by_strategy_
      TRAVERSE_GUARDED_BY(mutex_);  // never erased from
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_METRICS_H_
