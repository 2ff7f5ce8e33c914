// Whether a request was sent to a name of this machine: against pages that make a browser take the
// gateway for their own site by a name that leads here (DNS rebinding).

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_OWN_HOST_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_OWN_HOST_H_

#include <string>
#include <string_view>
#include <vector>

namespace traverse::gateway {

// Whether `host` (NAME, NAME:PORT, [ADDRESS]:PORT; empty where a client sends none, as no browser
// does) is one of `allowed`, in any case, of which "*" means every name, or nothing that a stranger
// can have led here: an address, a name without a dot, a name under localhost, local, lan, internal
// or home.arpa, which no public name server answers for, or this machine's own name.
bool IsOwnHost(std::string_view host, const std::vector<std::string>& allowed);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_OWN_HOST_H_
