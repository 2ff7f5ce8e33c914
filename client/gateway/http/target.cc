#include "client/gateway/http/target.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"

namespace traverse::gateway {
namespace {

absl::Status Fault(const char* what) { return absl::InvalidArgumentError(what); }

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

bool IsControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

// Nothing if an escape is malformed, or stands for a control character and `controls` is false.
std::optional<std::string> Unescaped(std::string_view text, bool plus, bool controls) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '+' && plus) c = ' ';
    if (c == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const int high = HexDigit(text[i + 1]);
      const int low = HexDigit(text[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      c = static_cast<char>(high * 16 + low);
      i += 2;
    }
    if (IsControl(c) && !controls) return std::nullopt;
    out += c;
  }
  return out;
}

bool HasDotSegment(const std::string& path) {
  const std::vector<std::string> segments = absl::StrSplit(path, '/');
  return std::any_of(segments.begin(), segments.end(),
                     [](const std::string& segment) { return segment == "." || segment == ".."; });
}

// Well-formed, without surrogates and overlong forms.
bool IsUtf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const size_t length = lead < 0x80   ? 1
                          : lead < 0xc2 ? 0
                          : lead < 0xe0 ? 2
                          : lead < 0xf0 ? 3
                          : lead < 0xf5 ? 4
                                        : 0;
    if (length == 0 || i + length > text.size()) return false;
    uint32_t code = lead;
    if (length > 1) code = lead & (0x7fu >> length);
    for (size_t k = 1; k < length; ++k) {
      const auto byte = static_cast<unsigned char>(text[i + k]);
      if ((byte & 0xc0u) != 0x80u) return false;
      code = code << 6 | (byte & 0x3fu);
    }
    const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    if (overlong || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return false;
    i += length;
  }
  return true;
}

}  // namespace

std::string TakeOrigin(std::string_view& target) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    const std::string begin(target.substr(0, scheme.size()));
    if (!absl::EqualsIgnoreCase(begin, std::string(scheme))) continue;
    target.remove_prefix(scheme.size());
    const size_t end = std::min(target.find_first_of("/?"), target.size());
    const std::string host(target.substr(0, end));
    target.remove_prefix(end);
    if (target.empty()) target = "/";
    return host;
  }
  return "";
}

absl::StatusOr<Target> ParseTarget(std::string_view target) {
  const size_t question = target.find('?');
  const std::string_view path = target.substr(0, question);
  if (path.empty() || path.front() != '/') return Fault("the path does not begin with /");
  Target out;
  const std::optional<std::string> plain = Unescaped(path, /*plus=*/false, /*controls=*/false);
  if (!plain) return Fault("the path has a control character or a bad percent escape");
  if (HasDotSegment(*plain)) return Fault("the path has a segment . or ..");
  out.path = *plain;
  if (question == std::string_view::npos) return out;
  const std::vector<std::string> pairs =
      absl::StrSplit(std::string(target.substr(question + 1)), '&', absl::SkipEmpty());
  for (const std::string& pair : pairs) {
    const size_t equals = std::min(pair.find('='), pair.size());
    const auto name = Unescaped(std::string_view(pair).substr(0, equals), true, false);
    const auto value =
        Unescaped(std::string_view(pair).substr(std::min(equals + 1, pair.size())), true, false);
    if (!name || !value) return Fault("the query has a control character or a bad percent escape");
    out.query.emplace_back(*name, *value);
  }
  return out;
}

absl::Status CheckFileName(std::string_view name) {
  constexpr size_t kMaxNameBytes = 255;
  if (name.empty()) return Fault("the file has no name");
  if (name.size() > kMaxNameBytes) return Fault("the file's name is longer than 255 bytes");
  if (name == "." || name == "..") return Fault("the file's name is . or ..");
  for (const char c : name) {
    if (IsControl(c)) return Fault("the file's name has a control character");
    if (c == '/' || c == '\\') return Fault("the file's name has a slash");
  }
  if (!IsUtf8(name)) return Fault("the file's name is not UTF-8");
  return absl::OkStatus();
}

}  // namespace traverse::gateway
