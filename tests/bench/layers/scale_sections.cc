#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/bench/layers/bench_run.h"
#include "tests/bench/layers/sections.h"

namespace traverse::bench {
namespace {

// `count` layers: the second and the third of the part in turn.
std::vector<Plan> Extruded(const BenchPart& part, int count) {
  std::vector<Plan> layers;
  for (int i = 0; i < count; ++i) layers.push_back(part.layers[1 + static_cast<size_t>(i % 2)]);
  return layers;
}

bool PrintThreadsOf(const char* name, const std::vector<Plan>& layers,
                    const BenchOptions& options) {
  bool good = true;
  double one_thread = 0;
  for (int threads = 1; threads <= options.threads; threads *= 2) {
    BenchJob job;
    job.threads = threads;
    const BenchResult result = Run(layers, job);
    if (threads == 1) one_thread = result.wall_seconds;
    const double speed_up = one_thread / result.wall_seconds;
    std::printf("| %s | %d | %.3f | %.0f | %.2f | %.2f | %.1f |\n", name, threads,
                result.wall_seconds, result.layers / result.wall_seconds, speed_up,
                speed_up / threads, result.travel_mm);
    std::fflush(stdout);
    good = good && result.invalid == 0;
  }
  return good;
}

// The first time limit, each 1.1 times the one before, that brings travel to within 2 % of `best`.
double SecondsToReach(const std::vector<Plan>& layers, double best_mm) {
  BenchJob job;
  job.options["effort"] = "1000000";
  for (double seconds = 0.005;; seconds *= 1.1) {
    job.layer_time_limit = absl::Seconds(seconds);
    if (Run(layers, job).travel_mm <= 1.02 * best_mm || seconds > 60) return seconds;
  }
}

// The exponent of `seconds` as a power of `contours`, by least squares of their logarithms.
double GrowthExponent(const std::vector<double>& contours, const std::vector<double>& seconds) {
  const double n = static_cast<double>(contours.size());
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (size_t i = 0; i < contours.size(); ++i) {
    const double x = std::log(contours[i]);
    const double y = std::log(seconds[i]);
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

constexpr double kMostMemoryMb = 1024;

}  // namespace

bool PrintThreads(const std::vector<BenchPart>& parts, const BenchOptions& options) {
  std::printf(
      "## Threads, `auto` by default\n\n"
      "| layers | threads | wall s | layers/s | speed-up | efficiency | mm |\n"
      "|---|---:|---:|---:|---:|---:|---:|\n");
  bool good = true;
  for (const BenchPart& part : parts) {
    if (part.name != "part2") continue;
    const auto layers = Extruded(part, options.quick ? 4 : 400);
    good = PrintThreadsOf("part2, two makes in turn", layers, options) && good;
  }
  std::vector<Plan> different;
  for (int i = 0; i < (options.quick ? 2 : 64); ++i) {
    different.push_back(RandomRings(60, 40, static_cast<uint64_t>(i)));
  }
  good = PrintThreadsOf("60 rings, all different", different, options) && good;
  std::printf("\n");
  return good;
}

bool PrintGrowth(const BenchOptions& options) {
  std::printf(
      "## Growth: one layer of rings of 40 vertices and as many rasters, one thread\n\n"
      "| contours | default: s | mm | within 2 %% of a minute: s | growth | peak MB |\n"
      "|---:|---:|---:|---:|---:|---:|\n");
  bool good = true;
  std::vector<double> sizes = {200, 500, 1000, 2000, 5000};
  if (options.quick) sizes = {200};
  std::vector<double> reached;  // seconds, by size
  for (const double size : sizes) {
    const std::vector<Plan> layers = {RandomRings(static_cast<int>(size), 40, 1)};
    const BenchResult usual = Run(layers, {});
    good = good && usual.invalid == 0;
    std::printf("| %.0f | %.2f | %.1f |", size, usual.cpu_seconds, usual.travel_mm);
    std::fflush(stdout);
    if (options.quick) {
      std::printf(" | |");
    } else {
      BenchJob job;
      job.options["effort"] = "1000000";
      job.layer_time_limit = absl::Seconds(60);
      reached.push_back(SecondsToReach(layers, Run(layers, job).travel_mm));
      std::printf(" %.3f |", reached.back());
      const size_t last = reached.size() - 1;
      if (last > 0) {
        std::printf(" n^%.2f",
                    GrowthExponent({sizes[last - 1], size}, {reached[last - 1], reached[last]}));
      }
      std::printf(" |");
    }
    std::printf(" %.0f |\n", PeakMemoryMb());
    std::fflush(stdout);
  }
  if (reached.size() > 1) {
    std::printf("\nOver all sizes: n^%.2f\n", GrowthExponent(sizes, reached));
  }
  std::printf("\n");
  return good;
}

bool PrintMemory(const BenchOptions& options) {
  const int contours = options.quick ? 500 : 5000;
  BenchJob job;
  job.layer_time_limit = absl::Seconds(options.quick ? 0.2 : 10);
  const double before = PeakMemoryMb();
  const BenchResult result = Run({RandomRings(contours, 40, 1)}, job);
  std::printf(
      "## Memory: one layer of %d vertices, on contours of 40\n\n"
      "| MB before | MB at most |\n|---:|---:|\n| %.0f | %.0f |\n\n",
      40 * contours, before, PeakMemoryMb());
  return result.invalid == 0 && result.layers == 1 && PeakMemoryMb() < kMostMemoryMb;
}

}  // namespace traverse::bench
