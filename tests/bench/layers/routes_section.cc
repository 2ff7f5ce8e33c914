#include <algorithm>
#include <cstdio>

#include "absl/strings/str_format.h"
#include "tests/bench/layers/bench_run.h"
#include "tests/bench/layers/sections.h"

namespace traverse::bench {
namespace {

constexpr double kToleranceMm = 1e-6;

// For a layer, of the strategies that take long.
constexpr double kSlowMs = 2000;
constexpr double kQuickMs = 20;

double Percent(double value, double base) { return 100 * (value / base - 1); }

BenchJob LimitedJob(double limit_ms) {
  BenchJob job;
  // Goes on without a gain until the time is over.
  job.options["effort"] = "1000000";
  job.layer_time_limit = absl::Microseconds(1000 * limit_ms);
  return job;
}

}  // namespace

bool PrintRoutes(const std::vector<BenchPart>& parts, const BenchOptions& options) {
  const double slow_ms = options.quick ? kQuickMs : kSlowMs;
  std::printf(
      "## Travel in mm by strategy, one thread, auto the median of %d seeds, tabu and exact within "
      "%g ms a layer\n\n"
      "| part | layers | none | greedy | ni2opt | tabu | exact | its bound | auto | under greedy "
      "| under ni2opt | best known | auto over it | ms a layer | layers/s a core |\n"
      "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
      options.seeds, slow_ms);
  bool good = true;
  for (const BenchPart& part : parts) {
    BenchJob job;
    const auto of = [&](const char* strategy) {
      job.strategy = strategy;
      return Run(part.layers, job);
    };
    const double none = of("none").travel_mm;
    const double greedy = of("greedy").travel_mm;
    const double ni2opt = of("ni2opt").travel_mm;
    job.layer_time_limit = absl::Microseconds(1000 * slow_ms);
    const double tabu = of("tabu").travel_mm;
    job.strategy = "exact";
    const BenchResult exact = Run(part.layers, job);
    job.layer_time_limit = absl::InfiniteDuration();
    job.strategy = "auto";
    const BenchResult best = MedianRun(part.layers, job, options.seeds);
    const double known = part.reference.at("best_known");
    const double layers = static_cast<double>(part.layers.size());
    std::printf(
        "| %s | %.0f | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f %% | %.1f %% | %.1f | "
        "%+.2f %% | %.1f | %.0f |\n",
        part.name.c_str(), layers, none, greedy, ni2opt, tabu, exact.travel_mm, exact.bound_mm,
        best.travel_mm, -Percent(best.travel_mm, greedy), -Percent(best.travel_mm, ni2opt), known,
        Percent(best.travel_mm, known), 1e3 * best.cpu_seconds / layers, layers / best.cpu_seconds);
    std::fflush(stdout);
    good =
        good && exact.invalid == 0 && best.invalid == 0 && best.travel_mm <= greedy + kToleranceMm;
  }
  std::printf("\n");
  return good;
}

bool PrintTime(const std::vector<BenchPart>& parts, const BenchOptions& options) {
  std::vector<double> limits_ms = {2, 5, 10, 20, 50, 100, 200, 500, 2000};
  if (options.quick) limits_ms = {2, 20};
  std::printf("## `auto` over the best known, by time a layer, one thread, median of %d seeds\n\n",
              options.seeds);
  std::printf("| part |");
  for (const double ms : limits_ms) std::printf(" %g ms |", ms);
  std::printf("\n|---|");
  for (size_t i = 0; i < limits_ms.size(); ++i) std::printf("---:|");
  bool good = true;
  for (const BenchPart& part : parts) {
    std::printf("\n| %s |", part.name.c_str());
    for (const double ms : limits_ms) {
      const BenchResult result = MedianRun(part.layers, LimitedJob(ms), options.seeds);
      std::printf(" %+.2f %% |", Percent(result.travel_mm, part.reference.at("best_known")));
      std::fflush(stdout);
      good = good && result.invalid == 0;
    }
  }
  std::printf("\n\n");
  return good;
}

bool PrintFirstTenth(const std::vector<BenchPart>& parts, const BenchOptions& options) {
  std::vector<double> limits_ms = {100, 1000};
  if (options.quick) limits_ms = {50};
  std::printf(
      "## After a tenth of the time a layer, over the route after all of it, median of %d seeds\n\n"
      "| part |",
      options.seeds);
  for (const double ms : limits_ms) std::printf(" %g of %g ms |", ms / 10, ms);
  std::printf("\n|---|");
  for (size_t i = 0; i < limits_ms.size(); ++i) std::printf("---:|");
  bool good = true;
  for (const BenchPart& part : parts) {
    std::printf("\n| %s |", part.name.c_str());
    for (const double ms : limits_ms) {
      const BenchResult early = MedianRun(part.layers, LimitedJob(ms / 10), options.seeds);
      const BenchResult late = MedianRun(part.layers, LimitedJob(ms), options.seeds);
      std::printf(" %+.2f %% |", Percent(early.travel_mm, late.travel_mm));
      std::fflush(stdout);
      good = good && early.invalid == 0 && late.invalid == 0;
    }
  }
  std::printf("\n\n");
  return good;
}

}  // namespace traverse::bench
