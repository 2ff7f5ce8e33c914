#include "client/gcode/verify/match/stated_settings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Names without anything but letters: of PrusaSlicer and Slic3r, OrcaSlicer and Bambu Studio,
// CuraEngine, KISSlicer, IceSL, Simplify3D and others.
constexpr std::array<std::string_view, 8> kNames = {
    "slowdownbelowlayertime", "slowdownlayertime", "coolminlayertime", "minlayertimes",
    "minlayertimesec",        "minspeedlayertime", "minlayertime",     "minimumlayertime"};

constexpr std::array<std::string_view, 2> kFilamentNames = {"filamentdiameter", "materialdiameter"};

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

// CuraEngine's names of the outline of the head, fans and all, and of how low it hangs.
constexpr std::string_view kHeadPolygon = "machineheadwithfanspolygon";
constexpr std::string_view kHeadDistance = "machinenozzleheaddistance";

// The numbers that `list` begins with, whatever of these is between them.
std::vector<double> NumbersOf(std::string_view list, std::string_view between) {
  std::vector<double> numbers;
  const char* at = list.data();
  const char* const stop = list.data() + list.size();
  while (at < stop) {
    double value = 0;
    const auto read = std::from_chars(at, stop, value);
    if (read.ec == std::errc{}) {
      numbers.push_back(value);
      at = read.ptr;
    } else if (between.find(*at) != std::string_view::npos) {
      ++at;
    } else {
      break;
    }
  }
  return numbers;
}

class SettingNotes {
 public:
  // `setting` is "name = 5,8", "name: 5" or "name,5".
  void Take(std::string_view setting) {
    const size_t end = setting.find_first_of("=:,");
    if (end == std::string_view::npos || end > kLongestName) return;
    const std::string name = LettersOf(setting.substr(0, end));
    const std::string_view value = setting.substr(end + 1);
    if (std::ranges::count(kNames, name) > 0) {
      TakeGreatest(value, found_.least_layer_seconds);
    } else if (std::ranges::count(kFilamentNames, name) > 0) {
      TakeGreatest(value, found_.filament_mm);
    } else if (name == kHeadDistance) {
      TakeGreatest(value, found_.head_above_tip_mm);
    } else if (name == kHeadPolygon) {
      TakePolygon(value);
    }
  }

  const StatedSettings& found() const { return found_; }

 private:
  static void TakeGreatest(std::string_view list, std::optional<double>& greatest) {
    for (const double value : NumbersOf(list, " \t,;\"")) {
      greatest = std::max(greatest.value_or(value), value);
    }
  }

  // "[[-20, 10], [10, 10], [10, -10], [-20, -10]]"
  void TakePolygon(std::string_view points) {
    const std::vector<double> numbers = NumbersOf(points, " \t,;\"[]");
    for (size_t i = 1; i < numbers.size(); i += 2) {
      const double reach = std::hypot(numbers[i - 1], numbers[i]);
      found_.head_reach_mm = std::max(found_.head_reach_mm.value_or(reach), reach);
    }
  }

  StatedSettings found_;
};

}  // namespace

StatedSettings ReadStatedSettings(std::string_view text) {
  SettingNotes notes;
  std::string cura;
  while (!text.empty()) {
    const std::string_view line = TakeLine(text);
    if (!line.starts_with(";")) continue;
    if (line.starts_with(kCura)) {
      cura += TrimLine(line.substr(kCura.size()));
    } else {
      notes.Take(line);
    }
  }
  for (std::string_view rest = cura; !rest.empty();) {
    std::string_view setting = TakeLine(rest, "\\n");
    while (!setting.empty() && setting.back() == '\\') setting.remove_suffix(1);
    notes.Take(setting);
  }
  return notes.found();
}

}  // namespace traverse::gcode
