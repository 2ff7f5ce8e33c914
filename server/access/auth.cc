#include "server/access/auth.h"

#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace traverse {
namespace {

constexpr auto kLookEvery = std::chrono::seconds(1);
constexpr size_t kMaxNameBytes = 64;
constexpr char kScheme[] = "bearer ";

bool IsNameChar(char c) {
  return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
}

bool IsName(const std::string& name) {
  return !name.empty() && name.size() <= kMaxNameBytes &&
         std::all_of(name.begin(), name.end(), IsNameChar);
}

bool IsHash(const std::string& text) {
  return text.size() == 2 * std::tuple_size_v<Sha256> &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return absl::ascii_isxdigit(static_cast<unsigned char>(c)); });
}

// The token of "Bearer TOKEN", the scheme in any case; empty if it is something else.
std::string BearerToken(const std::string& authorization) {
  constexpr size_t kLength = sizeof(kScheme) - 1;
  if (authorization.size() <= kLength ||
      absl::AsciiStrToLower(authorization.substr(0, kLength)) != kScheme) {
    return "";
  }
  return authorization.substr(kLength);
}

// The entry of `token`, or null. Every entry is compared, and each in constant time: how long it
// takes tells nothing.
const TokenEntry* FindToken(const std::vector<TokenEntry>& tokens, const std::string& token) {
  const Sha256 hash = HashOf(token);
  const TokenEntry* found = nullptr;
  for (const TokenEntry& entry : tokens) {
    if (CRYPTO_memcmp(entry.hash.data(), hash.data(), hash.size()) == 0) found = &entry;
  }
  return found;
}

}  // namespace

Sha256 HashOf(const std::string& text) {
  Sha256 hash;
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), hash.data());
  return hash;
}

absl::StatusOr<std::vector<TokenEntry>> ParseTokens(const std::string& text) {
  std::vector<TokenEntry> entries;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    std::string name, hash, more;
    if (!(words >> name)) continue;
    words >> hash >> more;
    if (!IsName(name) || !IsHash(hash) || !more.empty()) {
      // Does not repeat the text: it may be a token, put there by mistake.
      return absl::InvalidArgumentError(
          absl::StrCat("line ", number, ": not a name and a SHA-256 of 64 hexadecimal digits"));
    }
    const std::string bytes = absl::HexStringToBytes(hash);
    TokenEntry entry;
    entry.name = name;
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(entry.hash.data()));
    entries.push_back(std::move(entry));
  }
  return entries;
}

absl::StatusOr<std::unique_ptr<Authenticator>> Authenticator::Make(
    const AuthOptions& options, std::function<void(const absl::Status&)> on_reload) {
  std::unique_ptr<Authenticator> made(new Authenticator(options, std::move(on_reload)));
  if (options.token_file.empty()) return made;
  MutexLock lock(made->mutex_);
  made->state_ = StateOfFile(options.token_file);
  if (absl::Status status = made->Load(); !status.ok()) return status;
  return made;
}

absl::Status Authenticator::Load() {
  const auto unusable = [this](const absl::Status& why) {
    return absl::InvalidArgumentError(
        absl::StrCat("token file ", options_.token_file, ": ", why.message()));
  };
  const absl::StatusOr<std::string> text = ReadTextFile(options_.token_file);
  if (!text.ok()) return unusable(text.status());
  absl::StatusOr<std::vector<TokenEntry>> entries = ParseTokens(*text);
  if (!entries.ok()) return unusable(entries.status());
  tokens_ = std::make_shared<const std::vector<TokenEntry>>(*std::move(entries));
  return absl::OkStatus();
}

void Authenticator::Look(bool anyway) {
  if (options_.token_file.empty()) return;
  MutexLock lock(mutex_);
  looked_ = std::chrono::steady_clock::now();
  const FileState state = StateOfFile(options_.token_file);
  if (state == state_ && !anyway) return;
  state_ = state;
  const absl::Status loaded = Load();
  lock.Unlock();
  on_reload_(loaded);
}

Authenticator::Tokens Authenticator::CurrentTokens() {
  MutexLock lock(mutex_);
  if (std::chrono::steady_clock::now() - looked_ >= kLookEvery) {
    lock.Unlock();
    Look(/*anyway=*/false);
    lock.Lock();
  }
  return tokens_;
}

bool Authenticator::IsToken(const std::string& text) {
  if (options_.token_file.empty()) return false;
  const Tokens tokens = CurrentTokens();
  return FindToken(*tokens, text) != nullptr;
}

absl::StatusOr<std::string> Authenticator::Identify(const CallCredentials& credentials) {
  const std::vector<std::string>& names = options_.allowed_names;
  if (!names.empty()) {
    const bool allowed = std::any_of(
        credentials.identities.begin(), credentials.identities.end(), [&](const std::string& id) {
          return std::find(names.begin(), names.end(), id) != names.end();
        });
    if (credentials.identities.empty()) {
      return absl::UnauthenticatedError("a client certificate is required");
    }
    if (!allowed) {
      return absl::PermissionDeniedError(absl::StrCat(
          "the certificate of ", credentials.identities[0], " is not one that may call"));
    }
  }
  if (!options_.token_file.empty()) {
    const std::string token = BearerToken(credentials.authorization);
    if (token.empty()) {
      return absl::UnauthenticatedError("a bearer token is required: authorization: Bearer TOKEN");
    }
    const Tokens tokens = CurrentTokens();
    const TokenEntry* found = FindToken(*tokens, token);
    if (found == nullptr) return absl::UnauthenticatedError("the bearer token is unknown");
    return absl::StrCat("token:", found->name);
  }
  if (!credentials.identities.empty()) return absl::StrCat("cert:", credentials.identities[0]);
  return credentials.host;
}

}  // namespace traverse
