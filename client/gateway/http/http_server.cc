#include "client/gateway/http/http_server.h"

#include <algorithm>
#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/gateway/http/awaitable.h"
#include "client/gateway/http/connection.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/http/session.h"
#include "client/gateway/http/tls_context.h"
#include "server/net/give_way.h"
#include "server/net/open_files.h"
#include "server/net/turns.h"

namespace traverse::gateway {
namespace {

namespace net = boost::asio;
using net::ip::tcp;

// Splits HOST:PORT or [HOST]:PORT into a host for the resolver and a port.
absl::StatusOr<std::pair<std::string, std::string>> SplitAddress(const std::string& address) {
  const size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon + 1 == address.size()) {
    return absl::InvalidArgumentError(absl::StrCat(address, ": not HOST:PORT"));
  }
  std::string host = address.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  return std::make_pair(host.empty() ? std::string("0.0.0.0") : host, address.substr(colon + 1));
}

// The peer's address as gRPC writes it, without the port.
std::string PeerHostOf(const tcp::endpoint& peer) {
  return absl::StrCat(peer.address().is_v4() ? "ipv4:" : "ipv6:", peer.address().to_string());
}

class BeastServer : public HttpServer {
 public:
  BeastServer(const HttpServerOptions& options, HttpHandler handler)
      : options_(options),
        handler_(std::move(handler)),
        loop_(std::make_shared<net::io_context>(1)),
        acceptor_(*loop_) {}

  ~BeastServer() override {
    loop_->stop();
    if (thread_.joinable()) thread_.join();
  }

  absl::Status Start() {
    if (options_.certificates != nullptr) {
      absl::StatusOr<std::unique_ptr<TlsContext>> tls = TlsContext::Make(options_.certificates);
      if (!tls.ok()) return tls.status();
      tls_ = *std::move(tls);
    }
    if (absl::Status status = Listen(); !status.ok()) return status;
    net::co_spawn(*loop_, Accept(), net::detached);
    thread_ = std::thread([this] { loop_->run(); });
    return absl::OkStatus();
  }

  int port() const override { return port_; }
  int connections() const override { return connections_; }

  void Drain(absl::Duration timeout) override {
    net::post(*loop_, [this] {
      boost::system::error_code error;
      acceptor_.close(error);
      for (Session* session : sessions_) session->Drain();
    });
    const absl::Time end = absl::Now() + timeout;
    constexpr absl::Duration kLook = absl::Milliseconds(5);
    absl::SleepFor(kLook);
    while (connections_ > 0 && absl::Now() < end) absl::SleepFor(kLook);
  }

 private:
  using Clock = std::chrono::steady_clock;

  absl::Status Listen() {
    const auto address = SplitAddress(options_.listen);
    if (!address.ok()) return address.status();
    boost::system::error_code error;
    tcp::resolver resolver(*loop_);
    const auto found =
        resolver.resolve(address->first, address->second, tcp::resolver::passive, error);
    if (!error && !found.empty()) {
      const tcp::endpoint endpoint = found.begin()->endpoint();
      acceptor_.open(endpoint.protocol(), error);
      if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
      if (!error) acceptor_.bind(endpoint, error);
      if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
      if (!error) acceptor_.non_blocking(true, error);
    }
    if (error) {
      return absl::UnavailableError(
          absl::StrCat("cannot listen on ", options_.listen, ": ", error.message()));
    }
    port_ = acceptor_.local_endpoint().port();
    return absl::OkStatus();
  }

  Awaitable<void> Accept() {
    net::steady_timer pause(*loop_);
    while (acceptor_.is_open()) {
      boost::system::error_code error;
      co_await acceptor_.async_wait(tcp::acceptor::wait_read,
                                    net::redirect_error(net::use_awaitable, error));
      if (error == net::error::operation_aborted) co_return;
      if (AcceptAll()) continue;
      MakeRoom("");
      pause.expires_after(std::chrono::milliseconds(50));
      co_await pause.async_wait(net::redirect_error(net::use_awaitable, error));
    }
  }

  // Those that have come, as far as that takes only a moment. False: for want of files.
  bool AcceptAll() {
    constexpr int kAtOnce = 256;
    boost::system::error_code error;
    for (int i = 0; i < kAtOnce && !error; ++i) {
      tcp::socket socket = acceptor_.accept(error);
      if (!error) TakeIn(std::move(socket));
    }
    return !error || error == net::error::would_block;
  }

