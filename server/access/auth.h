// Identifies callers and checks whether they may call.
//
//   bearer token   from a file of hashes; the caller is "token:NAME"
//   certificate    of a client, verified by TLS; the caller is "cert:IDENTITY"
//   neither        the caller is the address without its port
//
// Knows nothing of gRPC. Nothing here puts a token into a status or a log.

#ifndef TRAVERSE_SERVER_ACCESS_AUTH_H_
#define TRAVERSE_SERVER_ACCESS_AUTH_H_

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "engine/base/mutex.h"
#include "server/access/text_file.h"

namespace traverse {

using Sha256 = std::array<unsigned char, 32>;

Sha256 HashOf(const std::string& text);

// One line of a token file.
struct TokenEntry {
  std::string name;
  Sha256 hash;
};

// Reads "NAME HASH" lines: a name of letters, digits, '.', '_' and '-', and the SHA-256 of the
// token in hexadecimal. '#' begins a comment. Several lines may have one name, for tokens old and
// new. InvalidArgument `line 3: ...`.
absl::StatusOr<std::vector<TokenEntry>> ParseTokens(const std::string& text);

// The credentials that a call presents.
struct CallCredentials {
  std::string authorization;            // the metadata of that name; empty if there is none
  std::vector<std::string> identities;  // of the verified client certificate; empty without one
  std::string host;                     // the address without its port
};

struct AuthOptions {
  std::string token_file;                  // empty: no token needed
  std::vector<std::string> allowed_names;  // identities that may call; empty: all verified ones
};

// Thread-safe.
class Authenticator {
 public:
  // Calls `on_reload` for each reload of the token file, OK or failed; after a failure the last
  // good tokens stay. Errors: InvalidArgument if the token file cannot be used.
  static absl::StatusOr<std::unique_ptr<Authenticator>> Make(
      const AuthOptions& options, std::function<void(const absl::Status&)> on_reload);

  // The name under which the caller is counted. Errors: Unauthenticated, PermissionDenied.
  absl::StatusOr<std::string> Identify(const CallCredentials& credentials);

  // Whether Identify would accept `text` as a token now; if so, it must not be passed on.
  bool IsToken(const std::string& text);

  // Reads the token file again if it has changed, or in any case if `anyway`. Identify checks at
  // most once a second.
  void Look(bool anyway);

 private:
  using Tokens = std::shared_ptr<const std::vector<TokenEntry>>;

  Authenticator(const AuthOptions& options, std::function<void(const absl::Status&)> on_reload)
      : options_(options), on_reload_(std::move(on_reload)) {}

  // The tokens of the file as it is now; checks the file at most once a second.
  Tokens CurrentTokens();

  absl::Status Load() TRAVERSE_REQUIRES(mutex_);

  const AuthOptions options_;
  const std::function<void(const absl::Status&)> on_reload_;
  Mutex mutex_;
  Tokens tokens_ TRAVERSE_GUARDED_BY(mutex_);
  FileState state_ TRAVERSE_GUARDED_BY(mutex_);
  std::chrono::steady_clock::time_point looked_ TRAVERSE_GUARDED_BY(mutex_){};
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_ACCESS_AUTH_H_
