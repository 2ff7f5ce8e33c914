#include "client/gateway/jobs/job_ids.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace traverse::gateway {
namespace {

constexpr size_t kMostNameBytes = 64;
constexpr size_t kProcessBytes = 4;
constexpr size_t kRandomBytes = 16;
constexpr size_t kSignatureBytes = 8;
constexpr size_t kDigits = 2 * (kProcessBytes + kRandomBytes + kSignatureBytes);

template <size_t kBytes>
absl::StatusOr<std::array<unsigned char, kBytes>> RandomBytes() {
  std::array<unsigned char, kBytes> bytes;
  if (RAND_bytes(bytes.data(), static_cast<int>(kBytes)) == 1) return bytes;
  return absl::UnavailableError("the system has no random numbers");
}

std::string Hex(const unsigned char* bytes, size_t size) {
  return absl::BytesToHexString(absl::string_view(reinterpret_cast<const char*>(bytes), size));
}

bool IsHexDigit(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }

}  // namespace

bool IsGatewayName(std::string_view name) {
  return !name.empty() && name.size() <= kMostNameBytes &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' ||
                  c == '-';
         });
}

absl::StatusOr<JobIds> JobIds::Make(std::string name) {
  assert(IsGatewayName(name));
  JobIds ids(std::move(name));
  const auto process = RandomBytes<kProcessBytes>();
  const auto secret = RandomBytes<sizeof(ids.secret_)>();
  if (!process.ok()) return process.status();
  if (!secret.ok()) return secret.status();
  ids.process_ = Hex(process->data(), process->size());
  ids.secret_ = *secret;
  return ids;
}

std::string JobIds::Signature(std::string_view digits, const std::string& caller) const {
  const std::string text = absl::StrCat(absl::string_view(digits.data(), digits.size()), caller);
  unsigned char hash[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  HMAC(EVP_sha256(), secret_.data(), static_cast<int>(secret_.size()),
       reinterpret_cast<const unsigned char*>(text.data()), text.size(), hash, &size);
  assert(size >= kSignatureBytes);
  return Hex(hash, kSignatureBytes);
}

absl::StatusOr<std::string> JobIds::New(const std::string& caller) const {
  const auto random = RandomBytes<kRandomBytes>();
  if (!random.ok()) return random.status();
  const std::string digits = process_ + Hex(random->data(), random->size());
  return absl::StrCat(name_, "-", digits, Signature(digits, caller));
}

absl::Status JobIds::Check(std::string_view id, const std::string& caller) const {
  const absl::Status unknown = absl::NotFoundError("there is no such job of this caller");
  if (id.size() < kDigits + 2) return unknown;
  const std::string_view name = id.substr(0, id.size() - kDigits - 1);
  const std::string_view digits = id.substr(id.size() - kDigits);
  if (id[name.size()] != '-' || !IsGatewayName(name) ||
      !std::all_of(digits.begin(), digits.end(), IsHexDigit)) {
    return unknown;
  }
  if (name != name_) {
    return absl::FailedPreconditionError(
        absl::StrCat("gateway ", absl::string_view(name.data(), name.size()),
                     " has this job, and this is gateway ", name_));
  }
  if (!digits.starts_with(process_)) {
    return absl::AbortedError(
        "the job was lost when this gateway was restarted; send the file again");
  }
  const std::string_view given = digits.substr(digits.size() - 2 * kSignatureBytes);
  const std::string right =
      Signature(digits.substr(0, digits.size() - 2 * kSignatureBytes), caller);
  return CRYPTO_memcmp(given.data(), right.data(), right.size()) == 0 ? absl::OkStatus() : unknown;
}

}  // namespace traverse::gateway
