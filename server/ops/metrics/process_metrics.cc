#include "server/ops/metrics/process_metrics.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace traverse {
namespace {

prometheus::MetricFamily Single(const std::string& name, const std::string& help,
                                prometheus::MetricType type, double value) {
  prometheus::ClientMetric metric;
  if (type == prometheus::MetricType::Counter) {
    metric.counter.value = value;
  } else {
    metric.gauge.value = value;
  }
  return {name, help, type, {metric}};
}

// The fields of /proc/self/stat after the command's name, which may contain anything; empty if
// unreadable. Field n of proc(5) is at n - 3.
std::vector<std::string> StatFields() {
  std::ifstream file("/proc/self/stat");
  std::string line;
  std::getline(file, line);
  const size_t end_of_name = line.rfind(')');
  if (end_of_name == std::string::npos) return {};
  std::istringstream rest(line.substr(end_of_name + 1));
  return {std::istream_iterator<std::string>(rest), {}};
}

// Seconds from 1970 to the start of the machine; 0 if unreadable.
double BootTime() {
  std::ifstream file("/proc/stat");
  std::string key;
  while (file >> key) {
    double value = 0;
    if (key == "btime" && file >> value) return value;
    file.ignore(1 << 20, '\n');
  }
  return 0;
}

double OpenFiles() {
  std::error_code error;
  double count = 0;
  for (std::filesystem::directory_iterator it("/proc/self/fd", error), end; !error && it != end;
       it.increment(error)) {
    ++count;
  }
  return count > 0 ? count - 1 : 0;  // without the one that reads the directory
}

}  // namespace

std::vector<prometheus::MetricFamily> ProcessMetrics() {
  using prometheus::MetricType;
  std::vector<prometheus::MetricFamily> families;
  const std::vector<std::string> stat = StatFields();
  constexpr size_t kUserTicks = 11, kSystemTicks = 12, kThreads = 17, kStartTicks = 19,
                   kVirtualBytes = 20, kResidentPages = 21;
  if (stat.size() > kResidentPages) {
    const auto ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
    const auto page = static_cast<double>(sysconf(_SC_PAGESIZE));
    const auto field = [&stat](size_t index) { return std::stod(stat[index]); };
    families.push_back(Single("process_cpu_seconds_total", "CPU time, user and system.",
                              MetricType::Counter,
                              (field(kUserTicks) + field(kSystemTicks)) / ticks));
    families.push_back(Single("process_resident_memory_bytes", "Resident memory.",
                              MetricType::Gauge, field(kResidentPages) * page));
    families.push_back(Single("process_virtual_memory_bytes", "Virtual memory.", MetricType::Gauge,
                              field(kVirtualBytes)));
    families.push_back(Single("process_threads", "Threads.", MetricType::Gauge, field(kThreads)));
    families.push_back(Single("process_start_time_seconds", "Start time, in seconds since 1970.",
                              MetricType::Gauge, BootTime() + field(kStartTicks) / ticks));
  }
  // Apart: memory that grows with use, and memory that the allocator keeps between jobs.
  const struct mallinfo2 heap = mallinfo2();
  families.push_back(Single("process_heap_used_bytes",
                            "Memory that is allocated and not yet freed.", MetricType::Gauge,
                            static_cast<double>(heap.uordblks + heap.hblkhd)));
  families.push_back(Single("process_heap_free_bytes",
                            "Freed memory that the allocator has not returned to the system.",
                            MetricType::Gauge, static_cast<double>(heap.fordblks)));
  families.push_back(
      Single("process_open_fds", "Open file descriptors.", MetricType::Gauge, OpenFiles()));
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0) {
    families.push_back(Single("process_max_fds", "Limit of open file descriptors.",
                              MetricType::Gauge, static_cast<double>(files.rlim_cur)));
  }
  return families;
}

}  // namespace traverse
