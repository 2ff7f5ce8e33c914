// One job, run as the server runs it, and what it took.

#ifndef TRAVERSE_TESTS_BENCH_LAYERS_BENCH_RUN_H_
#define TRAVERSE_TESTS_BENCH_LAYERS_BENCH_RUN_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "engine/model/plan.h"

namespace traverse::bench {

struct BenchJob {
  std::string strategy = "auto";
  std::map<std::string, std::string> options;
  uint64_t seed = 1;
  int threads = 1;
  absl::Duration layer_time_limit = absl::InfiniteDuration();
  absl::Duration deadline = absl::InfiniteDuration();  // from now
};

struct BenchResult {
  double travel_mm = 0;
  double bound_mm = 0;  // 0 unless every layer has a bound
  double cpu_seconds = 0;
  double wall_seconds = 0;
  int layers = 0;
  int invalid = 0;  // routes that the validator refused
  std::vector<double> layer_mm;
};

// Solves `layers` as one chained job from (0, 0).
BenchResult Run(const std::vector<Plan>& layers, const BenchJob& job);

// The median of what `count` seeds from 1 on give, by travel.
BenchResult MedianRun(const std::vector<Plan>& layers, BenchJob job, int count);

// The most memory this process has used, in MB.
double PeakMemoryMb();

}  // namespace traverse::bench

#endif  // TRAVERSE_TESTS_BENCH_LAYERS_BENCH_RUN_H_
