#include "server/ops/metrics/metric_registry.h"

#include <prometheus/text_serializer.h>

#include <utility>
#include <vector>

#include "server/ops/metrics/process_metrics.h"
#include "server/version.h"

namespace traverse {

MetricRegistry::MetricRegistry() {
  Gauges("traverse_build_info", "1, labelled with the version.")
      .Add({{"version", kVersion}})
      .Set(1);
}

prometheus::Family<prometheus::Counter>& MetricRegistry::Counters(const char* name,
                                                                  const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry_);
}

prometheus::Family<prometheus::Gauge>& MetricRegistry::Gauges(const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry_);
}

prometheus::Family<prometheus::Histogram>& MetricRegistry::Histograms(const char* name,
                                                                      const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(registry_);
}

prometheus::Counter& MetricRegistry::Counter(const char* name, const char* help) {
  return Counters(name, help).Add({});
}

prometheus::Gauge& MetricRegistry::Gauge(const char* name, const char* help) {
  return Gauges(name, help).Add({});
}

prometheus::Histogram& MetricRegistry::Histogram(
    const char* name, const char* help, const prometheus::Histogram::BucketBoundaries& bounds) {
  return Histograms(name, help).Add({}, bounds);
}

std::string MetricRegistry::Text() const {
  std::vector<prometheus::MetricFamily> families = registry_.Collect();
  for (prometheus::MetricFamily& family : ProcessMetrics()) families.push_back(std::move(family));
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace traverse
