// Every metric of the gateway, in one place. Names are a contract.
//
// Thread-safe.

#ifndef TRAVERSE_CLIENT_GATEWAY_GATEWAY_METRICS_H_
#define TRAVERSE_CLIENT_GATEWAY_GATEWAY_METRICS_H_

#include <string>

#include "server/ops/metrics/metric_registry.h"
#include "traverse/v1/gcode_service.pb.h"

namespace traverse::gateway {

class GatewayMetrics {
 public:
  GatewayMetrics();

  // Counts an ended request of HTTP or gRPC. `route` is one of a fixed few; `code` is an HTTP
  // status, or the name of a gRPC status.
  void CountRequest(const std::string& route, const std::string& code, double seconds);

  // Counts a file by its outcome: "rewritten", "unchanged", "refused", "failed", "late",
  // "cancelled".
  void CountFile(const std::string& outcome);
  void CountSaved(const v1::RewriteSummary& summary);

  // Counts a file for a printer: sent "optimised", or "original" (with the reason); or not sent:
  // "refused", "upstream_failed".
  void CountUpload(const std::string& printer, const std::string& outcome,
                   const std::string& reason);

  // Counts an operator's file, "tokens", "certificate" or "log", that could not be reloaded.
  void CountReloadFailure(const std::string& what);

  // Gauges are read when the metrics are.
  struct Gauges {
    int requests = 0;
    int waiting = 0;
    int running = 0;
    double work_bytes = 0;
    double spool_bytes = 0;
    int jobs = 0;
    int jobs_unfetched = 0;
    int connections = 0;         // of gRPC
    double receiving_bytes = 0;  // of unfinished messages there
    double connections_cut = 0;  // so far
    double ready = 0;
  };

  // The text of /metrics, with the metrics of the process.
  std::string Text(const Gauges& gauges);

 private:
  MetricRegistry registry_;
  prometheus::Family<prometheus::Counter>& requests_;
  prometheus::Family<prometheus::Histogram>& request_seconds_;
  prometheus::Family<prometheus::Counter>& files_;
  prometheus::Family<prometheus::Counter>& uploads_;
  prometheus::Family<prometheus::Counter>& reload_failures_;
  prometheus::Counter& travel_given_mm_;
  prometheus::Counter& travel_mm_;
  prometheus::Counter& print_seconds_saved_;
  prometheus::Gauge& in_flight_;
  prometheus::Gauge& waiting_;
  prometheus::Gauge& running_;
  prometheus::Gauge& work_bytes_;
  prometheus::Gauge& spool_bytes_;
  prometheus::Gauge& jobs_;
  prometheus::Gauge& jobs_unfetched_;
  prometheus::Gauge& connections_;
  prometheus::Gauge& receiving_bytes_;
  prometheus::Counter& connections_cut_;
  prometheus::Gauge& ready_;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GATEWAY_METRICS_H_
