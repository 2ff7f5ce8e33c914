// The page at GET /: a file dropped there comes back with less travel. It is page.html, as built
// in; it loads nothing from any other server.

#ifndef TRAVERSE_CLIENT_GATEWAY_PAGE_PAGE_H_
#define TRAVERSE_CLIENT_GATEWAY_PAGE_PAGE_H_

#include <string_view>

namespace traverse::gateway {

std::string_view GatewayPage();

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_PAGE_PAGE_H_
