// What a coroutine of the gateway's loop returns.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_AWAITABLE_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_AWAITABLE_H_

// clang-format off: that of Boost 1.74 needs <utility> and does not include it.
#include <boost/asio/awaitable.hpp>
#include <utility>
// clang-format on

namespace traverse::gateway {

template <typename T>
using Awaitable = boost::asio::awaitable<T>;

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_AWAITABLE_H_
