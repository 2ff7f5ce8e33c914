// One call of GcodeService.Rewrite.

#ifndef TRAVERSE_CLIENT_GATEWAY_GRPC_REWRITE_REACTOR_H_
#define TRAVERSE_CLIENT_GATEWAY_GRPC_REWRITE_REACTOR_H_

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "client/gateway/core.h"
#include "client/gateway/grpc/file_call.h"
#include "client/gateway/grpc/live_calls.h"
#include "engine/base/mutex.h"
#include "traverse/v1/gcode_service.grpc.pb.h"

namespace traverse::gateway {

// Reads into the spool, has the work done, writes from the spool; deletes itself. For a client that
// does not read it keeps only the latest progress.
class RewriteReactor : public grpc::ServerBidiReactor<v1::RewriteRequest, v1::RewriteResponse> {
 public:
  RewriteReactor(Core& core, LiveCalls& live, grpc::CallbackServerContext& context);

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  void Read();
  absl::Status TakeRequest();
  void Submit();
  void Work(const absl::Status& may);  // called by Core::Submit

  // The call has ended; the status is sent when no write is in progress.
  void End(const absl::Status& status) TRAVERSE_REQUIRES(mutex_);

  // Starts the next write, or finishes, if it is time.
  void Next() TRAVERSE_REQUIRES(mutex_);
  bool NextPiece() TRAVERSE_REQUIRES(mutex_);

  Core& core_;
  grpc::CallbackServerContext& context_;
  FileCall call_;
  v1::RewriteRequest request_;
  std::optional<FileRequest> wanted_;
  std::shared_ptr<SpoolFile> upload_;
  std::stop_source stop_;

  Mutex mutex_;
  v1::RewriteResponse response_ TRAVERSE_GUARDED_BY(mutex_);
  std::optional<v1::RewriteProgress> progress_ TRAVERSE_GUARDED_BY(mutex_);
  std::optional<RewrittenFile> made_ TRAVERSE_GUARDED_BY(mutex_);
  uint64_t file_sent_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  uint64_t report_sent_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  bool summary_sent_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool writing_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::optional<absl::Status> end_ TRAVERSE_GUARDED_BY(mutex_);
  bool finished_ TRAVERSE_GUARDED_BY(mutex_) = false;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GRPC_REWRITE_REACTOR_H_
