// One connection: requests one after another, each read, handled and answered.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_SESSION_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_SESSION_H_

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/time/time.h"
#include "client/gateway/http/awaitable.h"
#include "client/gateway/http/connection.h"
#include "client/gateway/http/heads.h"
#include "client/gateway/http/http_server.h"
#include "client/gateway/http/message.h"
#include "client/gateway/http/reply_queue.h"

namespace traverse::gateway {

// REQUIRES: all of it runs on the one thread of `loop`.
class Session : public std::enable_shared_from_this<Session> {
 public:
  // `limits` and `handler` outlive it.
  Session(std::shared_ptr<boost::asio::io_context> loop, std::unique_ptr<Connection> connection,
          const HttpLimits& limits, const HttpHandler& handler, std::string peer_host);

  // Runs until the connection ends.
  Awaitable<void> Run();

  // Ends it if it waits for a request; otherwise it ends after the current one.
  void Drain();

  // Since when it waits for a request or for the rest of its head, or has sent nothing of an answer
  // for which nobody works any more. Nothing if its client's work would be lost with it.
  std::optional<std::chrono::steady_clock::time_point> idle_since() const { return idle_since_; }
  const std::string& peer_host() const { return peer_host_; }

  // Ends it at once.
  void Close();

 private:
  using Clock = std::chrono::steady_clock;
  using Error = boost::system::error_code;

  bool IsInLoop() const;

  // To new connections, see idle_since(); from now on, until idle_since_ is reset.
  void MayGiveWay() { idle_since_ = Clock::now(); }

  // From now on operations that take longer than `time` fail; the connection stays. Called for
  // every piece of a body: a timer that fires too early is cheaper than one set again.
  void SetTimer(absl::Duration time);
  // A handler may take as long as it needs.
  void StopTimer() { deadline_ = Clock::time_point::max(); }
  void Arm();
  void OnTimer();

  // Ends what waits for the client.
  void Cancel();

  // Those of the connection, which also end in an error if the timer fired meanwhile.
  Awaitable<size_t> ReadSome(boost::asio::mutable_buffer into, Error& error);
  Awaitable<void> Write(Connection::Pieces pieces, Error& error);

  // Returns whether another request may come.
  Awaitable<bool> ServeOne();
  HttpDecision Decide(const HeadParser& parser);

  Awaitable<void> ReadHead(HeadParser& parser, Error& error);

  // Gives `parser` what has come, and what comes until it has got on. Errors are Beast's.
  Awaitable<void> Parse(HeadParser& parser, Error& error);

  // Waits for bytes. False: there are none to parse; `error` says why, if it is one.
  Awaitable<bool> ReadMore(HeadParser& parser, Error& error);

  // Passes the body to `sink`. Returns a response if it did not end well.
  Awaitable<std::optional<HttpResponse>> ReadBody(HeadParser& parser, BodySink& sink);

  // Reads the next bytes of a body of which `received` came into `piece`. Most bypass the parser,
  // which would only copy them.
  Awaitable<size_t> ReadPiece(HeadParser& parser, uint64_t received, std::vector<char>& piece,
                              Error& error);

  std::function<void()> Waker();

  // Waits until the handler has put something in. Returns false if the client has gone.
  Awaitable<bool> WaitForReply();

  // Writes the handler's answer. Returns whether another request may come.
  Awaitable<bool> Answer(unsigned version, bool head_only, bool keep);

  // Writes a whole response.
  Awaitable<bool> Respond(const HttpResponse& response, bool head_only, unsigned version,
                          bool keep);
  Awaitable<bool> WriteBody(const HttpBody& body, bool chunked);
  Awaitable<bool> WritePiece(std::string_view piece, bool chunked);
  Awaitable<bool> WriteText(std::string_view text);

  // A client that is still sending would lose the answer with the connection: reads on for a while.
  Awaitable<void> Linger();

  const std::shared_ptr<boost::asio::io_context> loop_;
  const std::unique_ptr<Connection> connection_;
  const HttpLimits& limits_;
  const HttpHandler& handler_;
  const std::string peer_host_;
  std::vector<std::string> identities_;
  boost::beast::flat_buffer buffer_;
  boost::asio::steady_timer timer_;
  Clock::time_point deadline_ = Clock::time_point::max();
  Clock::time_point armed_until_ = Clock::time_point::max();  // when the timer fires
  bool timed_out_ = false;
  boost::asio::steady_timer wake_;
  std::shared_ptr<ReplyQueue> reply_;  // for the current request
  std::optional<Clock::time_point> idle_since_;
  bool waits_for_head_ = false;
  bool unread_ = false;  // part of a body is unread
  bool draining_ = false;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_SESSION_H_
