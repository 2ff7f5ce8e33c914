#include "client/gcode/read/least_layer_time.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

#include "absl/strings/numbers.h"
#include "client/gcode/text/cura_settings.h"

namespace traverse::gcode {
namespace {

constexpr size_t kLongestName = 64;

bool IsOfName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == ' ' || c == '-';
}

// `minSpeedLayerTime`, `slow_down_layer_time` and `Minimum layer time (s)` begin alike so.
std::string Letters(std::string_view name) {
  std::string letters;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) continue;
    letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return letters;
}

// Layer times by which fans are set are other ones.
bool NamesLeastLayerTime(std::string_view name) {
  const std::string letters = Letters(name);
  const auto has = [&letters](std::string_view word) {
    return letters.find(word) != std::string::npos;
  };
  const bool ends = letters.ends_with("layertime") || letters.ends_with("layertimes") ||
                    letters.ends_with("layertimesec") || letters.ends_with("layertimeseconds");
  return ends && (has("min") || has("slow")) && !has("fan") && !has("enable") && !has("max");
}

// The greatest of the numbers with which `text` begins.
std::optional<double> GreatestNumber(std::string_view text) {
  std::optional<double> greatest;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t,;\""), text.size()));
    const size_t end = std::min(text.find_first_not_of("0123456789."), text.size());
    double number = 0;
    if (!absl::SimpleAtod(absl::string_view(text.data(), end), &number)) return greatest;
    greatest = std::max(greatest.value_or(number), number);
    text.remove_prefix(end);
  }
}

// Of the setting that is named at `at` in `text`, if it is one.
std::optional<double> StatedAt(std::string_view text, size_t at) {
  size_t begin = at;
  while (begin > 0 && at - begin < kLongestName && IsOfName(text[begin - 1])) --begin;
  size_t end = at;
  while (end < text.size() && end - at < kLongestName && IsOfName(text[end])) ++end;
  const bool states = end < text.size() && std::string_view("=:,").find(text[end]) != text.npos;
  if (!states || !NamesLeastLayerTime(text.substr(begin, end - begin))) return std::nullopt;
  return GreatestNumber(text.substr(end + 1));
}

// Calls visit(at) for each "ayer" in `text`, whatever it begins with.
template <typename Visit>
void ForEachLayerWord(std::string_view text, Visit visit) {
  constexpr std::string_view kWord = "ayer";
  for (size_t at = text.find(kWord); at != text.npos; at = text.find(kWord, at + 1)) visit(at);
}

}  // namespace

double LeastLayerSeconds(std::string_view text) {
  std::optional<double> greatest;
  const auto take = [&greatest](std::optional<double> stated) {
    if (stated) greatest = std::max(greatest.value_or(*stated), *stated);
  };
  size_t line = 0;  // where the one at hand begins
  ForEachLayerWord(text, [&](size_t at) {
    const size_t before = text.substr(line, at - line).rfind('\n');
    if (before != std::string_view::npos) line += before + 1;
    if (text[line] == ';') take(StatedAt(text, at));
  });
  const std::string joined = JoinedCuraSettings(text);
  ForEachLayerWord(joined, [&](size_t at) { take(StatedAt(joined, at)); });
  return greatest.value_or(kUsualLeastLayerSeconds);
}

}  // namespace traverse::gcode