  // It waits for its turn from now on, unless it is refused.
  void TakeIn(tcp::socket socket) {
    boost::system::error_code error;
    const tcp::endpoint peer = socket.remote_endpoint(error);
    if (error) return;
    const std::string address = PeerHostOf(peer);
    const HttpLimits& limits = options_.limits;
    const int most = PlacesFor(limits.files_part, /*files_each=*/1, limits.max_connections);
    if (connections_ >= most && !MakeRoom(address)) {
      return Refuse(std::move(socket), "too many connections");
    }
    const int64_t of_address =
        int64_t{limits.max_connections_per_address} * most / limits.max_connections;
    if (addresses_[address] >= std::max<int64_t>(1, of_address)) {
      return Refuse(std::move(socket), "too many connections from this address");
    }
    socket.set_option(tcp::no_delay(true), error);
    ++connections_;
    ++addresses_[address];
    waiting_.Add(address, {std::move(socket), address});
    ServeSoon();
  }

  // One each time the loop comes round: serving those of one address keeps no other waiting.
  void ServeSoon() {
    if (std::exchange(serves_soon_, true)) return;
    net::post(*loop_, [this] {
      serves_soon_ = false;
      if (!waiting_.empty()) ServeNext();
    });
  }

  void ServeNext() {
    auto [socket, address] = waiting_.TakeNext();
    if (!waiting_.empty()) ServeSoon();
    if (!acceptor_.is_open()) return Forget(address);
    auto connection =
        Connection::Make(std::move(socket), tls_ == nullptr ? nullptr : tls_->Current());
    Serve(std::make_shared<Session>(loop_, std::move(connection), options_.limits, handler_,
                                    address));
  }

  // For a new one of `address`: those that wait have cost nothing yet. An address of which some do
  // gets no room for more.
  bool MakeRoom(const std::string& address) {
    if (waiting_.most() > waiting_.of(address) + 1) {
      NewConnection last = waiting_.TakeLastOfMost();
      Forget(last.address);
      Refuse(std::move(last.socket), "too many connections");
      return true;
    }
    if (waiting_.of(address) > 0) return false;
    GiveWay<Session*> give_way;
    for (Session* session : sessions_) {
      const auto since = session->idle_since();
      give_way.Offer(session, session->peer_host(), since.value_or(Clock::now()), !since);
    }
    Session* chosen = nullptr;
    if (!give_way.Choose(address, Clock::now(), chosen)) return false;
    chosen->Close();
    return true;
  }

  // Sends the reason if that needs no waiting.
  void Refuse(tcp::socket socket, const std::string& why) {
    if (tls_ != nullptr) return;
    const std::string body = ProblemJson(503, why);
    const std::string full =
        absl::StrCat("HTTP/1.1 503 Service Unavailable\r\nContent-Type: ",
                     "application/problem+json\r\nRetry-After: 5\r\nConnection: close\r\n",
                     "Content-Length: ", body.size(), "\r\n\r\n", body);
    boost::system::error_code error;
    socket.non_blocking(true, error);
    socket.write_some(net::buffer(full), error);
  }

  void Serve(const std::shared_ptr<Session>& session) {
    sessions_.insert(session.get());
    net::co_spawn(*loop_, session->Run(), [this, session](const std::exception_ptr&) {
      sessions_.erase(session.get());
      Forget(session->peer_host());
    });
  }

  // A connection of `address` has ended.
  void Forget(const std::string& address) {
    --connections_;
    if (--addresses_[address] == 0) addresses_.erase(address);
  }

  struct NewConnection {
    tcp::socket socket;
    std::string address;
  };

  const HttpServerOptions options_;
  const HttpHandler handler_;
  std::unique_ptr<TlsContext> tls_;
  const std::shared_ptr<net::io_context> loop_;
  tcp::acceptor acceptor_;
  Turns<NewConnection> waiting_;          // of the loop's thread: not yet served
  bool serves_soon_ = false;              // likewise: ServeNext will be called
  std::set<Session*> sessions_;           // likewise
  std::map<std::string, int> addresses_;  // likewise: their connections
  std::atomic<int> connections_ = 0;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace

absl::Duration HttpLimits::TimeForPiece(absl::Duration elapsed, uint64_t bytes) const {
  const absl::Duration allowed =
      idle_time + absl::Seconds(static_cast<double>(bytes) /
                                static_cast<double>(std::max<int64_t>(1, min_bytes_per_second)));
  return std::clamp(std::min(allowed, body_time) - elapsed, absl::ZeroDuration(), idle_time);
}

std::string HttpRequest::Header(std::string_view name) const {
  for (const auto& [key, value] : headers) {
    if (key == name) return value;
  }
  return "";
}

absl::StatusOr<std::unique_ptr<HttpServer>> HttpServer::Start(const HttpServerOptions& options,
                                                              HttpHandler handler) {
  auto server = std::make_unique<BeastServer>(options, std::move(handler));
  if (absl::Status status = server->Start(); !status.ok()) return status;
  return server;
}

}  // namespace traverse::gateway
