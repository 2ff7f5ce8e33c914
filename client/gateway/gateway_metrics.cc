#include "client/gateway/gateway_metrics.h"

#include <algorithm>

namespace traverse::gateway {
namespace {

// In seconds: from a health check to the longest file.
const prometheus::Histogram::BucketBoundaries& SecondsBounds() {
  static const auto& bounds = *new prometheus::Histogram::BucketBoundaries{
      0.001, 0.005, 0.01, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60, 120, 300, 600};
  return bounds;
}

}  // namespace

GatewayMetrics::GatewayMetrics()
    : requests_(registry_.Counters("traverse_gateway_requests_total",
                                   "Requests ended, by route and status.")),
      request_seconds_(registry_.Histograms("traverse_gateway_request_seconds",
                                            "Time from a request's head to its answer.")),
      files_(registry_.Counters("traverse_gateway_files_total", "Files worked on, by outcome.")),
      uploads_(registry_.Counters("traverse_gateway_uploads_total",
                                  "Files for printers, by what was sent and why.")),
      reload_failures_(
          registry_.Counters("traverse_gateway_reload_failures_total",
                             "Files of operators that could not be reloaded, by content.")),
      travel_given_mm_(registry_.Counter("traverse_gateway_travel_given_mm_total",
                                         "Travel of the rewritten files, before.")),
      travel_mm_(registry_.Counter("traverse_gateway_travel_mm_total",
                                   "Travel of the rewritten files, after.")),
      print_seconds_saved_(registry_.Counter("traverse_gateway_print_seconds_saved_total",
                                             "Estimated print time saved.")),
      in_flight_(
          registry_.Gauge("traverse_gateway_requests_in_flight", "Requests with files under way.")),
      waiting_(
          registry_.Gauge("traverse_gateway_requests_waiting", "Requests that wait for a worker.")),
      running_(registry_.Gauge("traverse_gateway_workers_busy", "Workers that have a file.")),
      work_bytes_(registry_.Gauge("traverse_gateway_work_bytes",
                                  "Memory reserved for files being worked on.")),
      spool_bytes_(registry_.Gauge("traverse_gateway_spool_bytes", "Bytes in the spool.")),
      jobs_(registry_.Gauge("traverse_gateway_jobs", "Jobs under way, and kept after their end.")),
      jobs_unfetched_(registry_.Gauge("traverse_gateway_jobs_unfetched",
                                      "Jobs whose results their callers do not have yet.")),
      connections_(
          registry_.Gauge("traverse_gateway_grpc_connections", "Open connections of gRPC.")),
      receiving_bytes_(registry_.Gauge("traverse_gateway_receiving_bytes",
                                       "Bytes of unfinished messages of gRPC.")),
      connections_cut_(registry_.Counter("traverse_gateway_connections_cut_total",
                                         "Connections of gRPC that were cut.")),
      ready_(registry_.Gauge("traverse_gateway_ready",
                             "1 while the gateway accepts files, 0 while it drains.")) {
  for (const char* outcome : {"rewritten", "unchanged", "refused", "failed", "late", "cancelled"}) {
    files_.Add({{"outcome", outcome}});
  }
}

void GatewayMetrics::CountRequest(const std::string& route, const std::string& code,
                                  double seconds) {
  requests_.Add({{"route", route}, {"code", code}}).Increment();
  request_seconds_.Add({{"route", route}}, SecondsBounds()).Observe(seconds);
}

void GatewayMetrics::CountFile(const std::string& outcome) {
  files_.Add({{"outcome", outcome}}).Increment();
}

void GatewayMetrics::CountSaved(const v1::RewriteSummary& summary) {
  travel_given_mm_.Increment(summary.given().travel_mm());
  travel_mm_.Increment(summary.written().travel_mm());
  print_seconds_saved_.Increment(
      std::max(0.0, summary.given().print_seconds() - summary.written().print_seconds()));
}

void GatewayMetrics::CountUpload(const std::string& printer, const std::string& outcome,
                                 const std::string& reason) {
  uploads_.Add({{"printer", printer}, {"outcome", outcome}, {"reason", reason}}).Increment();
}

void GatewayMetrics::CountReloadFailure(const std::string& what) {
  reload_failures_.Add({{"what", what}}).Increment();
}

std::string GatewayMetrics::Text(const Gauges& gauges) {
  in_flight_.Set(gauges.requests);
  waiting_.Set(gauges.waiting);
  running_.Set(gauges.running);
  work_bytes_.Set(gauges.work_bytes);
  spool_bytes_.Set(gauges.spool_bytes);
  jobs_.Set(gauges.jobs);
  jobs_unfetched_.Set(gauges.jobs_unfetched);
  connections_.Set(gauges.connections);
  receiving_bytes_.Set(gauges.receiving_bytes);
  connections_cut_.Increment(gauges.connections_cut - connections_cut_.Value());
  ready_.Set(gauges.ready);
  return registry_.Text();
}

}  // namespace traverse::gateway
