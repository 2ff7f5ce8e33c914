// From a sliced file to the same print with less travel: searches it, chooses the orders and writes
// it. The command line and traverse-gateway both use this.
//
//   absl::StatusOr<InputJob> job = ReadInput("part.gcode", {.policy = policy});
//   FileResult<OptimizedFile> made = OptimizeFile(client, *job, {.gcode = {.policy = policy}});
//   if (const auto* file = std::get_if<OptimizedFile>(&made)) Use(file->rewrite.text);

#ifndef TRAVERSE_CLIENT_OPTIMIZE_FILE_OPTIMIZE_FILE_H_
#define TRAVERSE_CLIENT_OPTIMIZE_FILE_OPTIMIZE_FILE_H_

#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "client/api/optimizer_client.h"
#include "client/gcode/gcode_options.h"
#include "client/gcode/rewrite.h"
#include "client/gcode/stated_times.h"
#include "client/input/input_job.h"
#include "client/report/run.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {

// The step that failed.
enum class FileStage {
  kSearch,  // the service's status: it refused, was not reached, or was too late
  kWrite,   // the new file would not print the same; the message names the file
};

struct FileFault {
  FileStage stage = FileStage::kSearch;
  absl::Status status;
};

template <typename T>
using FileResult = std::variant<T, FileFault>;

// What a search has to do.
struct SearchWork {
  std::vector<double> layers;  // [layer] its share, in paths and points

  // What follows takes about so many times as long.
  double stages_behind = 0;

  // And this long beside, whatever searches take.
  double seconds_behind = 0;
};

// Called while the service searches, on the calling thread. Each may be empty.
struct SearchProgress {
  // The search begins.
  std::function<void(const SearchWork& work)> on_search = {};

  // One more layer is done.
  std::function<void(const v1::LayerResult& layer)> on_layer = {};
};

// How many want each processor of this machine, on the average of the last minute; at least 1.
double ProcessorLoad();

struct SearchOptions {
  std::optional<v1::Strategy> strategy = std::nullopt;  // unset: the job's own

  // Of the search of a file together with what is done to improve its orders. The service
  // ends its search early enough; but on a busy machine a late answer is better than none, so the
  // call waits for it kPatience longer.
  absl::Duration deadline = absl::InfiniteDuration();
  static constexpr absl::Duration kPatience = absl::Seconds(5);

  // With a deadline: another service, called if the first one fails amid the job. What has been
  // answered is kept then, and this one answers the other layers with greedy's routes. Empty: the
  // job fails.
  std::function<absl::StatusOr<OptimizerClient*>()> stand_in = {};

  // When the whole file must be ready: nothing is of use later. The search ends early enough that
  // the file can still be written and verified with the best results so far.
  absl::Time finish_by = absl::InfiniteFuture();

  // How long reading the file took, on this machine and as busy as it is.
  absl::Duration reading = absl::ZeroDuration();

  // Of this machine: what is done here takes so many times as long as if nothing else ran.
  double load = ProcessorLoad();

  // When stop is requested, the call ends soon with Cancelled.
  std::stop_token cancel = {};

  SearchProgress progress = {};

  // What it finds will be improved: see SearchWork.
  bool improves_orders = false;
};

// Runs one search of `job`. Errors are the service's.
absl::StatusOr<report::JobRun> Search(OptimizerClient& client, const InputJob& job,
                                      const SearchOptions& options);

struct OptimizeFileOptions : SearchOptions {
  GcodeOptions gcode = {};  // with which the job was read

  // Renews the print times that the file states, by as much as the estimate changed.
  bool restate_times = false;

  // See RewriteOptions. A search by a quicker strategy than `auto` tells nothing.
  bool forecast_fast = false;
};

// A rewritten file.
struct OptimizedFile {
  report::JobRun run;                                    // of the search
  GcodeRewrite rewrite;                                  // its text is the new file
  std::optional<gcode::TimeScale> times = std::nullopt;  // by which the file restates times
};

// Searches `job` and writes its file again with the best order found for each layer. The text has
// been verified against the file from which `job` was read. DeadlineExceeded if `finish_by` leaves
// too little time for anything. REQUIRES: job.gcode is not null.
FileResult<OptimizedFile> OptimizeFile(OptimizerClient& client, const InputJob& job,
                                       const OptimizeFileOptions& options);

// How long writing and verifying a text of `bytes` bytes may take, where `left` is left for the
// search and for that: as long as on an idle machine, twice as much more for each of `load` who
// want a processor beside us, some times as long as reading it took, at most half of `left`, and no
// less than on an idle machine. Searches end this much before `finish_by`.
absl::Duration WritingTime(size_t bytes, double load, absl::Duration reading, absl::Duration left);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_OPTIMIZE_FILE_OPTIMIZE_FILE_H_
