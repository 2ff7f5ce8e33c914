#include "client/files/md5.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "absl/strings/ascii.h"

namespace traverse {
namespace {

constexpr size_t kDigits = 32;
constexpr size_t kMaxBytes = 1024;  // a larger file holds no digest

// Where the only run of 32 hexadecimal digits begins.
std::optional<size_t> FindDigits(std::string_view stated) {
  std::optional<size_t> found;
  if (stated.size() > kMaxBytes) return found;
  for (size_t begin = 0; begin < stated.size();) {
    size_t end = begin;
    while (end < stated.size() && absl::ascii_isxdigit(static_cast<unsigned char>(stated[end]))) {
      ++end;
    }
    if (end - begin == kDigits) {
      if (found) return std::nullopt;
      found = begin;
    }
    begin = end + 1;
  }
  return found;
}

}  // namespace

std::string Md5Hex(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_md5(), nullptr) != 1) {
    return {};
  }
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string out;
  for (unsigned int i = 0; i < length; ++i) {
    out += kHex[digest[i] >> 4];
    out += kHex[digest[i] & 15];
  }
  return out;
}

std::optional<std::string> FindMd5(std::string_view stated) {
  const std::optional<size_t> at = FindDigits(stated);
  if (!at) return std::nullopt;
  std::string out(stated.substr(*at, kDigits));
  absl::AsciiStrToUpper(&out);
  return out;
}

std::string WithMd5(std::string_view stated, const std::string& digest) {
  const std::optional<size_t> at = FindDigits(stated);
  assert(at);
  const std::string_view old = stated.substr(*at, kDigits);
  const bool small = std::any_of(old.begin(), old.end(), [](char c) { return c >= 'a'; });
  std::string out(stated);
  return out.replace(*at, kDigits, small ? absl::AsciiStrToLower(digest) : digest);
}

}  // namespace traverse
