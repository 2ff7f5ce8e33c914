// From a sliced file to the same print with less travel: how it is searched, what is chosen and how
// it is written is decided here, for the command line and for traverse-gateway alike.
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
#include "client/gcode/gcode_job.h"
#include "client/gcode/rewrite.h"
#include "client/gcode/stated_times.h"
#include "client/input/input_job.h"
#include "client/report/run.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {

// Where it ended that could not be done.
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

// What is told while the service searches, on the calling thread. Either may be empty.
struct SearchProgress {
  // A search of so many layers begins. There may be two, one after the other.
  std::function<void(size_t layers)> on_search = {};

  // One more layer is done.
  std::function<void(const v1::LayerResult& layer)> on_layer = {};
};

struct SearchOptions {
  std::optional<v1::Strategy> strategy = std::nullopt;  // unset: the job's own

  // Given to the service with each search. A search that has one is not repeated.
  absl::Duration deadline = absl::InfiniteDuration();

  // The whole file is due then. Searches end so early that the file can still be written and
  // verified, by the best that they have found.
  absl::Time finish_by = absl::InfiniteFuture();

  // Asked to stop, the call ends soon with Cancelled.
  std::stop_token cancel = {};

  SearchProgress progress = {};
};

// One search of `job`. Errors are the service's.
absl::StatusOr<report::JobRun> Search(OptimizerClient& client, const InputJob& job,
                                      const SearchOptions& options);

struct OptimizeFileOptions : SearchOptions {
  GcodeOptions gcode = {};  // those that the job was read with

  // Print times that the file states are set anew, by as much as the estimate changed.
  bool restate_times = false;
};

// A file rewritten.
struct OptimizedFile {
  std::vector<report::JobRun> runs;  // of the searches; the first one is what reports show
  GcodeRewrite rewrite;              // its text is the new file
  std::optional<gcode::TimeScale> times = std::nullopt;  // by which it restates times
};

// Searches `job`, once or twice, and writes its file anew by the best of what was found for each
// layer. The text was verified against the file that `job` was read from. DeadlineExceeded where
// `finish_by` is too near for anything.
// REQUIRES: job.gcode is not null.
FileResult<OptimizedFile> OptimizeFile(OptimizerClient& client, const InputJob& job,
                                       const OptimizeFileOptions& options);

// How long writing and verifying a text of so many bytes may take: what `finish_by` is reduced by
// for the searches.
absl::Duration WritingTime(size_t bytes);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_OPTIMIZE_FILE_OPTIMIZE_FILE_H_
