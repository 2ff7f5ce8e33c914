#include "client/gateway/http/session.h"

#include <poll.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/read_size.hpp>
#include <cassert>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/http/read_faults.h"

namespace traverse::gateway {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr size_t kPiece = 131072;

Connection::Pieces OnePiece(std::string_view text) { return {net::buffer(text), {}, {}}; }

}  // namespace

Session::Session(std::shared_ptr<net::io_context> loop, std::unique_ptr<Connection> connection,
                 const HttpLimits& limits, const HttpHandler& handler, std::string peer_host)
    : loop_(std::move(loop)),
      connection_(std::move(connection)),
      limits_(limits),
      handler_(handler),
      peer_host_(std::move(peer_host)),
      buffer_(size_t{2} * kPiece),
      timer_(*loop_),
      wake_(*loop_) {}

bool Session::IsInLoop() const { return loop_->get_executor().running_in_this_thread(); }

Awaitable<void> Session::Run() {
  assert(IsInLoop());
  const auto self = shared_from_this();
  MayGiveWay();
  SetTimer(limits_.head_time);
  Error error;
  waits_for_head_ = true;
  identities_ = co_await connection_->Begin(error);
  waits_for_head_ = false;
  if (error) co_return;
  bool again = true;
  while (again && !draining_) {
    again = co_await ServeOne();
    if (reply_ != nullptr) std::exchange(reply_, nullptr)->Gone();
  }
  if (unread_) co_await Linger();
  connection_->socket().shutdown(net::ip::tcp::socket::shutdown_both, error);
  timer_.cancel();
}

void Session::Drain() {
  assert(IsInLoop());
  draining_ = true;
  if (waits_for_head_) Cancel();
}

void Session::Close() {
  assert(IsInLoop());
  idle_since_.reset();
  Error error;
  connection_->socket().close(error);
  wake_.cancel();
}

void Session::Cancel() {
  Error error;
  connection_->socket().cancel(error);
}

void Session::SetTimer(absl::Duration time) {
  timed_out_ = false;
  deadline_ = Clock::now() + absl::ToChronoMilliseconds(time);
  if (armed_until_ > deadline_) Arm();
}

void Session::Arm() {
  armed_until_ = deadline_;
  timer_.expires_at(deadline_);
  timer_.async_wait([self = weak_from_this(), until = deadline_](Error error) {
    const auto session = self.lock();
    if (error || session == nullptr || session->armed_until_ != until) return;
    session->armed_until_ = Clock::time_point::max();
    session->OnTimer();
  });
}

void Session::OnTimer() {
  if (deadline_ == Clock::time_point::max()) return;
  if (Clock::now() < deadline_) return Arm();
  timed_out_ = true;
  Cancel();
  // What has just ended by itself was not cancelled, and the next part of it may begin.
  constexpr auto kSoon = std::chrono::milliseconds(100);
  deadline_ = Clock::now() + kSoon;
  Arm();
}

Awaitable<size_t> Session::ReadSome(net::mutable_buffer into, Error& error) {
  const size_t got = co_await connection_->ReadSome(into, error);
  if (!error && timed_out_) error = net::error::operation_aborted;
  co_return got;
}

Awaitable<void> Session::Write(Connection::Pieces pieces, Error& error) {
  co_await connection_->Write(std::move(pieces), error);
  if (!error && timed_out_) error = net::error::operation_aborted;
}

