// Every metric of the server, in one place. Names are a contract.
//
// Thread-safe.

#ifndef TRAVERSE_SERVER_OPS_METRICS_METRICS_H_
#define TRAVERSE_SERVER_OPS_METRICS_METRICS_H_

#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "engine/base/mutex.h"
#include "engine/engine.h"
#include "server/jobs/admission.h"
#include "server/ops/metrics/metric_registry.h"

namespace traverse {

// The metrics of one strategy's layers; looked up once per job, used for each layer.
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

  // Counts a changed file that cannot be used; `what` is certificate, tokens or log.
  void CountReloadFailure(const std::string& what);

  // Gauges are read when the metrics are.
  struct Gauges {
    double queue_layers = 0;
    double queue_points = 0;
    double jobs_in_flight = 0;
    double workers_busy = 0;
    double workers = 0;
    double workers_silent = 0;
    double ready = 0;  // 1: accepts jobs
    double jobs_bytes = 0;
    double receiving_bytes = 0;
    double max_memory_bytes = 0;
    double connections = 0;
    double connections_cut = 0;
    double log_lines_lost = 0;
    std::optional<double> certificate_expiry_seconds;  // from now; unset: no TLS
    std::optional<double> client_ca_expiry_seconds;    // the same; unset: no client certificates
  };

  // The text of /metrics, with the metrics of the process.
  std::string Text(const Gauges& gauges);

 private:
  static constexpr std::initializer_list<double> kGapBounds = {0,    0.001, 0.0025, 0.005, 0.01,
                                                               0.02, 0.05,  0.1,    0.2,   0.5};

  MetricRegistry registry_;
  prometheus::Family<prometheus::Counter>& jobs_ =
      registry_.Counters("traverse_jobs_total", "Jobs ended, by gRPC status.");
  prometheus::Family<prometheus::Counter>& layers_ =
      registry_.Counters("traverse_layers_total", "Layers solved, by stop reason.");
  prometheus::Family<prometheus::Counter>& rpcs_ =
      registry_.Counters("traverse_rpcs_total", "Calls ended, by method and status.");
  prometheus::Family<prometheus::Counter>& rejected_ = registry_.Counters(
      "traverse_rejected_total", "Jobs refused for a limit or a permission, by reason.");
  prometheus::Family<prometheus::Counter>& reload_failures_ = registry_.Counters(
      "traverse_reload_failures_total",
      "Changed files that could not be used, by content; the last good one stays in use.");
  prometheus::Family<prometheus::Histogram>& layer_seconds_ =
      registry_.Histograms("traverse_layer_solve_seconds", "Time of work on one layer.");
  prometheus::Family<prometheus::Histogram>& job_seconds_ =
      registry_.Histograms("traverse_job_seconds", "Time from a job's first message to its last.");
  prometheus::Counter& travel_given_mm_ = registry_.Counter(
      "traverse_travel_given_mm_total", "Travel of the given orders, including cleaning.");
  prometheus::Counter& travel_mm_ = registry_.Counter(
      "traverse_travel_mm_total", "Travel of the routes answered, including cleaning.");
  prometheus::Counter& idle_seconds_saved_ = registry_.Counter(
      "traverse_idle_seconds_saved_total", "Idle time saved at the speeds that the jobs state.");
  prometheus::Counter& invalid_routes_ = registry_.Counter(
      "traverse_invalid_routes_total", "Routes that failed the validator; each one is a bug.");
  prometheus::Histogram& gap_ =
      registry_.Histogram("traverse_optimality_gap_ratio",
                          "Gap to the lower bound, for layers that have one.", kGapBounds);
  prometheus::Gauge& queue_layers_ =
      registry_.Gauge("traverse_queue_layers", "Layers accepted but not yet solved.");
  prometheus::Gauge& queue_points_ =
      registry_.Gauge("traverse_queue_points", "Points accepted but not yet solved.");
  prometheus::Gauge& jobs_in_flight_ =
      registry_.Gauge("traverse_jobs_in_flight", "Jobs accepted but not yet ended.");
  prometheus::Gauge& workers_busy_ =
      registry_.Gauge("traverse_workers_busy", "Workers that are running a task.");
  prometheus::Gauge& workers_ = registry_.Gauge("traverse_workers", "All workers.");
  prometheus::Gauge& workers_silent_ = registry_.Gauge(
      "traverse_workers_silent", "Workers that were silent for longer than --watchdog.");
  prometheus::Gauge& ready_ =
      registry_.Gauge("traverse_ready", "1 while the server accepts jobs, 0 while it drains.");
  prometheus::Counter& log_lines_lost_ = registry_.Counter(
      "traverse_log_lines_lost_total", "Log lines that were dropped or not written.");
  prometheus::Family<prometheus::Gauge>& memory_ = registry_.Gauges(
      "traverse_memory_bytes", "Memory that the server holds for callers, by kind.");
  prometheus::Gauge& max_memory_ =
      registry_.Gauge("traverse_memory_max_bytes", "Memory that the server may use.");
  prometheus::Gauge& connections_ = registry_.Gauge("traverse_connections", "Connections open.");
  prometheus::Counter& connections_cut_ = registry_.Counter(
      "traverse_connections_cut_total", "Connections cut for what they sent, or to make room.");
  prometheus::Family<prometheus::Gauge>& certificate_expiry_ = registry_.Gauges(
      "traverse_certificate_expiry_seconds", "Time until the certificate in use expires, by file.");

  Mutex mutex_;
  std::map<std::string, LayerMetrics> by_strategy_
      TRAVERSE_GUARDED_BY(mutex_);  // never erased from
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_METRICS_METRICS_H_
