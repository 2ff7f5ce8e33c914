#include "server/jobs/job_run.h"

#include <new>

namespace traverse {
namespace {

// The window always takes this many layers, whatever their size: a layer may be answered only when
// the four behind it are solved, and if a cleaning is due after the last of these, the engine
// solves it only when it knows whether another one follows.
constexpr int64_t kLeastLayers = 6;

}  // namespace

absl::Status NoMemory() {
  return absl::ResourceExhaustedError("the server has not enough memory for this job");
}

void JobRun::Start(const Options& options, const JobSpec& spec, std::unique_ptr<Strategy> strategy,
                   Executor& executor) {
  // There may be no memory for it. Nobody waits for the end of what has not begun.
  std::shared_ptr<Job> job = Job::Start(spec, std::move(strategy), executor, *this);
  MutexLock lock(mutex_);
  if (abort_) return;
  options_ = options;
  engine_done_ = false;
  job_ = std::move(job);
  for (const LabelledLayer& layer : backlog_) {
    if (layer.label.fault.empty()) job_->Announce(layer.layer.plan);
  }
  if (closed_) job_->AnnounceEnd();
}

void JobRun::Add(LabelledLayer layer) {
  MutexLock lock(mutex_);
  NoteProgress();
  if (abort_) return;
  if (job_ != nullptr && layer.label.fault.empty()) job_->Announce(layer.layer.plan);
  backlog_.push_back(std::move(layer));
}

void JobRun::Push() { Pump(/*feed=*/true); }

void JobRun::Close() {
  {
    MutexLock lock(mutex_);
    closed_ = true;
    if (job_ != nullptr) job_->AnnounceEnd();
  }
  Pump(/*feed=*/true);
}

bool JobRun::AskForRoom() {
  MutexLock lock(mutex_);
  room_wanted_ = !HasRoom() || (window_layers_ >= kLeastLayers && !port_.MayBringMore());
  return !room_wanted_;
}

void JobRun::OnWriteDone(bool ok) {
  {
    MutexLock lock(mutex_);
    NoteProgress();
    window_layers_ -= writing_->layers;
    window_points_ -= writing_->points;
    writing_.reset();
  }
  if (ok) {
    Pump(/*feed=*/true);
  } else {
    Abort(absl::CancelledError("the caller went away"));
    Pump(/*feed=*/false);
  }
}

void JobRun::Abort(const absl::Status& status) {
  std::shared_ptr<Job> job;
  std::deque<LabelledLayer> backlog;
  {
    MutexLock lock(mutex_);
    if (abort_ || finished_) return;
    abort_ = status;
    backlog.swap(backlog_);
    early_.clear();
    out_.clear();
    job = job_;
    ++holds_;  // the port is used
  }
  if (job != nullptr) job->Cancel();
  if (!backlog.empty()) port_.Discard(std::move(backlog));
  Release();
}

bool JobRun::Stalled(std::chrono::steady_clock::duration time) const {
  const bool callers_turn = writing_.has_value() || !closed_;
  return !finished_ && callers_turn && !port_.IsWorkedOn() &&
         std::chrono::steady_clock::now() - progress_ >= time;
}

bool JobRun::IsStalled(std::chrono::steady_clock::duration time) const {
  MutexLock lock(mutex_);
  return Stalled(time);
}

void JobRun::AbortIfStalled(std::chrono::steady_clock::duration time, const absl::Status& status) {
  bool unread = false;
  {
    MutexLock lock(mutex_);
    if (!Stalled(time)) return;
    unread = writing_.has_value();
    if (abort_ && !unread) return;
    ++holds_;
  }
  Abort(status);
  if (unread) port_.CancelCall();
  Release();
}

bool JobRun::HasEnded(std::chrono::steady_clock::duration time) const {
  MutexLock lock(mutex_);
  return finished_ && std::chrono::steady_clock::now() - progress_ >= time;
}

bool JobRun::Hold() {
  MutexLock lock(mutex_);
  if (finished_) return false;
  ++holds_;
  return true;
}

void JobRun::Release() {
  {
    MutexLock lock(mutex_);
    --holds_;
  }
  Pump(/*feed=*/false);
}

bool JobRun::waits_for_message() const {
  MutexLock lock(mutex_);
  return !closed_ && !abort_;
}

std::chrono::steady_clock::time_point JobRun::progress() const {
  MutexLock lock(mutex_);
  return progress_;
}

bool JobRun::closed() const {
  MutexLock lock(mutex_);
  return closed_;
}

bool JobRun::aborted() const {
  MutexLock lock(mutex_);
  return abort_.has_value();
}

void JobRun::OnLayer(LayerOutcome outcome) {
  try {
    TakeLayer(std::move(outcome));
  } catch (const std::bad_alloc&) {
    Abort(NoMemory());
  }
}

void JobRun::TakeLayer(LayerOutcome outcome) {
  LayerLabel label;
  {
    MutexLock lock(mutex_);
    if (abort_) return;
    const auto found = labels_.find(outcome.index);
    label = found->second;
    labels_.erase(found);
  }
  outcome.index = label.index;
  std::string message = port_.EncodeLayer(outcome, label);
  {
    MutexLock lock(mutex_);
    if (abort_) return;
    NoteProgress();
    Queue(outcome.index, {std::move(message), 1, label.points});
  }
  // No feeding: the engine is in the middle of this call.
  Pump(/*feed=*/false);
}

void JobRun::OnDone() {
  // Once engine_done_ is seen by another thread, that one may end the job and give up the run.
  const std::shared_ptr<JobRun> self = shared_from_this();
  bool summary = false;
  {
    MutexLock lock(mutex_);
    summary = !abort_;
  }
  std::string message;
  try {
    if (summary) message = port_.EncodeSummary();
  } catch (const std::bad_alloc&) {
    Abort(NoMemory());
  }
  {
    MutexLock lock(mutex_);
    engine_done_ = true;
    if (!abort_) out_.push_back({std::move(message), 0, 0});
  }
  Pump(/*feed=*/false);
}

void JobRun::Queue(uint64_t index, Outgoing outgoing) {
  // Without an order, whatever is ready is next.
  early_.emplace(options_.build_order ? index : next_out_, std::move(outgoing));
  for (auto next = early_.find(next_out_); next != early_.end(); next = early_.find(next_out_)) {
    if (next->second.fault) ++window_layers_;
    out_.push_back(std::move(next->second));
    early_.erase(next);
    ++next_out_;
  }
}

bool JobRun::FitsWindow(int64_t points) const {
  return window_layers_ < kLeastLayers || (window_layers_ < options_.window.layers &&
                                           window_points_ + points <= options_.window.points);
}

bool JobRun::HasRoom() const { return backlog_.empty() && FitsWindow(1); }

void JobRun::Feed() {
  MutexLock lock(mutex_);
  if (feeding_ || job_ == nullptr) return;
  feeding_ = true;
  while (!abort_ && !backlog_.empty() && FitsWindow(backlog_.front().label.points)) {
    LabelledLayer next = std::move(backlog_.front());
    backlog_.pop_front();
    next.label.index = next_position_++;
    if (!next.label.fault.empty()) {
      Queue(next.label.index, {port_.EncodeFault(next.label), 1, 0, /*fault=*/true});
      continue;
    }
    ++window_layers_;
    window_points_ += next.label.points;
    labels_[next_index_++] = next.label;
    const std::shared_ptr<Job> job = job_;
    lock.Unlock();
    job->Add(std::move(next.layer));
    lock.Lock();
  }
  feeding_ = false;
  if (closed_ && backlog_.empty() && !engine_closed_ && !abort_) {
    engine_closed_ = true;
    const std::shared_ptr<Job> job = job_;
    lock.Unlock();
    job->Close();
  }
}

void JobRun::Pump(bool feed) {
  // Finish, here or in another thread, may give up the last other reference.
  const std::shared_ptr<JobRun> self = shared_from_this();
  try {
    if (feed) Feed();
  } catch (const std::bad_alloc&) {
    Abort(NoMemory());
  }
  MutexLock lock(mutex_);
  bool write = false;
  bool more_follows = false;
  std::string message;
  if (!writing_ && !out_.empty()) {
    write = true;
    writing_ = std::move(out_.front());
    out_.pop_front();
    message = std::move(writing_->message);
    // gRPC holds back a first message, with the headers, as long as it expects more to follow.
    more_follows = begun_writing_ && (!out_.empty() || engine_done_);
    begun_writing_ = true;
  }
  const bool ended = engine_done_ && (abort_ || closed_);
  const bool finish = !finished_ && !writing_ && ended && holds_ == 0;
  if (finish) {
    finished_ = true;
    NoteProgress();
  }
  const bool room = !finished_ && !abort_ && room_wanted_ && HasRoom();
  if (room) {
    room_wanted_ = false;
    ++holds_;  // otherwise a cancel could end the job, and delete the port, before OnRoom is called
  }
  const absl::Status status = abort_.value_or(absl::OkStatus());
  lock.Unlock();
  // A write in progress keeps the port, but its completion may finish the job in another
  // thread.
  if (write) port_.StartWrite(std::move(message), more_follows);
  if (finish) port_.Finish(status);
  if (room) {
    port_.OnRoom();
    Release();
  }
}

}  // namespace traverse
