// What `reproduce` keeps of a run, and where it keeps that.

#ifndef TRAVERSE_CLIENT_REPORT_REPRODUCE_OUTCOMES_H_
#define TRAVERSE_CLIENT_REPORT_REPRODUCE_OUTCOMES_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/input/input_job.h"
#include "client/report/run.h"

namespace traverse::report {

// A travel move from one point to another, for drawing.
struct DrawnMove {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
  bool to_contour = false;  // belongs to Rota-C; otherwise to Rota-CRS
};

// One run of one method on one part.
struct RunOutcome {
  // Sums over the layers: "c_mm" (Rota-C), "crs_mm" (Rota-CRS with the move from First to its
  // start), "cleaning_mm", "solve_seconds", "layers", "c1_mm" and "crs1_mm" of the first layer, and
  // the strategy's statistics, those of the first layer also as "first.NAME".
  std::map<std::string, double> values;
  std::vector<DrawnMove> first_layer;  // its moves

  double Get(const std::string& name, double unset = 0) const;
  double TotalMm() const { return Get("c_mm") + Get("crs_mm") + Get("cleaning_mm"); }

  // Whether every programme of the framework found a route by itself; otherwise the thesis's "NA".
  bool HasRoute() const;
};

RunOutcome OutcomeOf(const InputJob& job, const JobRun& run);

// Finished runs by their keys, in a file with one JSON object per line, so that a stopped run can
// continue. Not thread-safe.
class OutcomeFile {
 public:
  // Reads `name`, which need not exist; empty: keeps nothing. InvalidArgument with the line of an
  // invalid outcome, except the last one, which may be truncated.
  static absl::StatusOr<OutcomeFile> Open(const std::string& name);

  const RunOutcome* Find(const std::string& key) const;

  // Adds the outcome and appends it to the file.
  absl::Status Add(const std::string& key, const RunOutcome& outcome);

 private:
  std::string name_;
  std::map<std::string, RunOutcome> outcomes_;
};

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_OUTCOMES_H_
