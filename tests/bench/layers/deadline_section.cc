#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "engine/base/rng.h"
#include "tests/bench/layers/bench_run.h"
#include "tests/bench/layers/sections.h"

namespace traverse::bench {
namespace {

constexpr double kLateMs = 5;

// More than greedy needs for any of the parts here, on a slow machine.
constexpr double kGreedyMs = 200;

struct Lateness {
  std::string part;
  double deadline_ms;
  double late_ms;
  double cpu_ms;
};

// The five latest jobs. One that had far less CPU time than its threads could have had was kept
// waiting by the machine.
void PrintLatest(const std::vector<Lateness>& lateness) {
  std::printf("| latest | deadline ms | late ms | CPU time ms |\n|---|---:|---:|---:|\n");
  for (size_t i = 0; i < std::min<size_t>(5, lateness.size()); ++i) {
    const Lateness& job = lateness[i];
    std::printf("| %s | %.1f | %+.1f | %.1f |\n", job.part.c_str(), job.deadline_ms, job.late_ms,
                job.cpu_ms);
  }
  std::printf("\n");
}

}  // namespace

bool PrintDeadlines(const std::vector<BenchPart>& parts, const BenchOptions& options) {
  std::vector<double> greedy_mm;
  for (const BenchPart& part : parts) {
    BenchJob job;
    job.strategy = "greedy";
    greedy_mm.push_back(Run(part.layers, job).travel_mm);
  }
  Rng rng(1);
  std::vector<Lateness> lateness;
  int invalid = 0;
  int longer = 0;
  int unanswered = 0;
  for (int i = 0; i < options.deadlines; ++i) {
    const size_t p = rng.Below(static_cast<uint32_t>(parts.size()));
    // As many short ones as long ones.
    const double deadline_ms = std::pow(2000, rng.Unit());
    BenchJob job;
    job.seed = static_cast<uint64_t>(i);
    job.threads = options.threads;
    job.options["effort"] = "1000000";
    job.deadline = absl::Microseconds(1000 * deadline_ms);
    const BenchResult result = Run(parts[p].layers, job);
    lateness.push_back({parts[p].name, deadline_ms, 1e3 * result.wall_seconds - deadline_ms,
                        1e3 * result.cpu_seconds});
    invalid += result.invalid;
    unanswered += result.layers != static_cast<int>(parts[p].layers.size());
    longer += deadline_ms > kGreedyMs && result.travel_mm > greedy_mm[p] + 1e-6;
  }
  std::sort(lateness.begin(), lateness.end(),
            [](const Lateness& a, const Lateness& b) { return a.late_ms > b.late_ms; });
  const auto late = std::count_if(lateness.begin(), lateness.end(),
                                  [](const Lateness& job) { return job.late_ms > kLateMs; });
  std::printf(
      "## Deadlines: %d jobs with a deadline from 1 ms to 2 s, %d threads\n\n"
      "| more than 5 ms late | latest | layers unanswered | invalid | longer than greedy |\n"
      "|---:|---:|---:|---:|---:|\n| %d | %+.1f ms | %d | %d | %d |\n\n",
      options.deadlines, options.threads, static_cast<int>(late), lateness.front().late_ms,
      unanswered, invalid, longer);
  PrintLatest(lateness);
  // In the quick form other tests keep the machine busy.
  return invalid == 0 && unanswered == 0 && (options.quick || (longer == 0 && late == 0));
}

}  // namespace traverse::bench
