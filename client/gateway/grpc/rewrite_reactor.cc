#include "client/gateway/grpc/rewrite_reactor.h"

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "client/gateway/api/file_routes.h"
#include "client/gateway/api/rewrite_options.h"

namespace traverse::gateway {

RewriteReactor::RewriteReactor(Core& core, LiveCalls& live, grpc::CallbackServerContext& context)
    : core_(core), context_(context), call_(core, live, context, "Rewrite") {
  if (!call_.status().ok()) {
    MutexLock lock(mutex_);
    End(call_.status());
    return;
  }
  Read();
}

void RewriteReactor::Read() {
  call_.Waits();
  StartRead(&request_);
}

void RewriteReactor::OnReadDone(bool ok) {
  if (context_.IsCancelled()) {
    MutexLock lock(mutex_);
    return End(absl::CancelledError("cancelled"));
  }
  if (!ok) return Submit();
  absl::Status status = call_.OnMessage(request_.ByteSizeLong());
  if (status.ok()) status = TakeRequest();
  if (!status.ok()) {
    MutexLock lock(mutex_);
    return End(status);
  }
  Read();
}

absl::Status RewriteReactor::TakeRequest() {
  if (request_.has_options()) {
    if (wanted_) return absl::InvalidArgumentError("options: allowed only in the first message");
    absl::StatusOr<FileRequest> wanted = RequestOf(request_.options());
    if (!wanted.ok()) return wanted.status();
    wanted_ = *std::move(wanted);
    wanted_->caller = call_.caller();
    return absl::OkStatus();
  }
  if (!wanted_) return absl::InvalidArgumentError("options: missing from the first message");
  if (!request_.has_data()) return absl::InvalidArgumentError("a message without data");
  return call_.Append(request_.data(), upload_);
}

void RewriteReactor::Submit() {
  call_.Rests();
  call_.OnAllCame();
  if (upload_ == nullptr) {
    MutexLock lock(mutex_);
    return End(absl::InvalidArgumentError(wanted_ ? "data: the file is missing"
                                                  : "options: missing from the first message"));
  }
  wanted_->finish_by = call_.FinishBy();
  // From now on the task ends the call, so the call outlives it.
  core_.Submit(call_.ticket(), {upload_}, {wanted_->finish_by, stop_.get_token()},
               [this](const absl::Status& may) { Work(may); });
}

void RewriteReactor::Work(const absl::Status& may) {
  const absl::Time began = absl::Now();
  const auto progress = [this](const v1::RewriteProgress& now) {
    MutexLock lock(mutex_);
    progress_ = now;
    Next();
  };
  absl::StatusOr<RewrittenFile> made =
      !may.ok() ? may
      : stop_.stop_requested()
          ? absl::CancelledError("cancelled")
          : core_.worker->Rewrite(*upload_, *wanted_, progress, stop_.get_token());
  const FileRecord record = {"grpc/Rewrite",  call_.caller(),
                             call_.peer(),    wanted_->name,
                             upload_->size(), absl::ToDoubleSeconds(absl::Now() - began)};
  RecordFile(core_, record, made.status(), made.ok() ? &made->summary : nullptr);
  MutexLock lock(mutex_);
  upload_ = nullptr;
  if (!made.ok()) return End(made.status());
  made_ = *std::move(made);
  progress_.reset();
  Next();
}

void RewriteReactor::End(const absl::Status& status) {
  if (!end_) end_ = status;
  Next();
}

// Sets response_ to the next message to send; false if there is none now.
bool RewriteReactor::NextPiece() {
  response_.Clear();
  if (progress_) {
    *response_.mutable_progress() = *std::exchange(progress_, std::nullopt);
    return true;
  }
  if (!made_ || summary_sent_) return false;
  absl::Status fault;
  std::string piece;
  if (ReadPiece(made_->file.get(), file_sent_, piece, fault)) {
    response_.set_data(std::move(piece));
  } else if (fault.ok() && ReadPiece(made_->report.get(), report_sent_, piece, fault)) {
    response_.set_report(std::move(piece));
  } else if (fault.ok()) {
    *response_.mutable_summary() = made_->summary;
    summary_sent_ = true;
  } else {
    end_ = fault;
    return false;
  }
  return true;
}

void RewriteReactor::Next() {
  if (writing_ || finished_) return;
  if (!end_ && NextPiece()) {
    writing_ = true;
    call_.Waits();
    StartWrite(&response_);
    return;
  }
  if (!end_ && summary_sent_) end_ = absl::OkStatus();
  if (!end_) return;
  finished_ = true;
  made_.reset();
  Finish(call_.End(*end_));
}

void RewriteReactor::OnWriteDone(bool ok) {
  MutexLock lock(mutex_);
  // What is made is sent without a pause, and its time is counted as a whole.
  if (!made_) call_.Rests();
  writing_ = false;
  if (ok || end_) return Next();
  stop_.request_stop();
  // A running task ends the call itself.
  if (made_) End(absl::CancelledError("the client does not read"));
}

void RewriteReactor::OnCancel() {
  stop_.request_stop();
  MutexLock lock(mutex_);
  if (made_) End(absl::CancelledError("cancelled"));
}

void RewriteReactor::OnDone() {
  // The caller of Finish may still hold the mutex.
  { MutexLock lock(mutex_); }
  delete this;
}

}  // namespace traverse::gateway
