#include "client/gcode/stated_progress.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include "absl/strings/str_format.h"
#include "client/gcode/measure/layer_meter.h"

namespace traverse {
namespace gcode {
namespace {

// Slicers reckon with accelerations that are not known here.
constexpr double kFarPoints = 20;

struct StatedShare {
  Offset at = 0;
  double percent = 0;
};

std::optional<double> PercentOfM73(const GcodeFile& file, Offset at) {
  Command command;
  LexLine(LineAt(file.text, at).Text(file.text), command);
  if (!command.Is('M', 73) || !ReadWords(command) || !command.Has('P')) return std::nullopt;
  return ToDouble(command.Value('P'));
}

}  // namespace
}  // namespace gcode

std::vector<std::string> DescribeProgressFaults(const GcodeFile& file) {
  std::vector<gcode::StatedShare> shares;
  gcode::TextMoments moments;
  for (const gcode::Offset at : file.progress) {
    const std::optional<double> percent = gcode::PercentOfM73(file, at);
    if (!percent) continue;
    shares.push_back({at, *percent});
    moments.offsets.push_back(at);
  }
  if (shares.empty()) return {};
  const gcode::Offset end = file.blocks.back().end;
  moments.offsets.push_back(file.text.size());
  std::vector<std::string> faults;
  for (size_t i = 1; i < shares.size(); ++i) {
    if (shares[i].percent >= shares[i - 1].percent || shares[i].at >= end) continue;
    faults.push_back(absl::StrFormat(
        "M73 goes back from %.0f to %.0f %% in %s; such lines keep their sequence, and their share "
        "of the time",
        shares[i - 1].percent, shares[i].percent, file.Place(shares[i].at)));
    break;
  }
  gcode::MeasureMoments(file, file.text, gcode::StartOfFile(file), &moments);
  const double begun = moments.seconds.front();
  const double seconds = moments.seconds.back() - begun;
  const gcode::StatedShare* worst = nullptr;
  double worst_percent = 0;
  double worst_off = gcode::kFarPoints;
  for (size_t i = 0; i < shares.size() && seconds > 0; ++i) {
    const double percent = 100 * (moments.seconds[i] - begun) / seconds;
    if (std::abs(percent - shares[i].percent) <= worst_off) continue;
    worst = &shares[i];
    worst_percent = percent;
    worst_off = std::abs(percent - shares[i].percent);
  }
  if (worst != nullptr) {
    faults.push_back(absl::StrFormat(
        "M73 states %.0f %% at about %.0f %% of the print time in %s; it stays as far off",
        worst->percent, worst_percent, file.Place(worst->at)));
  }
  return faults;
}

}  // namespace traverse
