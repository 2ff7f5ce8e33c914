#include "client/gcode/machine/klipper_limits.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/gcode/machine/limit_text.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

// One setting of Klipper that is read.
struct Setting {
  std::string_view section;
  std::string_view key;
  LimitField field;
  Range range = kAboveZero;
  bool lowers = false;  // the field may also be set by others; the least value counts
};

constexpr Setting kSettings[] = {
    {"printer", "max_velocity", &MachineLimits::max_speed},
    {"printer", "max_accel", &MachineLimits::max_accel},
    {"printer", "square_corner_velocity", &MachineLimits::corner_speed, kFromZero},
    {"printer", "minimum_cruise_ratio", &MachineLimits::cruise_ratio, kRatio},
    {"printer", "max_z_velocity", &MachineLimits::max_z_speed},
    {"printer", "max_z_accel", &MachineLimits::z_accel},
    // Of kinematics that limit each axis. Moves lead anywhere: the slower axis counts.
    {"printer", "max_x_velocity", &MachineLimits::max_speed, kAboveZero, true},
    {"printer", "max_y_velocity", &MachineLimits::max_speed, kAboveZero, true},
    {"printer", "max_x_accel", &MachineLimits::max_accel, kAboveZero, true},
    {"printer", "max_y_accel", &MachineLimits::max_accel, kAboveZero, true},
    {"extruder", "nozzle_diameter", &MachineLimits::nozzle_diameter},
    {"extruder", "filament_diameter", &MachineLimits::filament_diameter},
    {"extruder", "max_extrude_only_velocity", &MachineLimits::max_e_speed},
    {"extruder", "max_extrude_only_accel", &MachineLimits::retract_accel},
    {"extruder", "instantaneous_corner_velocity", &MachineLimits::extruder_corner_speed, kFromZero},
    {"firmware_retraction", "retract_length", &MachineLimits::firmware_retract_length, kFromZero},
    {"firmware_retraction", "retract_speed", &MachineLimits::firmware_retract_speed},
    {"firmware_retraction", "unretract_speed", &MachineLimits::firmware_prime_speed},
    {"firmware_retraction", "unretract_extra_length", &MachineLimits::firmware_prime_extra,
     kFromZero},
    {"gcode_arcs", "resolution", &MachineLimits::arc_chord},
};

class KlipperReader {
 public:
  KlipperReader(const std::string& name, const ReadIncludes& includes)
      : name_(name), read_includes_(includes) {
    limits_.klipper = true;
  }

  absl::StatusOr<MachineLimits> Read(std::string_view text) {
    if (const absl::Status status = TakeAll(text); !status.ok()) return status;
    const char* unread = has_unread_ ? "; files that it includes are not read" : "";
    if (!has_printer_) return LimitFault(name_, 0, absl::StrCat("it has no [printer]", unread));
    for (const auto& [field, key] : {std::pair(limits_.max_speed, "max_velocity"),
                                     std::pair(limits_.max_accel, "max_accel")}) {
      if (!field)
        return LimitFault(name_, 0, absl::StrFormat("[printer] has no %s%s", key, unread));
    }
    FillDefaults();
    return limits_;
  }

 private:
  static constexpr int kMostDepth = 10;

  absl::Status TakeAll(std::string_view text) {
    return ForEachLine(text,
                       [this](std::string_view line, int number) { return Take(line, number); });
  }

  absl::Status Take(std::string_view line, int number) {
    line = line.substr(0, std::min(line.find('#'), line.find(';')));
    // What is indented goes on with a value of several lines: a macro.
    if (line.empty() || line[0] == ' ' || line[0] == '\t' || line[0] == '\r') {
      return absl::OkStatus();
    }
    line = TrimBlanks(line);
    if (line.front() == '[') return BeginSection(line, number);
    const size_t mark = line.find_first_of(":=");
    if (mark == std::string_view::npos) return absl::OkStatus();
    const std::string key = absl::AsciiStrToLower(std::string(TrimBlanks(line.substr(0, mark))));
    const std::string value(TrimBlanks(line.substr(mark + 1)));
    if (section_ == "printer" && key == "max_accel_to_decel") {
      return Set(value, key, number, kAboveZero, accel_to_decel_);
    }
    for (const Setting& setting : kSettings) {
      if (section_ != setting.section || key != setting.key) continue;
      std::optional<double> read;
      const absl::Status status = Set(value, key, number, setting.range, read);
      MachineLimits& into = setting.lowers ? of_axes_ : limits_;
      std::optional<double>& field = into.*setting.field;
      field = setting.lowers && field && read ? std::min(*field, *read) : read;
      return status;
    }
    return absl::OkStatus();
  }

