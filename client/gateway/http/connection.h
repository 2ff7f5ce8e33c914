// The bytes of one connection, with or without TLS.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_CONNECTION_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_CONNECTION_H_

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>
#include <string>
#include <vector>

#include "client/gateway/http/awaitable.h"
#include "client/gateway/http/tls_context.h"

namespace traverse::gateway {

// What may take time ends early, with an error, once socket() is cancelled or closed.
class Connection {
 public:
  using Error = boost::system::error_code;
  using Pieces = std::array<boost::asio::const_buffer, 3>;  // one behind the other

  // With TLS if `tls` is not null.
  static std::unique_ptr<Connection> Make(boost::asio::ip::tcp::socket socket,
                                          std::shared_ptr<TlsContext::Context> tls);

  virtual ~Connection() = default;

  virtual boost::asio::ip::tcp::socket& socket() = 0;
  virtual bool has_tls() const = 0;

  // What comes before the first byte. Returns the client's identities, see PeerIdentities.
  virtual Awaitable<std::vector<std::string>> Begin(Error& error) = 0;

  // Waits for bytes. Returns their number, at most the size of `into`.
  virtual Awaitable<size_t> ReadSome(boost::asio::mutable_buffer into, Error& error) = 0;

  virtual Awaitable<void> Write(Pieces pieces, Error& error) = 0;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_CONNECTION_H_
