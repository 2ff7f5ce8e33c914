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

  // A request of HTTP or gRPC has ended. `route` is one of a fixed few; `code` a status of HTTP, or
  // the name of one of gRPC.
  void CountRequest(const std::string& route, const std::string& code, double seconds);

  // A file has been rewritten, or why it was not: "rewritten", "unchanged", "refused", "failed",
  // "late", "cancelled".
  void CountFile(const std::string& outcome);
  void CountSaved(const v1::RewriteSummary& summary);

  // A file has gone to a printer: as "optimised" or "original" (with the reason why), or it has
  // not: "refused", "upstream_failed".
  void CountUpload(const std::string& printer, const std::string& outcome,
                   const std::string& reason);

  // A file of an operator, "tokens", "certificate" or "log", could not be read anew.
  void CountReloadFailure(const std::string& what);

  // Gauges are read when the metrics are.
  struct Gauges {
    int requests = 0;
    int waiting = 0;
    int running = 0;
    double work_bytes = 0;
    double spool_bytes = 0;
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
  prometheus::Gauge& ready_;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GATEWAY_METRICS_H_
