// Sends each request to the code that answers it.

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
  // `printers` may be null: no printers are configured. Both must outlive the router.
  Router(Core& core, PrinterApi* printers) : core_(core), printers_(printers) {}

  HttpDecision Handle(const HttpRequest& request);

 private:
  HttpDecision Open(const HttpRequest& request, std::string& route);
  HttpDecision ForCaller(const HttpRequest& request, const std::string& caller, std::string& route);

  Core& core_;
  PrinterApi* const printers_;
};

// The caller of `request`: by its bearer token or X-Api-Key, its certificate, or its address.
// Errors: Unauthenticated, PermissionDenied.
absl::StatusOr<std::string> CallerOf(const HttpRequest& request, Authenticator& authenticator);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_ROUTER_H_
