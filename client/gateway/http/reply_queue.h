// Carries answers from a handler to a connection.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_REPLY_QUEUE_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_REPLY_QUEUE_H_

#include <deque>
#include <functional>
#include <optional>
#include <utility>

#include "client/gateway/http/message.h"
#include "engine/base/mutex.h"

namespace traverse::gateway {

// Handlers put things in, on any thread; the connection takes them out. Thread-safe.
class ReplyQueue : public HttpReply {
 public:
  // Most text that may wait for the connection; optional pieces beyond it are not taken.
  static constexpr size_t kMaxOptionalBytes = 65536;

  // Calls `wake`, on any thread, when something was put in.
  explicit ReplyQueue(std::function<void()> wake) : wake_(std::move(wake)) {}

  void Send(HttpResponse response) override;
  void Begin(HttpResponse head) override;
  bool Write(HttpBody piece, bool optional) override;
  void End() override;
  void OnGone(std::function<void()> on_gone) override;

  // The head, once it is there, with the whole body unless streaming().
  std::optional<HttpResponse> TakeHead();
  bool streaming() const;

  // The next piece of a stream: all text up to a file.
  std::optional<HttpBody> TakePiece();
  bool ended() const;

  // Whether work goes on that is lost with the connection.
  bool is_worked_on() const;

  // The client has gone.
  void Gone();

 private:
  // Whether anybody waits for more.
  bool Open() const TRAVERSE_REQUIRES(mutex_) { return !gone_ && !ended_; }

  const std::function<void()> wake_;
  mutable Mutex mutex_;
  std::optional<HttpResponse> head_ TRAVERSE_GUARDED_BY(mutex_);
  bool streaming_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool only_watches_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::deque<HttpBody> pieces_ TRAVERSE_GUARDED_BY(mutex_);
  size_t text_bytes_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // of pieces_
  bool ended_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool gone_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::function<void()> on_gone_ TRAVERSE_GUARDED_BY(mutex_);
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_REPLY_QUEUE_H_
