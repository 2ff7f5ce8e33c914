// One connection: requests one after another, each read, handled and answered.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_SESSION_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_SESSION_H_

#include <poll.h>

#include <algorithm>
#include <array>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <cassert>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/time/clock.h"
#include "client/gateway/http/any_session.h"
#include "client/gateway/http/heads.h"
#include "client/gateway/http/http_server.h"
#include "client/gateway/http/message.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/http/read_faults.h"
#include "client/gateway/http/reply_queue.h"
#include "client/gateway/http/tls_context.h"

namespace traverse::gateway {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

using TlsStream = net::ssl::stream<beast::tcp_stream>;

// REQUIRES: all of it runs on the one thread of `loop`.
template <typename Stream>
class Session : public AnySession, public std::enable_shared_from_this<Session<Stream>> {
 public:
  // `context` belongs to `stream`, or is null.
  Session(std::shared_ptr<net::io_context> loop, Stream stream,
          std::shared_ptr<TlsContext::Context> context, const HttpLimits& limits,
          const HttpHandler& handler, std::string peer_host)
      : loop_(loop),
        context_(std::move(context)),
        stream_(std::move(stream)),
        limits_(limits),
        handler_(handler),
        peer_host_(std::move(peer_host)),
        timer_(*loop),
        wake_(*loop) {}

  // Runs until the connection ends.
  net::awaitable<void> Run() {
    assert(IsInLoop());
    const auto self = this->shared_from_this();
    MayGiveWay();
    if (!co_await Handshake()) co_return;
    bool again = true;
    while (again && !draining_) {
      again = co_await ServeOne();
      if (reply_ != nullptr) std::exchange(reply_, nullptr)->Gone();
    }
    boost::system::error_code error;
    if (unread_) co_await Linger();
    beast::get_lowest_layer(stream_).socket().shutdown(net::ip::tcp::socket::shutdown_both, error);
    timer_.cancel();
  }

  void Drain() override {
    assert(IsInLoop());
    draining_ = true;
    if (waits_for_head_) Lowest().cancel();
  }

  std::optional<std::chrono::steady_clock::time_point> idle_since() const override {
    return idle_since_;
  }
  const std::string& peer_host() const override { return peer_host_; }

