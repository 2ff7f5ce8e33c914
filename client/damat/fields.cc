#include "client/damat/fields.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "client/damat/format.h"

namespace traverse::damat {
namespace {

constexpr std::string_view kBlanks = " \t\r";

}  // namespace

std::string_view Trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string Quoted(std::string_view text) {
  constexpr size_t kMaxShown = 32;
  std::string out = "\"";
  for (const char c : text.substr(0, kMaxShown)) out += c >= ' ' && c <= '~' ? c : '?';
  if (text.size() > kMaxShown) out += "...";
  return out + '"';
}

std::optional<uint64_t> ParseCount(std::string_view text) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> ParseCoordinate(std::string_view text) {
  // from_chars takes a minus, but no plus.
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!(std::abs(value) <= kMaxCoordinateMm)) return std::nullopt;  // also of NaN
  return value;
}

std::string_view Fields::Next() {
  const size_t comma = rest_.find(',');
  const std::string_view field = Trimmed(rest_.substr(0, comma));
  rest_ = comma == std::string_view::npos ? std::string_view() : Trimmed(rest_.substr(comma + 1));
  done_ = rest_.empty();
  return field;
}

}  // namespace traverse::damat
