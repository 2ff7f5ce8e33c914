// What is done with a file: by the same functions as the command line.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_FILE_WORKER_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_FILE_WORKER_H_

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/containers/container.h"
#include "client/formats/read_input.h"
#include "client/gateway/spool/spool.h"
#include "client/gcode/gcode_options.h"
#include "client/gcode/verify/permissions.h"
#include "client/optimize_file/job_settings.h"
#include "traverse/v1/gcode_service.pb.h"
#include "traverse/v1/options.pb.h"

namespace traverse {
class OptimizerClient;
}

namespace traverse::gateway {

// What a caller wants of a file.
struct FileRequest {
  std::string name = "file.gcode";
  std::string caller;  // whose the answer is
  GcodeOptions gcode;
  JobSettings settings;
  std::optional<v1::Strategy> strategy;
  // Of a strategy that is not named: options of the file's own one.
  std::vector<std::pair<std::string, std::string>> strategy_options;
  absl::Duration deadline = absl::InfiniteDuration();  // as of `traverse optimize --deadline`
  absl::Time finish_by = absl::InfiniteFuture();
  bool report = false;
  PlateOptions plates;
  std::optional<ContainerKind> container;  // of what goes back; unset: as it came
  bool restate_times = false;
  bool only_new = false;  // AlreadyExists for a file that Traverse has optimised before
};

struct RewrittenFile {
  std::shared_ptr<const SpoolFile> file;
  std::shared_ptr<const SpoolFile> report;  // null unless it was asked for
  v1::RewriteSummary summary;
};

using ProgressSink = std::function<void(const v1::RewriteProgress&)>;

// Thread-safe.
class FileWorker {
 public:
  // Files longer than `max_file_bytes`, when they are unpacked, are refused. Both outlive it.
  FileWorker(OptimizerClient& client, Spool& spool, uint64_t max_file_bytes)
      : client_(client), spool_(spool), max_file_bytes_(max_file_bytes) {}

  // Errors: InvalidArgument for a file or settings that cannot be read; Unimplemented for a file
  // that is none of a slicer; OutOfRange for one too long; FailedPrecondition where it would not
  // print the same; DeadlineExceeded; Cancelled; and the service's.
  absl::StatusOr<RewrittenFile> Rewrite(const SpoolFile& upload, const FileRequest& request,
                                        const ProgressSink& progress,
                                        const std::stop_token& cancel);

  // Errors of this and of Verify: as above. Both end by request.finish_by, or `until`.
  absl::StatusOr<v1::InspectResponse> Inspect(const SpoolFile& upload, const FileRequest& request,
                                              const std::stop_token& cancel);

  // `permissions`: what may differ; unset: as the optimised file states.
  absl::StatusOr<v1::VerifyResponse> Verify(const SpoolFile& original, const SpoolFile& optimised,
                                            const std::optional<GivenPermissions>& permissions,
                                            absl::Time until, const std::stop_token& cancel);

 private:
  // All that is done about one file: its parts, one after another.
  struct Work;

  absl::StatusOr<std::string> Unpacked(const SpoolFile& upload, const std::string& name) const;
  absl::StatusOr<InputFile> Open(const SpoolFile& upload, const FileRequest& request) const;
  absl::StatusOr<RewrittenFile> RewriteParts(const SpoolFile& upload, const FileRequest& request,
                                             const ProgressSink& progress,
                                             const std::stop_token& cancel);
  absl::Status RewritePart(Work& work, size_t index);
  absl::StatusOr<RewrittenFile> Finish(Work& work);

  OptimizerClient& client_;
  Spool& spool_;
  const uint64_t max_file_bytes_;
};

// Whether G-code begins, within its comments, with the line that Traverse adds.
bool HasOurLine(std::string_view text);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_FILE_WORKER_H_
