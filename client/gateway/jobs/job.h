// A file whose work goes on when the request that brought it has ended.

#ifndef TRAVERSE_CLIENT_GATEWAY_JOBS_JOB_H_
#define TRAVERSE_CLIENT_GATEWAY_JOBS_JOB_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/gateway/spool/spool.h"
#include "client/gateway/work/file_worker.h"
#include "engine/base/mutex.h"
#include "traverse/v1/gcode_service.pb.h"

namespace traverse::gateway {

// What a caller asks for.
struct JobWish {
  FileRequest request;
  std::shared_ptr<const SpoolFile> upload;
  std::string key;    // the caller's own, for this file and these options; empty: none
  std::string print;  // equal for equal files with equal options
  std::string route;  // by which it came, and the rest for the log
  std::string peer;
};

// Whether `key` may be JobWish::key: at most 255 printable ASCII characters.
bool IsIdempotencyKey(std::string_view key);

// Thread-safe.
class Job {
 public:
  // Readers at a time; one more ends the oldest, whose client may have gone unnoticed.
  static constexpr size_t kMostReaders = 4;

  // Follows a job. Called with a lock held: must return at once, and call nothing of the job.
  struct Reader {
    std::function<void(const v1::Job&)> on_change;
    std::function<void(const absl::Status&)> on_end;  // OK: the job has ended and that was told
  };

  Job(std::string id, JobWish wish);

  const std::string& id() const { return id_; }
  const std::string& caller() const { return wish_.request.caller; }
  const JobWish& wish() const { return wish_; }
  std::stop_token cancelled() const { return stop_.get_token(); }

  // As it is now, for its caller.
  v1::Job Now() const;

  // Tells `reader` what is newer than `known_revision`, now and until the job ends or Unfollow is
  // called with the number returned.
  uint64_t Follow(uint64_t known_revision, Reader reader);
  void Unfollow(uint64_t reader);

  // The work goes on.
  void SetProgress(const v1::RewriteProgress& progress);

  // It has ended, at `now`, and is kept until `expires`. The upload is given back.
  void End(const absl::StatusOr<RewrittenFile>& made, absl::Time expires);

  // Ends the work and all readers: there is no such job any more.
  void Cancel(const absl::Status& why);

  // Tells the readers again what they know, so that proxies between do not give them up.
  void Remind();

  // What it has made. Unavailable while it is under way, or else its fault.
  absl::StatusOr<RewrittenFile> made() const;

  bool ended() const;
  absl::Time expires() const;  // InfiniteFuture while it is under way

  // Whether its caller has it all: the new file has been sent to its end, or the fault was told.
  bool fetched() const;

  // Whether it failed for a reason that may pass.
  bool may_be_tried_again() const;

 private:
  struct Numbered {
    uint64_t number;
    Reader reader;
  };

  bool EndedNow() const TRAVERSE_REQUIRES(mutex_);
  void Tell() TRAVERSE_REQUIRES(mutex_);
  void EndReaders(const absl::Status& why) TRAVERSE_REQUIRES(mutex_);

  const std::string id_;
  JobWish wish_;  // without the upload once it has ended
  std::stop_source stop_;

  mutable Mutex mutex_;
  v1::Job now_ TRAVERSE_GUARDED_BY(mutex_);
  absl::StatusOr<RewrittenFile> made_ TRAVERSE_GUARDED_BY(mutex_);
  absl::Time expires_ TRAVERSE_GUARDED_BY(mutex_) = absl::InfiniteFuture();
  mutable bool end_told_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::deque<Numbered> readers_ TRAVERSE_GUARDED_BY(mutex_);  // the oldest first
  uint64_t last_number_ TRAVERSE_GUARDED_BY(mutex_) = 0;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_JOBS_JOB_H_
