// The page at GET /: a file dropped there comes back with less travel. page.html, as the build
// found it; it asks nobody but this gateway for anything.

#ifndef TRAVERSE_CLIENT_GATEWAY_PAGE_PAGE_H_
#define TRAVERSE_CLIENT_GATEWAY_PAGE_PAGE_H_

#include <string_view>

namespace traverse::gateway {

std::string_view GatewayPage();

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_PAGE_PAGE_H_
