// What `reproduce` keeps of a run, and where it keeps it.

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

// A place where the head goes without deposition: from one point to another, for drawing.
struct DrawnMove {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
  bool to_contour = false;  // of Rota-C; else of Rota-CRS
};

// One run of one method on one part.
struct RunOutcome {
  // Sums over the layers, by name: "c_mm" (Rota-C), "crs_mm" (Rota-CRS: the move from First to the
  // first raster too), "cleaning_mm", "solve_seconds", "layers", "c1_mm" and "crs1_mm" of the first
  // layer alone, and what the strategy tells of itself; of the first layer "first.NAME" as well.
  std::map<std::string, double> values;
  std::vector<DrawnMove> first_layer;  // its moves

  double Get(const std::string& name, double unset = 0) const;
  double TotalMm() const { return Get("c_mm") + Get("crs_mm") + Get("cleaning_mm"); }

  // Whether every programme of the framework found a route by itself; the thesis's "NA" if not.
  bool HasRoute() const;
};

RunOutcome OutcomeOf(const InputJob& job, const JobRun& run);

// Finished runs by their keys, kept in a file of one JSON object a line, so that what was stopped
// goes on. Not thread-safe.
class OutcomeFile {
 public:
  // Reads `name`, which need not exist; empty: keeps nothing. InvalidArgument with the line of one
  // that is no outcome, but for the last one, which may have been cut short.
  static absl::StatusOr<OutcomeFile> Open(const std::string& name);

  const RunOutcome* Find(const std::string& key) const;

  // Appends it to the file.
  absl::Status Add(const std::string& key, const RunOutcome& outcome);

 private:
  std::string name_;
  std::map<std::string, RunOutcome> outcomes_;
};

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_OUTCOMES_H_
