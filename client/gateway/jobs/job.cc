#include "client/gateway/jobs/job.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "absl/strings/ascii.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/work/api_status.h"

namespace traverse::gateway {
namespace {

void SetTime(absl::Time time, google::protobuf::Timestamp& out) {
  const int64_t seconds = absl::ToUnixSeconds(time);
  out.set_seconds(seconds);
  out.set_nanos(
      static_cast<int32_t>(absl::ToInt64Nanoseconds(time - absl::FromUnixSeconds(seconds))));
}

bool IsEnd(v1::Job::State state) {
  return state == v1::Job::STATE_DONE || state == v1::Job::STATE_FAILED;
}

constexpr size_t kMostKeyBytes = 255;

}  // namespace

bool IsIdempotencyKey(std::string_view key) {
  return key.size() <= kMostKeyBytes && std::all_of(key.begin(), key.end(), [](char c) {
           return absl::ascii_isprint(static_cast<unsigned char>(c));
         });
}

Job::Job(std::string id, JobWish wish)
    : id_(std::move(id)),
      wish_(std::move(wish)),
      made_(absl::UnavailableError("the job is under way")) {
  now_.set_id(id_);
  now_.set_name(wish_.request.name);
  now_.set_state(v1::Job::STATE_QUEUED);
  now_.set_revision(1);
  now_.mutable_progress()->set_stage(v1::RewriteProgress::STAGE_QUEUED);
}

bool Job::EndedNow() const { return IsEnd(now_.state()); }

v1::Job Job::Now() const {
  MutexLock lock(mutex_);
  end_told_ = end_told_ || EndedNow();
  return now_;
}

uint64_t Job::Follow(uint64_t known_revision, Reader reader) {
  MutexLock lock(mutex_);
  if (now_.revision() > known_revision) reader.on_change(now_);
  if (EndedNow()) {
    end_told_ = true;
    reader.on_end(absl::OkStatus());
    return 0;
  }
  if (readers_.size() == kMostReaders) {
    readers_.front().reader.on_end(
        absl::ResourceExhaustedError("this job has newer readers; no more than 4 may follow it"));
    readers_.pop_front();
  }
  readers_.push_back({++last_number_, std::move(reader)});
  return last_number_;
}

void Job::Unfollow(uint64_t reader) {
  MutexLock lock(mutex_);
  const auto has_number = [&](const Numbered& one) { return one.number == reader; };
  readers_.erase(std::remove_if(readers_.begin(), readers_.end(), has_number), readers_.end());
}

void Job::Tell() {
  now_.set_revision(now_.revision() + 1);
  for (const Numbered& one : readers_) one.reader.on_change(now_);
  if (!EndedNow()) return;
  end_told_ = end_told_ || !readers_.empty();
  EndReaders(absl::OkStatus());
}

void Job::EndReaders(const absl::Status& why) {
  for (const Numbered& one : readers_) one.reader.on_end(why);
  readers_.clear();
}

void Job::SetProgress(const v1::RewriteProgress& progress) {
  MutexLock lock(mutex_);
  assert(!EndedNow());
  now_.set_state(v1::Job::STATE_RUNNING);
  *now_.mutable_progress() = progress;
  Tell();
}

void Job::End(const absl::StatusOr<RewrittenFile>& made, absl::Time expires) {
  MutexLock lock(mutex_);
  assert(!EndedNow());
  made_ = made;
  expires_ = expires;
  wish_.upload = nullptr;
  SetTime(expires, *now_.mutable_expires_at());
  if (made.ok()) {
    now_.set_state(v1::Job::STATE_DONE);
    *now_.mutable_summary() = made->summary;
  } else {
    now_.set_state(v1::Job::STATE_FAILED);
    now_.mutable_fault()->set_code(static_cast<int>(ApiStatus(made.status()).code()));
    now_.mutable_fault()->set_http_status(HttpStatusOf(made.status().code()));
    now_.mutable_fault()->set_message(std::string(made.status().message()));
  }
  Tell();
}

void Job::Cancel(const absl::Status& why) {
  stop_.request_stop();
  MutexLock lock(mutex_);
  EndReaders(why);
}

void Job::Remind() {
  MutexLock lock(mutex_);
  for (const Numbered& one : readers_) one.reader.on_change(now_);
}

absl::StatusOr<RewrittenFile> Job::made() const {
  MutexLock lock(mutex_);
  end_told_ = end_told_ || EndedNow();
  return made_;
}

bool Job::ended() const {
  MutexLock lock(mutex_);
  return EndedNow();
}

absl::Time Job::expires() const {
  MutexLock lock(mutex_);
  return expires_;
}

bool Job::fetched() const {
  MutexLock lock(mutex_);
  if (now_.state() == v1::Job::STATE_FAILED) return end_told_;
  // Nobody is reading it now.
  return made_.ok() && made_->file->sent_to_end() && made_->file.use_count() == 1;
}

bool Job::may_be_tried_again() const {
  MutexLock lock(mutex_);
  // A status of 4xx says that the file is at fault, but for 499: the work was cut off.
  return now_.state() == v1::Job::STATE_FAILED && now_.fault().http_status() >= 499;
}

}  // namespace traverse::gateway
