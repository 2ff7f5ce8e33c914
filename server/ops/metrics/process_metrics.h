// Metrics of the process, as Prometheus names them, read from /proc/self.

#ifndef TRAVERSE_SERVER_OPS_METRICS_PROCESS_METRICS_H_
#define TRAVERSE_SERVER_OPS_METRICS_PROCESS_METRICS_H_

#include <prometheus/metric_family.h>

#include <vector>

namespace traverse {

// process_cpu_seconds_total, process_resident_memory_bytes, process_virtual_memory_bytes,
// process_start_time_seconds, process_open_fds, process_max_fds, process_threads. Those that cannot
// be read are left out.
std::vector<prometheus::MetricFamily> ProcessMetrics();

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_METRICS_PROCESS_METRICS_H_
