#include "client/gateway/grpc/job_reactors.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/time/clock.h"
#include "client/gateway/api/rewrite_options.h"

namespace traverse::gateway {
namespace {

// The same for equal messages, whatever the order of their maps.
std::string StableBytes(const google::protobuf::Message& message) {
  std::string bytes;
  google::protobuf::io::StringOutputStream stream(&bytes);
  google::protobuf::io::CodedOutputStream out(&stream);
  out.SetSerializationDeterministic(true);
  message.SerializeToCodedStream(&out);
  out.Trim();
  return bytes;
}

}  // namespace

CreateJobReactor::CreateJobReactor(Core& core, LiveCalls& live,
                                   grpc::CallbackServerContext& context,
                                   v1::CreateJobResponse& response)
    : core_(core), context_(context), response_(response), call_(core, live, context, "CreateJob") {
  if (call_.status().ok()) {
    Read();
  } else {
    End(call_.status());
  }
}

void CreateJobReactor::Read() {
  call_.Waits();
  StartRead(&request_);
}

void CreateJobReactor::OnReadDone(bool ok) {
  if (context_.IsCancelled()) return End(absl::CancelledError("cancelled"));
  if (!ok) {
    call_.OnAllCame();
    return End(Create());
  }
  absl::Status status = call_.OnMessage(request_.ByteSizeLong());
  if (status.ok()) status = Take();
  if (!status.ok()) return End(status);
  Read();
}

absl::Status CreateJobReactor::Take() {
  if (request_.has_options()) {
    if (wish_) return absl::InvalidArgumentError("options: allowed only in the first message");
    return TakeOptions();
  }
  if (!wish_) return absl::InvalidArgumentError("options: missing from the first message");
  if (!request_.has_data()) return absl::InvalidArgumentError("a message without data");
  return call_.Append(request_.data(), upload_);
}

absl::Status CreateJobReactor::TakeOptions() {
  const v1::CreateJobOptions& options = request_.options();
  absl::StatusOr<FileRequest> wanted = RequestOf(options.rewrite());
  if (!wanted.ok()) {
    // Its faults begin with the field: "options.policy: ...".
    return absl::InvalidArgumentError(absl::StrReplaceAll(std::string(wanted.status().message()),
                                                          {{"options.", "options.rewrite."}}));
  }
  if (!IsIdempotencyKey(options.idempotency_key())) {
    return absl::InvalidArgumentError(
        "options.idempotency_key: not at most 255 printable ASCII characters");
  }
  if (options.has_deadline()) {
    wanted->deadline =
        absl::Seconds(options.deadline().seconds()) + absl::Nanoseconds(options.deadline().nanos());
    if (wanted->deadline <= absl::ZeroDuration()) {
      return absl::InvalidArgumentError("options.deadline: not above 0");
    }
  }
  wanted->caller = call_.caller();
  // Who sends a file again has less time left.
  v1::CreateJobOptions identity = options;
  identity.clear_deadline();
  wish_ = JobWish{.request = *std::move(wanted),
                  .upload = nullptr,
                  .key = options.idempotency_key(),
                  .print = StableBytes(identity),
                  .route = "grpc/CreateJob",
                  .peer = call_.peer()};
  return absl::OkStatus();
}

absl::Status CreateJobReactor::Create() {
  if (!wish_) return absl::InvalidArgumentError("options: missing from the first message");
  if (upload_ == nullptr || upload_->size() == 0) {
    return absl::InvalidArgumentError("data: the file is missing or empty");
  }
  wish_->request.finish_by =
      std::min(call_.began() + wish_->request.deadline, absl::Now() + core_.options.max_time);
  absl::StrAppend(&wish_->print, upload_->size(), " ", upload_->checksum());
  wish_->upload = std::move(upload_);
  const absl::StatusOr<std::shared_ptr<Job>> job =
      core_.jobs->Create(call_.ticket(), *std::move(wish_));
  if (job.ok()) *response_.mutable_job() = (*job)->Now();
  return job.status();
}

void CreateJobReactor::End(const absl::Status& status) {
  upload_ = nullptr;
  Finish(call_.End(status));
}

void CreateJobReactor::OnDone() { delete this; }

WatchJobReactor::WatchJobReactor(Core& core, LiveCalls& live, grpc::CallbackServerContext& context,
                                 const v1::WatchJobRequest& request)
    : call_(core, live, context, "WatchJob", Brings::kQuestion) {
  if (absl::Status status = Follow(core, request); !status.ok()) End(status);
}

absl::Status WatchJobReactor::Follow(const Core& core, const v1::WatchJobRequest& request) {
  if (!call_.status().ok()) return call_.status();
  absl::StatusOr<std::shared_ptr<Job>> job = core.jobs->Find(request.id(), call_.caller());
  if (!job.ok()) return job.status();
  job_ = *std::move(job);
  reader_ = job_->Follow(request.known_revision(),
                         {.on_change =
                              [this](const v1::Job& now) {
                                MutexLock lock(mutex_);
                                news_ = now;
                                Next();
                              },
                          .on_end = [this](const absl::Status& why) { End(why); }});
  return absl::OkStatus();
}

void WatchJobReactor::End(const absl::Status& status) {
  MutexLock lock(mutex_);
  if (!end_) end_ = status;
  Next();
}

void WatchJobReactor::Next() {
  if (writing_ || finished_) return;
  if (news_) {
    *response_.mutable_job() = *std::exchange(news_, std::nullopt);
    writing_ = true;
    call_.Waits();
    StartWrite(&response_);
    return;
  }
  if (!end_) return;
  finished_ = true;
  Finish(call_.End(*end_));
}

void WatchJobReactor::OnWriteDone(bool ok) {
  call_.Rests();
  MutexLock lock(mutex_);
  writing_ = false;
  if (!ok) {
    news_.reset();
    if (!end_) end_ = absl::CancelledError("the client does not read");
  }
  Next();
}

void WatchJobReactor::OnCancel() { End(absl::CancelledError("cancelled")); }

void WatchJobReactor::OnDone() {
  if (job_ != nullptr) job_->Unfollow(reader_);
  // The caller of Finish may still hold the mutex.
  { MutexLock lock(mutex_); }
  delete this;
}

ReadJobReactor::ReadJobReactor(Core& core, LiveCalls& live, grpc::CallbackServerContext& context,
                               const v1::ReadJobRequest& request)
    : call_(core, live, context, "ReadJob", Brings::kQuestion) {
  if (absl::Status status = Open(core, request); status.ok()) {
    Next();
  } else {
    End(status);
  }
}

absl::Status ReadJobReactor::Open(const Core& core, const v1::ReadJobRequest& request) {
  if (!call_.status().ok()) return call_.status();
  const absl::StatusOr<std::shared_ptr<Job>> job = core.jobs->Find(request.id(), call_.caller());
  if (!job.ok()) return job.status();
  const absl::StatusOr<RewrittenFile> made = (*job)->made();
  if (!made.ok()) return made.status();
  file_ = request.report() ? made->report : made->file;
  if (file_ == nullptr) return absl::NotFoundError("no report was asked for");
  if (request.offset() > file_->size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("offset: the file has ", file_->size(), " bytes"));
  }
  sent_ = request.offset();
  return absl::OkStatus();
}

void ReadJobReactor::Next() {
  absl::Status fault;
  if (!ReadPiece(file_.get(), sent_, *response_.mutable_data(), fault)) {
    if (fault.ok()) file_->NoteSentToEnd();
    return End(fault);
  }
  call_.Waits();
  StartWrite(&response_);
}

void ReadJobReactor::OnWriteDone(bool ok) {
  if (!ok) return End(absl::CancelledError("the client does not read"));
  Next();
}

void ReadJobReactor::End(const absl::Status& status) {
  file_ = nullptr;
  Finish(call_.End(status));
}

void ReadJobReactor::OnDone() { delete this; }

}  // namespace traverse::gateway
