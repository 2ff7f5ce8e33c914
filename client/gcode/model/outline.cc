#include "client/gcode/model/outline.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "client/gcode/dialects/dialect.h"
#include "client/gcode/model/path_body.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

// The gap of a loop, at most, where lines are not wide.
constexpr double kUsualGapMm = 0.13;

std::optional<double> SlotNumber(const GcodeFile& file, const Block& block, Slot slot) {
  const std::string_view line = file.setters.Line(file.states[block.state_in][slot]);
  std::string_view number = TrimBlanks(line.substr(line.find(':') + 1));
  if (const Mark* mark = MarkOf(line); mark && mark->kind == MarkKind::kWidthAndHeight) {
    const size_t at = line.find(slot == kSlotWidth ? 'W' : 'H');
    number = at == std::string_view::npos ? std::string_view{} : line.substr(at + 1);
  }
  const std::optional<double> value = LeadingNumber(number);
  return value && *value > 0 ? value : std::nullopt;
}

// The cross-section that is deposited is a rectangle with half circles at its sides.
double WidthOfFlow(const GcodeFile& file, const Block& block) {
  const double diameter = file.profile.filament_diameter;
  const double filament = ToDouble(block.e_out - block.e_in) * file.modes[block.mode].UnitMm();
  if (!(filament > 0) || !(block.length_mm > 0)) return 0;
  const double area =
      filament * diameter * diameter * std::numbers::pi / 4 / static_cast<double>(block.length_mm);
  const Layer& layer = file.layers[file.LayerOf(static_cast<size_t>(&block - file.blocks.data()))];
  const double height = SlotNumber(file, block, kSlotHeight).value_or(layer.height_mm);
  return area / height + height * (1 - std::numbers::pi / 4);
}

double WidthOf(const GcodeFile& file, const Block& block) {
  constexpr double kLeastMm = 0.2;
  constexpr double kMostMm = 3;
  constexpr double kMostByFlowMm = 1.2;  // the height may not be known
  const std::optional<double> stated = SlotNumber(file, block, kSlotWidth);
  if (stated) return std::clamp(*stated, kLeastMm, kMostMm);
  return std::clamp(WidthOfFlow(file, block), kLeastMm, kMostByFlowMm);
}

// An arc of a larger radius is as good as straight.
constexpr double kMostRadiusMm = 1e4;

std::vector<Point> BentShape(const GcodeFile& file, const Block& block) {
  const MachineState& mode = file.modes[block.mode];
  std::vector<Point> shape = {mode.InMm(block.first)};
  for (const BodySegment& segment : ReadBody(file, block).segments) {
    const Point from = mode.InMm(segment.from);
    for (const Point& point : BendsOf(segment, mode.UnitMm())) {
      if (Distance(from, point) < 2 * kMostRadiusMm) shape.push_back(point);
    }
    shape.push_back(mode.InMm(segment.to));
  }
  return shape;
}

}  // namespace

double LengthMm(absl::Span<const Point> points) {
  double length = 0;
  for (size_t k = 1; k < points.size(); ++k) length += Distance(points[k - 1], points[k]);
  return length;
}

double LoopGapMm(const GcodeFile& file, double width_mm) {
  constexpr double kShare = 0.15;
  constexpr double kRoundedMm = 0.005;
  const double widest = std::max(width_mm, file.profile.nozzle_diameter.value_or(0));
  return std::max(kUsualGapMm, kShare * widest + kRoundedMm);
}

MachineState StateAt(const GcodeFile& file, const Block& block) {
  MachineState state = file.modes[block.mode];
  state.at = block.first;
  state.e = block.e_in;
  state.feed = block.feed_in;
  state.retracted = 0;
  state.firmware_retracted = false;
  return state;
}

Outline OutlineOf(const GcodeFile& file, const Block& block) {
  Outline outline;
  const auto ends = file.ends.begin() + block.first_end;
  outline.points.reserve(block.end_count + size_t{1});
  outline.points.push_back(file.modes[block.mode].InMm(block.first));
  outline.points.insert(outline.points.end(), ends, ends + block.end_count);
  if ((block.flags & kBlockArcs) != 0) outline.bent = BentShape(file, block);
  outline.width_mm = WidthOf(file, block);
  const double gap = Distance(outline.points.front(), outline.points.back());
  const double shortest = 8 * std::max(gap, kUsualGapMm);
  outline.is_loop = outline.shape().size() > 3 && gap <= LoopGapMm(file, outline.width_mm) &&
                    static_cast<double>(block.length_mm) > shortest;
  const bool many_starts =
      outline.points.size() > 3 && (outline.bent.empty() || LengthMm(outline.points) > shortest);
  outline.closed = outline.is_loop && (many_starts || gap == 0);
  outline.one_start = outline.closed && !many_starts;
  outline.feature = FeatureOf(file, block, outline.is_loop);
  return outline;
}

}  // namespace traverse::gcode
