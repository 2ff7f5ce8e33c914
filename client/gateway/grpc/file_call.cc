#include "client/gateway/grpc/file_call.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/gateway/work/api_status.h"
#include "server/jobs/retry_delay.h"
#include "server/rpc/grpc_status.h"

namespace traverse::gateway {
namespace {

constexpr absl::Duration kRetryDelay = absl::Seconds(5);

// Lets the status, or the first pieces of the file, leave before the deadline.
constexpr absl::Duration kMargin = absl::Milliseconds(300);

}  // namespace

FileCall::FileCall(Core& core, LiveCalls& live, grpc::CallbackServerContext& context,
                   const std::string& method, Brings brings)
    : core_(core),
      live_(live),
      context_(context),
      info_(ReadCallInfo(context, method)),
      began_(absl::Now()) {
  if (info_.deadline) {
    deadline_ = began_ + absl::FromChrono(*info_.deadline - Budget::Clock::now());
  }
  status_ = Authorize(context, *core_.files.auth, info_);
  if (!status_.ok()) return;
  if (brings == Brings::kQuestion) {
    // Its one message is here, and the answer can be asked for again: the connection may give way.
    ConnectionJob(core_.connections, info_.peer).OnAllCame();
    return;
  }
  absl::StatusOr<std::shared_ptr<WorkQueue::Ticket>> ticket = core_.queue->Enter(info_.caller);
  status_ = ticket.status();
  if (!ticket.ok()) return;
  ticket_ = *std::move(ticket);
  job_.emplace(core_.connections, info_.peer);
}

absl::Status FileCall::OnMessage(size_t bytes) {
  job_->OnMessage(static_cast<int64_t>(bytes));
  if (static_cast<int64_t>(bytes) <= kMaxMessageBytes) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrFormat(
      "a message has %d bytes, more than this gateway's limit of %d", bytes, kMaxMessageBytes));
}

void FileCall::OnAllCame() { job_->OnAllCame(); }

absl::Time FileCall::FinishBy() const {
  return std::min(deadline_ - kMargin, absl::Now() + core_.options.max_time);
}

absl::Status FileCall::Append(const std::string& bytes, std::shared_ptr<SpoolFile>& file) const {
  if (file == nullptr) {
    absl::StatusOr<std::shared_ptr<SpoolFile>> made = core_.spool->NewFile(info_.caller);
    if (!made.ok()) return made.status();
    file = *std::move(made);
  }
  const uint64_t most = core_.options.max_file_bytes;
  if (file->size() + bytes.size() > most) {
    return absl::OutOfRangeError(absl::StrFormat("the file is longer than %d bytes", most));
  }
  return file->Append(bytes);
}

grpc::Status FileCall::End(const absl::Status& status) {
  absl::Status told = ApiStatus(status);
  if (absl::IsResourceExhausted(told)) told = WithRetryDelay(told, kRetryDelay);
  core_.metrics.CountRequest(absl::StrCat("grpc/", info_.method),
                             absl::StatusCodeToString(told.code()),
                             absl::ToDoubleSeconds(absl::Now() - began_));
  ticket_ = nullptr;
  Waits();
  return ToGrpcStatus(told);
}

bool ReadPiece(const SpoolFile* file, uint64_t& sent, std::string& out, absl::Status& fault) {
  constexpr uint64_t kPiece = 262144;
  if (file == nullptr || sent >= file->size()) return false;
  out.resize(std::min(kPiece, file->size() - sent));
  const absl::StatusOr<size_t> got = file->ReadAt(sent, out.data(), out.size());
  fault = got.status();
  if (!got.ok()) return false;
  sent += out.size();
  return true;
}

}  // namespace traverse::gateway
