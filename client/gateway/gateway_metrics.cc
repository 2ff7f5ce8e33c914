#include "client/gateway/gateway_metrics.h"

#include <prometheus/text_serializer.h>

#include <algorithm>
#include <vector>

#include "server/ops/process_metrics.h"
#include "server/version.h"

namespace traverse::gateway {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;

// In s: from a health check to the longest file.
const prometheus::Histogram::BucketBoundaries& SecondsBounds() {
  static const auto& bounds = *new prometheus::Histogram::BucketBoundaries{
      0.001, 0.005, 0.01, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60, 120, 300, 600};
  return bounds;
}

}  // namespace

template <typename Builder>
auto& GatewayMetrics::Family(Builder builder, const std::string& name, const std::string& help) {
  return builder.Name(name).Help(help).Register(registry_);
}

prometheus::Gauge& GatewayMetrics::Gauge(const std::string& name, const std::string& help) {
  return Family(BuildGauge(), name, help).Add({});
}

GatewayMetrics::GatewayMetrics()
    : requests_(Family(BuildCounter(), "traverse_gateway_requests_total",
                       "Requests ended, by route and status.")),
      request_seconds_(Family(BuildHistogram(), "traverse_gateway_request_seconds",
                              "Time from a request's head to its answer.")),
      files_(Family(BuildCounter(), "traverse_gateway_files_total",
                    "Files worked on, by what became of them.")),
      uploads_(Family(BuildCounter(), "traverse_gateway_uploads_total",
                      "Files for printers, by what was passed on and why.")),
      reload_failures_(
          Family(BuildCounter(), "traverse_gateway_reload_failures_total",
                 "Files of operators that could not be read anew, by what they hold.")),
      travel_given_mm_(Family(BuildCounter(), "traverse_gateway_travel_given_mm_total",
                              "Travel of the files rewritten, as they came.")
                           .Add({})),
      travel_mm_(Family(BuildCounter(), "traverse_gateway_travel_mm_total",
                        "Travel of the files rewritten, as they went back.")
                     .Add({})),
      print_seconds_saved_(Family(BuildCounter(), "traverse_gateway_print_seconds_saved_total",
                                  "Estimated print time saved.")
                               .Add({})),
      in_flight_(Gauge("traverse_gateway_requests_in_flight", "Requests with files under way.")),
      waiting_(
          Gauge("traverse_gateway_requests_waiting", "Of them, those that wait for a worker.")),
      running_(Gauge("traverse_gateway_workers_busy", "Workers that have a file.")),
      work_bytes_(Gauge("traverse_gateway_work_bytes", "Memory set aside for files worked on.")),
      spool_bytes_(Gauge("traverse_gateway_spool_bytes", "Bytes in the spool.")),
      ready_(Gauge("traverse_gateway_ready", "1 while files are taken, 0 while draining.")) {
  Family(BuildGauge(), "traverse_build_info", "1, with the version.")
      .Add({{"version", kVersion}})
      .Set(1);
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
  ready_.Set(gauges.ready);
  std::vector<prometheus::MetricFamily> families = registry_.Collect();
  for (prometheus::MetricFamily& family : ProcessMetrics()) families.push_back(std::move(family));
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace traverse::gateway
