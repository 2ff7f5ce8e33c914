// Checks that a request was sent to a name of this machine. Protects against pages that make a
// browser take the gateway for their own site through a name that resolves to it (DNS rebinding).

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_OWN_HOST_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_OWN_HOST_H_

#include <string>
#include <string_view>
#include <vector>

namespace traverse::gateway {

// Whether `host` (NAME, NAME:PORT, [ADDRESS]:PORT; empty if a client sends none, which no browser
// does) is one of `allowed`, ignoring case, where "*" means every name; or a name that no stranger
// can have made resolve here: an address, a name without a dot, a name under localhost, local, lan,
// internal or home.arpa, which no public name server answers for, or this machine's own name.
bool IsOwnHost(std::string_view host, const std::vector<std::string>& allowed);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_OWN_HOST_H_
