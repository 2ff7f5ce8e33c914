// Which request is answered by whom.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_ROUTER_H_
#define TRAVERSE_CLIENT_GATEWAY_API_ROUTER_H_

#include <string>

#include "client/gateway/core.h"
#include "client/gateway/http/message.h"

namespace traverse::gateway {

class PrinterApi;

// Thread-safe.
class Router {
 public:
  // `printers` may be null: no printers are configured. Both outlive it.
  Router(Core& core, PrinterApi* printers) : core_(core), printers_(printers) {}

  HttpDecision Handle(const HttpRequest& request);

 private:
  HttpDecision Open(const HttpRequest& request, std::string& route);
  HttpDecision ForCaller(const HttpRequest& request, const std::string& caller, std::string& route);

  Core& core_;
  PrinterApi* const printers_;
};

// Who `request` is from: by its bearer token or X-Api-Key, its certificate, its address. Errors:
// Unauthenticated, PermissionDenied.
absl::StatusOr<std::string> CallerOf(const HttpRequest& request, Authenticator& authenticator);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_ROUTER_H_
