#include "client/gcode/verify/match/stated_layer_time.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Names without anything but letters: of PrusaSlicer and Slic3r, OrcaSlicer and Bambu Studio,
// CuraEngine, KISSlicer, IceSL, Simplify3D and others.
constexpr std::array<std::string_view, 8> kNames = {
    "slowdownbelowlayertime", "slowdownlayertime", "coolminlayertime", "minlayertimes",
    "minlayertimesec",        "minspeedlayertime", "minlayertime",     "minimumlayertime"};

constexpr size_t kLongestName = 64;

// Where CuraEngine keeps its settings: lines of 80 characters, in which a new line is "\\n".
constexpr std::string_view kCura = ";SETTING_3 ";

std::string LettersOf(std::string_view text) {
  std::string letters;
  for (const char c : text) {
    if (c >= 'A' && c <= 'Z') letters += static_cast<char>(c - 'A' + 'a');
    if (c >= 'a' && c <= 'z') letters += c;
  }
  return letters;
}

class LeastLayerTime {
 public:
  // `setting` is "name = 5,8", "name: 5" or "name,5".
  void Take(std::string_view setting) {
    const size_t end = setting.find_first_of("=:,");
    if (end == std::string_view::npos || end > kLongestName) return;
    if (std::find(kNames.begin(), kNames.end(), LettersOf(setting.substr(0, end))) ==
        kNames.end()) {
      return;
    }
    const char* at = setting.data() + end + 1;
    const char* const stop = setting.data() + setting.size();
    while (at < stop) {
      double value = 0;
      const auto read = std::from_chars(at, stop, value);
      if (read.ec == std::errc{}) greatest_ = std::max(greatest_.value_or(value), value);
      const bool between = *at == ' ' || *at == '\t' || *at == ',' || *at == ';' || *at == '"';
      if (read.ec != std::errc{} && !between) return;
      at = read.ec == std::errc{} ? read.ptr : at + 1;
    }
  }

  std::optional<double> greatest() const { return greatest_; }

 private:
  std::optional<double> greatest_;
};

}  // namespace

std::optional<double> StatedLeastLayerSeconds(std::string_view text) {
  LeastLayerTime time;
  std::string cura;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!Begins(line, ";")) continue;
    if (Begins(line, kCura)) {
      cura += TrimLine(line.substr(kCura.size()));
    } else {
      time.Take(line);
    }
  }
  for (std::string_view rest = cura; !rest.empty();) {
    const size_t end = std::min(rest.find("\\n"), rest.size());
    std::string_view setting = rest.substr(0, end);
    while (!setting.empty() && setting.back() == '\\') setting.remove_suffix(1);
    time.Take(setting);
    rest.remove_prefix(std::min(end + 2, rest.size()));
  }
  return time.greatest();
}

}  // namespace traverse::gcode
