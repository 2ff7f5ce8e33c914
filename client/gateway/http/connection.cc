#include "client/gateway/http/connection.h"

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <utility>

namespace traverse::gateway {
namespace {

namespace net = boost::asio;
using net::ip::tcp;

class PlainConnection : public Connection {
 public:
  explicit PlainConnection(tcp::socket socket) : socket_(std::move(socket)) {}

  tcp::socket& socket() override { return socket_; }
  bool has_tls() const override { return false; }

  Awaitable<std::vector<std::string>> Begin(Error& error) override {
    error = {};
    co_return std::vector<std::string>{};
  }

  Awaitable<size_t> ReadSome(net::mutable_buffer into, Error& error) override {
    return socket_.async_read_some(into, net::redirect_error(net::use_awaitable, error));
  }

  Awaitable<void> Write(Pieces pieces, Error& error) override {
    co_await net::async_write(socket_, pieces, net::redirect_error(net::use_awaitable, error));
  }

 private:
  tcp::socket socket_;
};

class TlsConnection : public Connection {
 public:
  TlsConnection(tcp::socket socket, std::shared_ptr<TlsContext::Context> context)
      : context_(std::move(context)), stream_(std::move(socket), *context_) {}

  tcp::socket& socket() override { return stream_.next_layer(); }
  bool has_tls() const override { return true; }

  Awaitable<std::vector<std::string>> Begin(Error& error) override {
    co_await stream_.async_handshake(net::ssl::stream_base::server,
                                     net::redirect_error(net::use_awaitable, error));
    if (error) co_return std::vector<std::string>{};
    co_return PeerIdentities(stream_.native_handle());
  }

  Awaitable<size_t> ReadSome(net::mutable_buffer into, Error& error) override {
    return stream_.async_read_some(into, net::redirect_error(net::use_awaitable, error));
  }

  Awaitable<void> Write(Pieces pieces, Error& error) override {
    co_await net::async_write(stream_, pieces, net::redirect_error(net::use_awaitable, error));
  }

 private:
  const std::shared_ptr<TlsContext::Context> context_;
  net::ssl::stream<tcp::socket> stream_;
};

}  // namespace

std::unique_ptr<Connection> Connection::Make(tcp::socket socket,
                                             std::shared_ptr<TlsContext::Context> tls) {
  if (tls == nullptr) return std::make_unique<PlainConnection>(std::move(socket));
  return std::make_unique<TlsConnection>(std::move(socket), std::move(tls));
}

}  // namespace traverse::gateway
