// One sliced file under one policy: what `traverse optimize` makes of it.

#ifndef TRAVERSE_TESTS_BENCH_GCODE_CORPUS_RUN_H_
#define TRAVERSE_TESTS_BENCH_GCODE_CORPUS_RUN_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "client/api/optimizer_client.h"
#include "client/gcode/measure/print_totals.h"
#include "client/gcode/plan/policy.h"

namespace traverse::bench {

struct CorpusRun {
  std::string file;    // without folder and extension
  std::string slicer;  // "PrusaSlicer", without the version; "unknown"
  gcode::Policy policy = gcode::Policy::kSafe;
  gcode::PrintTotals before;
  gcode::PrintTotals after;

  // Of the time before: what is not spent along paths. Nothing that leaves the paths as they are
  // saves more.
  double link_seconds = 0;

  // What the chosen orders save as they are estimated.
  double found_seconds = 0;

  int64_t layers = 0;
  int64_t layers_changed = 0;
  std::string fault;       // why the result is not equivalent; empty: verified
  double cpu_seconds = 0;  // of the whole, all threads
};

// Percent by which `after` is less than `before`; negative if it is more.
double Saved(double before, double after);

// Reads, optimises with `strategy` and verifies the file at `path`; measures the file written, read
// again. An error if it cannot be read, or the service fails.
absl::StatusOr<CorpusRun> RunFile(const std::string& path, gcode::Policy policy,
                                  const std::string& strategy, OptimizerClient& client);

}  // namespace traverse::bench

#endif  // TRAVERSE_TESTS_BENCH_GCODE_CORPUS_RUN_H_