  absl::Status BeginSection(std::string_view line, int number) {
    const size_t end = line.find(']');
    if (end == std::string_view::npos) return LimitFault(name_, number, "a section without a ]");
    section_ = std::string(TrimBlanks(line.substr(1, end - 1)));
    has_printer_ = has_printer_ || section_ == "printer";
    retracts_ = retracts_ || section_ == "firmware_retraction";
    constexpr std::string_view kInclude = "include ";
    if (!section_.starts_with(kInclude)) return absl::OkStatus();
    return Include(std::string(TrimBlanks(section_.substr(kInclude.size()))), number);
  }

  // What an included file says counts from here on, as if it stood here.
  absl::Status Include(const std::string& pattern, int number) {
    if (!read_includes_) {
      has_unread_ = true;
      return absl::OkStatus();
    }
    if (depth_ == kMostDepth) {
      return LimitFault(name_, number, "files include each other, or too deeply");
    }
    const absl::StatusOr<std::vector<IncludedFile>> files = read_includes_(pattern, name_);
    if (!files.ok()) {
      return LimitFault(name_, number, std::string(files.status().message()));
    }
    const std::string name = name_;
    ++depth_;
    for (const IncludedFile& file : *files) {
      name_ = file.name;
      section_.clear();
      if (const absl::Status status = TakeAll(file.text); !status.ok()) return status;
    }
    --depth_;
    name_ = name;
    section_.clear();
    return absl::OkStatus();
  }

  absl::Status Set(const std::string& text, const std::string& key, int number, const Range& range,
                   std::optional<double>& field) const {
    double value = 0;
    if (!absl::SimpleAtod(text, &value) || !range.holds(value)) {
      return LimitFault(name_, number, absl::StrFormat("%s: \"%s\" is %s", key, text, range.fault));
    }
    field = value;
    return absl::OkStatus();
  }

  void FillDefaults() {
    const auto fill = [](std::optional<double>& field, double value) {
      if (!field) field = value;
    };
    const auto lower = [](std::optional<double>& field, const std::optional<double>& most) {
      if (most) field = std::min(*field, *most);
    };
    fill(limits_.max_z_speed, *limits_.max_speed);
    fill(limits_.z_accel, *limits_.max_accel);
    lower(limits_.max_speed, of_axes_.max_speed);
    lower(limits_.max_accel, of_axes_.max_accel);
    fill(limits_.corner_speed, 5);
    // The setting of before 2024, which counts with the acceleration of the configuration.
    if (accel_to_decel_) {
      fill(limits_.cruise_ratio, 1 - std::min(1.0, *accel_to_decel_ / *limits_.max_accel));
    }
    fill(limits_.cruise_ratio, 0.5);
    fill(limits_.extruder_corner_speed, 1);
    fill(limits_.arc_chord, 1);
    if (!retracts_) return;  // G10 and G11 are macros, if anything
    fill(limits_.firmware_retract_length, 0);
    fill(limits_.firmware_retract_speed, 20);
    fill(limits_.firmware_prime_speed, 10);
    fill(limits_.firmware_prime_extra, 0);
  }

  std::string name_;  // of the file that is being read
  const ReadIncludes& read_includes_;
  int depth_ = 0;  // of includes
  std::string section_;
  bool has_printer_ = false;
  bool has_unread_ = false;  // files are included that cannot be read
  bool retracts_ = false;
  std::optional<double> accel_to_decel_;
  MachineLimits of_axes_;  // what one of X and Y may at most
  MachineLimits limits_;
};

}  // namespace

absl::StatusOr<MachineLimits> ReadKlipperLimits(std::string_view text, const std::string& name,
                                                const ReadIncludes& includes) {
  return KlipperReader(name, includes).Read(text);
}

}  // namespace traverse::gcode
