// The metrics of one daemon, and the text that Prometheus reads.

#ifndef TRAVERSE_SERVER_OPS_METRICS_METRIC_REGISTRY_H_
#define TRAVERSE_SERVER_OPS_METRICS_METRIC_REGISTRY_H_

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <string>

namespace traverse {

// Thread-safe. Registered metrics live as long as this object.
class MetricRegistry {
 public:
  // Registers traverse_build_info.
  MetricRegistry();

  // A family of metrics that labels distinguish.
  prometheus::Family<prometheus::Counter>& Counters(const char* name, const char* help);
  prometheus::Family<prometheus::Gauge>& Gauges(const char* name, const char* help);
  prometheus::Family<prometheus::Histogram>& Histograms(const char* name, const char* help);

  // A metric without labels.
  prometheus::Counter& Counter(const char* name, const char* help);
  prometheus::Gauge& Gauge(const char* name, const char* help);
  prometheus::Histogram& Histogram(const char* name, const char* help,
                                   const prometheus::Histogram::BucketBoundaries& bounds);

  // The text of /metrics, with the metrics of the process.
  std::string Text() const;

 private:
  prometheus::Registry registry_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_METRICS_METRIC_REGISTRY_H_