  void Close() override {
    assert(IsInLoop());
    idle_since_.reset();
    Lowest().close();
    wake_.cancel();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr size_t kPiece = 131072;

  bool IsInLoop() const { return loop_->get_executor().running_in_this_thread(); }

  // To new connections, see AnySession; from now on, until idle_since_ is reset.
  void MayGiveWay() { idle_since_ = Clock::now(); }

  beast::tcp_stream& Lowest() { return beast::get_lowest_layer(stream_); }

  // From now on operations that take longer than `time` fail; the connection stays. Called for
  // every piece of a body: a timer that fires too early is cheaper than one set again.
  void SetTimer(absl::Duration time) {
    timed_out_ = false;
    deadline_ = Clock::now() + absl::ToChronoMilliseconds(time);
    if (armed_until_ > deadline_) Arm();
  }

  // A handler may take as long as it needs.
  void StopTimer() { deadline_ = Clock::time_point::max(); }

  void Arm() {
    armed_until_ = deadline_;
    timer_.expires_at(deadline_);
    timer_.async_wait(
        [self = this->weak_from_this(), until = deadline_](boost::system::error_code error) {
          const auto session = self.lock();
          if (error || session == nullptr || session->armed_until_ != until) return;
          session->armed_until_ = Clock::time_point::max();
          session->OnTimer();
        });
  }

  void OnTimer() {
    if (deadline_ == Clock::time_point::max()) return;
    if (Clock::now() < deadline_) return Arm();
    timed_out_ = true;
    Lowest().cancel();
  }

  net::awaitable<bool> Handshake() {
    if constexpr (std::is_same_v<Stream, TlsStream>) {
      SetTimer(limits_.head_time);
      boost::system::error_code error;
      co_await stream_.async_handshake(net::ssl::stream_base::server,
                                       net::redirect_error(net::use_awaitable, error));
      if (error) co_return false;
      identities_ = PeerIdentities(stream_.native_handle());
    }
    co_return true;
  }

  // Returns whether another request may come.
  net::awaitable<bool> ServeOne() {
    HeadParser parser;
    parser.header_limit(limits_.max_head_bytes);
    parser.body_limit(std::numeric_limits<uint64_t>::max());  // the handler knows
    SetTimer(limits_.head_time);
    MayGiveWay();
    waits_for_head_ = true;
    boost::system::error_code error;
    co_await http::async_read_header(stream_, buffer_, parser,
                                     net::redirect_error(net::use_awaitable, error));
    waits_for_head_ = false;
    if (error) {
      unread_ = true;
      std::optional<HttpResponse> refusal = HeadFault(error, timed_out_, buffer_.size() > 0);
      if (refusal) co_await Respond(*refusal, false, 11, false);
      co_return false;
    }
    const unsigned version = parser.get().version();
    const bool head_only = parser.get().method() == http::verb::head;
    bool keep = parser.keep_alive() && HasKnownCoding(parser.get());
    HttpDecision decision = Decide(parser);
    if (auto* sink = std::get_if<std::unique_ptr<BodySink>>(&decision)) {
      idle_since_.reset();
      std::optional<HttpResponse> refusal = co_await ReadBody(parser, **sink);
      if (!refusal) {
        reply_ = std::make_shared<ReplyQueue>(Waker());
        (*sink)->Done(reply_);
        sink->reset();
        co_return co_await Answer(version, head_only, keep && !draining_);
      }
      decision = *std::move(refusal);
      MayGiveWay();
    }
    unread_ = !parser.is_done();
    keep = keep && !unread_ && !draining_;
    co_return co_await Respond(std::get<HttpResponse>(decision), head_only, version, keep);
  }

  HttpDecision Decide(const HeadParser& parser) {
    auto request = RequestOf(parser);
    if (auto* refusal = std::get_if<HttpResponse>(&request)) return std::move(*refusal);
    auto& known = std::get<HttpRequest>(request);
    known.peer_host = peer_host_;
    known.identities = identities_;
    return handler_(known);
  }

  // Passes the body to `sink`. Returns a response if it did not end well.
  net::awaitable<std::optional<HttpResponse>> ReadBody(HeadParser& parser, BodySink& sink) {
    boost::system::error_code error;
    const bool wait = beast::iequals(parser.get()[http::field::expect], "100-continue");
    if (wait && !parser.is_done() && buffer_.size() == 0) {
      static const std::string go_on = "HTTP/1.1 100 Continue\r\n\r\n";
      co_await net::async_write(stream_, net::buffer(go_on),
                                net::redirect_error(net::use_awaitable, error));
    }
    parser.eager(true);  // chunks of a few bytes together
    std::vector<char> piece(parser.is_done() ? 0 : kPiece);
    const absl::Time began = absl::Now();
    uint64_t received = 0;
    while (!error && !AllCame(parser, received)) {
      SetTimer(limits_.TimeForPiece(absl::Now() - began, received));
      const size_t got = co_await ReadPiece(parser, received, piece, error);
      received += got;
      if (got == 0) continue;
      std::optional<HttpResponse> refusal = sink.Take({piece.data(), got});
      if (refusal) co_return refusal;
    }
    if (!error) co_return std::nullopt;
    co_return BodyFault(error, timed_out_, received);
  }

  // Reads the next bytes of a body of which `received` came into `piece`. Most bypass the parser,
  // which would only copy them.
  net::awaitable<size_t> ReadPiece(HeadParser& parser, uint64_t received, std::vector<char>& piece,
                                   boost::system::error_code& error) {
    if (IsPlain(parser) && buffer_.size() == 0) {
      const uint64_t left = *parser.content_length() - received;
      const size_t got = co_await stream_.async_read_some(
          net::buffer(piece.data(), std::min<uint64_t>(piece.size(), left)),
          net::redirect_error(net::use_awaitable, error));
      if (error == net::error::eof) error = http::error::partial_message;
      co_return got;
    }
    auto& body = parser.get().body();
    body.data = piece.data();
    body.size = piece.size();
    co_await http::async_read_some(stream_, buffer_, parser,
                                   net::redirect_error(net::use_awaitable, error));
    if (error == http::error::need_buffer) error = {};
    co_return piece.size() - body.size;
  }

  std::function<void()> Waker() {
    return [loop = std::weak_ptr<net::io_context>(loop_), self = this->weak_from_this()] {
      const auto alive = loop.lock();
      if (alive == nullptr) return;
      net::post(*alive, [self] {
        if (const auto session = self.lock()) session->wake_.cancel();
      });
    };
  }

  // Waits until the handler has put something in. Returns false if the client has gone.
  net::awaitable<bool> WaitForReply() {
    constexpr auto kLook = std::chrono::milliseconds(250);
    StopTimer();
    wake_.expires_after(kLook);
    boost::system::error_code error;
    co_await wake_.async_wait(net::redirect_error(net::use_awaitable, error));
    if (!Lowest().socket().is_open()) co_return false;  // it gave way
    pollfd peer = {Lowest().socket().native_handle(), POLLRDHUP, 0};
    const bool gone =
        poll(&peer, 1, 0) > 0 && (peer.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
    co_return !gone;
  }

  // Writes the handler's answer. Returns whether another request may come.
  net::awaitable<bool> Answer(unsigned version, bool head_only, bool keep) {
    const std::shared_ptr<ReplyQueue> reply = reply_;
    std::optional<HttpResponse> head = reply->TakeHead();
    while (!head) {
      if (!co_await WaitForReply()) co_return false;
      head = reply->TakeHead();
    }
    if (!reply->is_worked_on()) MayGiveWay();
    if (!reply->streaming()) co_return co_await Respond(*head, head_only, version, keep);
    const bool chunked = version >= 11;
    if (!co_await WriteHead(*head, version, keep && chunked, std::nullopt)) co_return false;
    while (!reply->ended()) {
      if (!idle_since_ && !reply->is_worked_on()) MayGiveWay();
      std::optional<HttpBody> piece = reply->TakePiece();
      if (!piece) {
        if (!co_await WaitForReply()) co_return false;
        continue;
      }
      if (!co_await WriteBody(*piece, chunked)) co_return false;
    }
    static const std::string last = "0\r\n\r\n";
    if (chunked && !co_await WriteText(last)) co_return false;
    co_return keep&& chunked;
  }

  // Writes a whole response.
  net::awaitable<bool> Respond(const HttpResponse& response, bool head_only, unsigned version,
                               bool keep) {
    const std::string* text = std::get_if<std::string>(&response.body);
    const uint64_t size = text != nullptr
                              ? text->size()
                              : std::get<std::shared_ptr<const SpoolFile>>(response.body)->size();
    if (!co_await WriteHead(response, version, keep, size)) co_return false;
    if (!head_only && !co_await WriteBody(response.body, false)) co_return false;
    co_return keep;
  }

  // `size`: see HeadOf.
  net::awaitable<bool> WriteHead(const HttpResponse& response, unsigned version, bool keep,
                                 std::optional<uint64_t> size) {
    const http::response<http::empty_body> head = HeadOf(response, version, keep, size);
    http::response_serializer<http::empty_body, http::fields> serializer(head);
    SetTimer(limits_.idle_time);
    boost::system::error_code error;
    co_await http::async_write_header(stream_, serializer,
                                      net::redirect_error(net::use_awaitable, error));
    co_return !error;
  }

  net::awaitable<bool> WriteBody(const HttpBody& body, bool chunked) {
    const absl::Time began = absl::Now();
    if (const std::string* text = std::get_if<std::string>(&body)) {
      for (size_t at = 0; at < text->size(); at += kPiece) {
        const size_t size = std::min(kPiece, text->size() - at);
        SetTimer(limits_.TimeForPiece(absl::Now() - began, at));
        if (!co_await WritePiece(text->data() + at, size, chunked)) co_return false;
      }
      co_return true;
    }
    const auto& file = std::get<std::shared_ptr<const SpoolFile>>(body);
    std::vector<char> piece(std::min<uint64_t>(kPiece, file->size()));
    for (uint64_t at = 0; at < file->size();) {
      const absl::StatusOr<size_t> got = file->ReadAt(at, piece.data(), piece.size());
      if (!got.ok() || *got == 0) co_return false;
      SetTimer(limits_.TimeForPiece(absl::Now() - began, at));
      if (!co_await WritePiece(piece.data(), *got, chunked)) co_return false;
      at += *got;
    }
    co_return true;
  }

  net::awaitable<bool> WritePiece(const char* data, size_t size, bool chunked) {
    boost::system::error_code error;
    if (chunked) {
      co_await net::async_write(stream_, http::make_chunk(net::const_buffer(data, size)),
                                net::redirect_error(net::use_awaitable, error));
    } else {
      co_await net::async_write(stream_, net::const_buffer(data, size),
                                net::redirect_error(net::use_awaitable, error));
    }
    if (idle_since_) MayGiveWay();
    co_return !error;
  }

  net::awaitable<bool> WriteText(const std::string& text) {
    SetTimer(limits_.idle_time);
    boost::system::error_code error;
    co_await net::async_write(stream_, net::buffer(text),
                              net::redirect_error(net::use_awaitable, error));
    co_return !error;
  }

  // A client that is still sending would lose the answer with the connection: reads on for a while.
  net::awaitable<void> Linger() {
    constexpr absl::Duration kPatience = absl::Seconds(3);
    boost::system::error_code error;
    if constexpr (!std::is_same_v<Stream, TlsStream>) {
      Lowest().socket().shutdown(net::ip::tcp::socket::shutdown_send, error);
    }
    std::vector<char> scrap(kPiece);
    SetTimer(kPatience);
    while (!error) {
      co_await Lowest().socket().async_read_some(net::buffer(scrap),
                                                 net::redirect_error(net::use_awaitable, error));
    }
  }

  const std::shared_ptr<net::io_context> loop_;
  const std::shared_ptr<TlsContext::Context> context_;
  Stream stream_;
  const HttpLimits& limits_;
  const HttpHandler& handler_;
  const std::string peer_host_;
  std::vector<std::string> identities_;
  beast::flat_buffer buffer_{size_t{2} * kPiece};
  net::steady_timer timer_;
  Clock::time_point deadline_ = Clock::time_point::max();
  Clock::time_point armed_until_ = Clock::time_point::max();  // when the timer fires
  bool timed_out_ = false;
  net::steady_timer wake_;
  std::shared_ptr<ReplyQueue> reply_;  // for the current request
  std::optional<Clock::time_point> idle_since_;
  bool waits_for_head_ = false;
  bool unread_ = false;  // part of a body is unread
  bool draining_ = false;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_SESSION_H_
