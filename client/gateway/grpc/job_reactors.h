// The calls of GcodeService about jobs that take or bring more than one message.

#ifndef TRAVERSE_CLIENT_GATEWAY_GRPC_JOB_REACTORS_H_
#define TRAVERSE_CLIENT_GATEWAY_GRPC_JOB_REACTORS_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "client/gateway/core.h"
#include "client/gateway/grpc/file_call.h"
#include "client/gateway/grpc/live_calls.h"
#include "client/gateway/jobs/job_store.h"
#include "engine/base/mutex.h"
#include "traverse/v1/gcode_service.grpc.pb.h"

namespace traverse::gateway {

// Reads a file into the spool and makes a job of it. Deletes itself, as the others do.
class CreateJobReactor : public grpc::ServerReadReactor<v1::CreateJobRequest> {
 public:
  CreateJobReactor(Core& core, LiveCalls& live, grpc::CallbackServerContext& context,
                   v1::CreateJobResponse& response);

  void OnReadDone(bool ok) override;
  void OnDone() override;

 private:
  void Read();
  absl::Status Take();
  absl::Status TakeOptions();
  absl::Status Create();
  void End(const absl::Status& status);

  Core& core_;
  grpc::CallbackServerContext& context_;
  v1::CreateJobResponse& response_;
  FileCall call_;
  v1::CreateJobRequest request_;
  std::optional<JobWish> wish_;
  std::shared_ptr<SpoolFile> upload_;
};

// Tells of a job until it has ended. For a client that reads slowly it keeps the latest state only.
class WatchJobReactor : public grpc::ServerWriteReactor<v1::WatchJobResponse> {
 public:
  WatchJobReactor(Core& core, LiveCalls& live, grpc::CallbackServerContext& context,
                  const v1::WatchJobRequest& request);

  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  absl::Status Follow(const Core& core, const v1::WatchJobRequest& request);
  void End(const absl::Status& status);

  // Starts the next write, or finishes, if it is time.
  void Next() TRAVERSE_REQUIRES(mutex_);

  FileCall call_;
  std::shared_ptr<Job> job_;
  uint64_t reader_ = 0;

  Mutex mutex_;
  v1::WatchJobResponse response_ TRAVERSE_GUARDED_BY(mutex_);
  std::optional<v1::Job> news_ TRAVERSE_GUARDED_BY(mutex_);
  bool writing_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool finished_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::optional<absl::Status> end_ TRAVERSE_GUARDED_BY(mutex_);
};

// Sends what a job has made.
class ReadJobReactor : public grpc::ServerWriteReactor<v1::ReadJobResponse> {
 public:
  ReadJobReactor(Core& core, LiveCalls& live, grpc::CallbackServerContext& context,
                 const v1::ReadJobRequest& request);

  void OnWriteDone(bool ok) override;
  void OnDone() override;

 private:
  absl::Status Open(const Core& core, const v1::ReadJobRequest& request);
  void Next();
  void End(const absl::Status& status);

  FileCall call_;
  std::shared_ptr<const SpoolFile> file_;
  uint64_t sent_ = 0;
  v1::ReadJobResponse response_;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GRPC_JOB_REACTORS_H_
