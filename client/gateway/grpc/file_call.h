// What the calls of GcodeService share: who calls, a place in the queue, files in the spool, how
// long to wait for the client, one Finish.

#ifndef TRAVERSE_CLIENT_GATEWAY_GRPC_FILE_CALL_H_
#define TRAVERSE_CLIENT_GATEWAY_GRPC_FILE_CALL_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/gateway/core.h"
#include "client/gateway/grpc/live_calls.h"
#include "server/net/connection_job.h"
#include "server/rpc/call_info.h"

namespace traverse::gateway {

// What a call brings. Only one with a file takes a place in the queue.
enum class Brings { kFile, kQuestion };

// A part of the call's reactor, which lives as long as the call. Not thread-safe, but for Waits and
// Rests.
class FileCall {
 public:
  // `method`: without the service's name.
  FileCall(Core& core, LiveCalls& live, grpc::CallbackServerContext& context,
           const std::string& method, Brings brings = Brings::kFile);
  ~FileCall() { Rests(); }
  FileCall(const FileCall&) = delete;
  FileCall& operator=(const FileCall&) = delete;

  // Whether it may go on: the caller is known and has what he needs. Errors are for the client.
  const absl::Status& status() const { return status_; }

  const std::string& caller() const { return info_.caller; }
  const std::string& peer() const { return info_.peer; }
  std::shared_ptr<WorkQueue::Ticket> ticket() const { return ticket_; }

  absl::Time began() const { return began_; }

  // When the file must be ready, so that it can be sent before the call's deadline.
  absl::Time FinishBy() const;

  // A message of `bytes` has arrived. ResourceExhausted if that is more than one may have.
  absl::Status OnMessage(size_t bytes);

  // No more messages will come.
  void OnAllCame();

  // Appends to `file`, which it creates if null. ResourceExhausted, OutOfRange.
  absl::Status Append(const std::string& bytes, std::shared_ptr<SpoolFile>& file) const;

  // From now on the call waits for its client, or no longer; see LiveCalls.
  void Waits() { live_.Waits(&context_, info_.peer); }
  void Rests() { live_.Rests(&context_); }

  // The status for the client. Counts the call. An answer, too, waits until the client lets it in.
  grpc::Status End(const absl::Status& status);

 private:
  Core& core_;
  LiveCalls& live_;
  grpc::CallbackServerContext& context_;
  CallInfo info_;
  const absl::Time began_;
  absl::Time deadline_ = absl::InfiniteFuture();
  absl::Status status_;
  std::shared_ptr<WorkQueue::Ticket> ticket_;
  std::optional<ConnectionJob> job_;
};

// Of one message: a piece of a file has at most 4 MB.
constexpr int64_t kMaxMessageBytes = int64_t{5} << 20;

// The next piece of `file` from `sent` on, which moves, for one message to the client. False where
// `file` is null, at its end, or where it cannot be read (`fault`).
bool ReadPiece(const SpoolFile* file, uint64_t& sent, std::string& out, absl::Status& fault);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GRPC_FILE_CALL_H_
