#include "client/gateway/http/own_host.h"

#include <arpa/inet.h>
#include <limits.h>
#include <unistd.h>

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"

namespace traverse::gateway {
namespace {

// Without the port and without the dot that ends an absolute name.
std::string NameOf(std::string_view host) {
  if (host.starts_with('[')) return std::string(host.substr(1, host.find(']') - 1));
  std::string name = absl::AsciiStrToLower(std::string(host.substr(0, host.find(':'))));
  if (name.ends_with('.')) name.pop_back();
  return name;
}

bool IsAddress(const std::string& name) {
  in6_addr out;
  return inet_pton(AF_INET, name.c_str(), &out) == 1 ||
         inet_pton(AF_INET6, name.c_str(), &out) == 1;
}

bool IsThisMachine(const std::string& name) {
  char own[HOST_NAME_MAX + 1] = {};
  return gethostname(own, sizeof(own) - 1) == 0 && absl::EqualsIgnoreCase(name, own);
}

}  // namespace

bool IsOwnHost(std::string_view host, const std::vector<std::string>& allowed) {
  const std::string name = NameOf(host);
  const auto is_name = [&](const std::string& one) {
    return one == "*" || absl::EqualsIgnoreCase(one, name);
  };
  if (std::any_of(allowed.begin(), allowed.end(), is_name)) return true;
  if (IsAddress(name) || name.find('.') == std::string::npos) return true;
  for (const char* end : {".localhost", ".local", ".lan", ".internal", ".home.arpa"}) {
    if (absl::EndsWith(name, end)) return true;
  }
  return IsThisMachine(name);
}

}  // namespace traverse::gateway
