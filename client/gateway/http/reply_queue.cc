#include "client/gateway/http/reply_queue.h"

namespace traverse::gateway {
namespace {

size_t TextBytes(const HttpBody& body) {
  const std::string* text = std::get_if<std::string>(&body);
  return text == nullptr ? 0 : text->size();
}

}  // namespace

void ReplyQueue::Send(HttpResponse response) {
  {
    MutexLock lock(mutex_);
    if (!Open()) return;
    head_ = std::move(response);
    ended_ = true;
  }
  wake_();
}

void ReplyQueue::Begin(HttpResponse head) {
  {
    MutexLock lock(mutex_);
    if (!Open()) return;
    only_watches_ = head.only_watches;
    head_ = std::move(head);
    streaming_ = true;
  }
  wake_();
}

bool ReplyQueue::Write(HttpBody piece, bool optional) {
  {
    MutexLock lock(mutex_);
    if (!Open()) return true;  // nobody misses it
    std::string* const text = std::get_if<std::string>(&piece);
    const bool has_room =
        text != nullptr ? text_bytes_ + text->size() <= kMaxOptionalBytes : pieces_.empty();
    if (optional && !has_room) return false;
    text_bytes_ += TextBytes(piece);
    // Lines that come faster than they are sent go together. The connection is up already.
    std::string* const before =
        pieces_.empty() ? nullptr : std::get_if<std::string>(&pieces_.back());
    if (text != nullptr && before != nullptr) {
      before->append(*text);
      return true;
    }
    pieces_.push_back(std::move(piece));
  }
  wake_();
  return true;
}

void ReplyQueue::End() {
  {
    MutexLock lock(mutex_);
    if (!Open()) return;
    ended_ = true;
  }
  wake_();
}

void ReplyQueue::OnGone(std::function<void()> on_gone) {
  {
    MutexLock lock(mutex_);
    if (!gone_) {
      on_gone_ = std::move(on_gone);
      return;
    }
  }
  on_gone();
}

std::optional<HttpResponse> ReplyQueue::TakeHead() {
  MutexLock lock(mutex_);
  return std::exchange(head_, std::nullopt);
}

bool ReplyQueue::streaming() const {
  MutexLock lock(mutex_);
  return streaming_;
}

std::optional<HttpBody> ReplyQueue::TakePiece() {
  MutexLock lock(mutex_);
  if (pieces_.empty()) return std::nullopt;
  HttpBody piece = std::move(pieces_.front());
  pieces_.pop_front();
  text_bytes_ -= TextBytes(piece);
  return piece;
}

bool ReplyQueue::ended() const {
  MutexLock lock(mutex_);
  return ended_ && pieces_.empty();
}

bool ReplyQueue::is_worked_on() const {
  MutexLock lock(mutex_);
  return !ended_ && !only_watches_;
}

void ReplyQueue::Gone() {
  std::function<void()> on_gone;
  {
    MutexLock lock(mutex_);
    if (gone_) return;
    gone_ = true;
    pieces_.clear();
    on_gone = std::exchange(on_gone_, nullptr);
  }
  if (on_gone) on_gone();
}

}  // namespace traverse::gateway