Awaitable<bool> Session::ServeOne() {
  HeadParser parser;
  parser.header_limit(limits_.max_head_bytes);
  parser.body_limit(std::numeric_limits<uint64_t>::max());  // the handler knows
  SetTimer(limits_.head_time);
  MayGiveWay();
  Error error;
  co_await ReadHead(parser, error);
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

HttpDecision Session::Decide(const HeadParser& parser) {
  auto request = RequestOf(parser);
  if (auto* refusal = std::get_if<HttpResponse>(&request)) return std::move(*refusal);
  auto& known = std::get<HttpRequest>(request);
  known.peer_host = peer_host_;
  known.identities = identities_;
  return handler_(known);
}

Awaitable<void> Session::ReadHead(HeadParser& parser, Error& error) {
  waits_for_head_ = true;
  while (!error && !parser.is_header_done()) co_await Parse(parser, error);
  waits_for_head_ = false;
}

Awaitable<void> Session::Parse(HeadParser& parser, Error& error) {
  for (bool more = buffer_.size() == 0;; more = true) {
    if (more && !co_await ReadMore(parser, error)) co_return;
    buffer_.consume(parser.put(buffer_.data(), error));
    if (error != http::error::need_more) co_return;
  }
}

Awaitable<bool> Session::ReadMore(HeadParser& parser, Error& error) {
  constexpr size_t kMost = 65536;
  const size_t room = beast::read_size(buffer_, kMost);
  error = {};
  if (room == 0) {
    error = http::error::buffer_overflow;
    co_return false;
  }
  buffer_.commit(co_await ReadSome(buffer_.prepare(room), error));
  if (error == net::error::eof) {
    error = {};
    if (parser.got_some()) {
      parser.put_eof(error);
    } else {
      error = http::error::end_of_stream;
    }
    co_return false;
  }
  co_return !error;
}

Awaitable<std::optional<HttpResponse>> Session::ReadBody(HeadParser& parser, BodySink& sink) {
  Error error;
  const bool wait = beast::iequals(parser.get()[http::field::expect], "100-continue");
  if (wait && !parser.is_done() && buffer_.size() == 0) {
    co_await Write(OnePiece("HTTP/1.1 100 Continue\r\n\r\n"), error);
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

Awaitable<size_t> Session::ReadPiece(HeadParser& parser, uint64_t received,
                                     std::vector<char>& piece, Error& error) {
  if (IsPlain(parser) && buffer_.size() == 0) {
    const uint64_t left = *parser.content_length() - received;
    const size_t got =
        co_await ReadSome(net::buffer(piece.data(), std::min<uint64_t>(piece.size(), left)), error);
    if (error == net::error::eof) error = http::error::partial_message;
    co_return got;
  }
  auto& body = parser.get().body();
  body.data = piece.data();
  body.size = piece.size();
  co_await Parse(parser, error);
  if (error == http::error::need_buffer) error = {};
  co_return piece.size() - body.size;
}

std::function<void()> Session::Waker() {
  return [loop = std::weak_ptr<net::io_context>(loop_), self = weak_from_this()] {
    const auto alive = loop.lock();
    if (alive == nullptr) return;
    net::post(*alive, [self] {
      if (const auto session = self.lock()) session->wake_.cancel();
    });
  };
}

Awaitable<bool> Session::WaitForReply() {
  constexpr auto kLook = std::chrono::milliseconds(250);
  StopTimer();
  wake_.expires_after(kLook);
  Error error;
  co_await wake_.async_wait(net::redirect_error(net::use_awaitable, error));
  if (!connection_->socket().is_open()) co_return false;  // it gave way
  pollfd peer = {connection_->socket().native_handle(), POLLRDHUP, 0};
  const bool gone = poll(&peer, 1, 0) > 0 && (peer.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
  co_return !gone;
}

Awaitable<bool> Session::Answer(unsigned version, bool head_only, bool keep) {
  const std::shared_ptr<ReplyQueue> reply = reply_;
  std::optional<HttpResponse> head = reply->TakeHead();
  while (!head) {
    if (!co_await WaitForReply()) co_return false;
    head = reply->TakeHead();
  }
  if (!reply->is_worked_on()) MayGiveWay();
  if (!reply->streaming()) co_return co_await Respond(*head, head_only, version, keep);
  const bool chunked = version >= 11;
  if (!co_await WriteText(HeadOf(*head, version, keep && chunked, std::nullopt))) co_return false;
  while (!reply->ended()) {
    if (!idle_since_ && !reply->is_worked_on()) MayGiveWay();
    std::optional<HttpBody> piece = reply->TakePiece();
    if (!piece) {
      if (!co_await WaitForReply()) co_return false;
      continue;
    }
    if (!co_await WriteBody(*piece, chunked)) co_return false;
  }
  if (chunked && !co_await WriteText("0\r\n\r\n")) co_return false;
  co_return keep&& chunked;
}

Awaitable<bool> Session::Respond(const HttpResponse& response, bool head_only, unsigned version,
                                 bool keep) {
  const std::string* text = std::get_if<std::string>(&response.body);
  const uint64_t size = text != nullptr
                            ? text->size()
                            : std::get<std::shared_ptr<const SpoolFile>>(response.body)->size();
  if (!co_await WriteText(HeadOf(response, version, keep, size))) co_return false;
  if (!head_only && !co_await WriteBody(response.body, false)) co_return false;
  co_return keep;
}

Awaitable<bool> Session::WriteBody(const HttpBody& body, bool chunked) {
  const absl::Time began = absl::Now();
  if (const std::string* text = std::get_if<std::string>(&body)) {
    for (size_t at = 0; at < text->size(); at += kPiece) {
      const size_t size = std::min(kPiece, text->size() - at);
      SetTimer(limits_.TimeForPiece(absl::Now() - began, at));
      if (!co_await WritePiece({text->data() + at, size}, chunked)) co_return false;
    }
    co_return true;
  }
  const auto& file = std::get<std::shared_ptr<const SpoolFile>>(body);
  std::vector<char> piece(std::min<uint64_t>(kPiece, file->size()));
  for (uint64_t at = 0; at < file->size();) {
    const absl::StatusOr<size_t> got = file->ReadAt(at, piece.data(), piece.size());
    if (!got.ok() || *got == 0) co_return false;
    SetTimer(limits_.TimeForPiece(absl::Now() - began, at));
    if (!co_await WritePiece({piece.data(), *got}, chunked)) co_return false;
    at += *got;
  }
  file->NoteSentToEnd();
  co_return true;
}

Awaitable<bool> Session::WritePiece(std::string_view piece, bool chunked) {
  Error error;
  if (chunked) {
    const std::string size = absl::StrCat(absl::Hex(piece.size()), "\r\n");
    co_await Write({net::buffer(size), net::buffer(piece), net::buffer("\r\n", 2)}, error);
  } else {
    co_await Write(OnePiece(piece), error);
  }
  if (idle_since_) MayGiveWay();
  co_return !error;
}

Awaitable<bool> Session::WriteText(std::string_view text) {
  SetTimer(limits_.idle_time);
  Error error;
  co_await Write(OnePiece(text), error);
  co_return !error;
}

Awaitable<void> Session::Linger() {
  constexpr absl::Duration kPatience = absl::Seconds(3);
  Error error;
  if (!connection_->has_tls()) {
    connection_->socket().shutdown(net::ip::tcp::socket::shutdown_send, error);
  }
  std::vector<char> scrap(kPiece);
  SetTimer(kPatience);
  while (!error && !timed_out_) {
    co_await connection_->socket().async_read_some(net::buffer(scrap),
                                                   net::redirect_error(net::use_awaitable, error));
  }
}

}  // namespace traverse::gateway
