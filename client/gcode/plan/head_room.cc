#include "client/gcode/plan/head_room.h"

#include <algorithm>
#include <utility>

#include "client/gcode/model/arc.h"
#include "client/gcode/model/outline.h"
#include "engine/geometry/bounding_box.h"

namespace traverse::gcode {
namespace {

// Where the file does not state them: how far parts of the head reach around the nozzle, and how
// high above its tip the lowest of them hang.
constexpr double kRadiusMm = 30;
constexpr double kNozzleMm = 2;

// Half of a line, of the flat around the hole of a nozzle, and of a cell.
constexpr double kTipMm = 0.9;
constexpr double kTipCellMm = 0.5;
constexpr double kHeadCellMm = 2;

constexpr double kArcToleranceMm = 0.1;

// Of about a nanosecond each.
constexpr int64_t kMostSteps = 1'000'000'000;
constexpr size_t kMostTiles = 12'000;  // 6.4 MB

// From a tower that lags behind the height goes up again at once: nothing is in the way up there.
constexpr double kJumpMm = 3;

// The first layers of passes, the first one left out; none if the height never goes down.
std::vector<size_t> PassesOf(const GcodeFile& file) {
  std::vector<size_t> passes;
  bool descends = false;
  for (size_t i = 1; i < file.layers.size(); ++i) {
    const double rise = file.HeightMm(file.layers[i]) - file.HeightMm(file.layers[i - 1]);
    descends |= rise < 0;
    if (rise < 0 || rise > kJumpMm) passes.push_back(i);
  }
  return descends ? passes : std::vector<size_t>();
}

// Follows a file for both parts of the head.
class Follower {
 public:
  Follower(const GcodeFile& file, const BoundingBox& bounds)
      : interpreter_(file.text),
        tip_(bounds, {kTipCellMm, 0, kTipMm,
                      std::min(kTipMm + NozzleMm(file),
                               file.profile.clearance_radius.value_or(kRadiusMm))}),
        head_(bounds, {kHeadCellMm, NozzleMm(file), RadiusMm(file), RadiusMm(file), kHeadCellMm}) {}

  // Up to the line that begins at `end`.
  void FollowTo(Offset end) {
    for (Step step; interpreter_.Next(step);) {
      Follow(step);
      if (step.line.next >= end) return;
    }
  }

  Room EndPass(int64_t& steps) { return {tip_.EndPass(steps), head_.EndPass(steps)}; }

 private:
  static double NozzleMm(const GcodeFile& file) {
    return file.profile.nozzle_height.value_or(kNozzleMm);
  }
  static double RadiusMm(const GcodeFile& file) {
    return file.profile.clearance_radius.value_or(kRadiusMm) + kHeadCellMm;
  }

  void Follow(const Step& step) {
    if (!IsXyMotion(step.kind) && step.kind != StepKind::kLift) return;
    const MachineState& machine = interpreter_.state();
    const double unit = machine.UnitMm();
    const Position& to = machine.at;
    std::vector<Point> points = {machine.InMm(step.from)};
    if (step.arc) {
      for (const Point& p : ArcPoints(step.command, step.from, to, unit, kArcToleranceMm)) {
        points.push_back(p);
      }
    }
    points.push_back(machine.InMm(to));
    const double from_mm = ToDouble(step.from.z) * unit;
    const double to_mm = ToDouble(to.z) * unit;
    const auto n = static_cast<double>(points.size() - 1);
    for (size_t i = 1; i < points.size(); ++i) {
      const double begin = from_mm + (to_mm - from_mm) * static_cast<double>(i - 1) / n;
      const double end = from_mm + (to_mm - from_mm) * static_cast<double>(i) / n;
      for (RoomBuilder* builder : {&tip_, &head_}) {
        builder->Visit(points[i - 1], begin, points[i], end);
        if (step.kind != StepKind::kExtrude) continue;
        builder->Print(points[i - 1], points[i], std::max(begin, end));
      }
    }
  }

  Interpreter interpreter_;
  RoomBuilder tip_;
  RoomBuilder head_;
};

}  // namespace

HeadRoom::HeadRoom(const GcodeFile& file) : rooms_(file.layers.size()) {
  std::vector<size_t> passes = PassesOf(file);
  if (passes.empty()) return;
  BoundingBox bounds;
  for (const Block& block : file.blocks) bounds.Add(BoundingBox(OutlineOf(file, block).shape()));
  Follower follower(file, bounds);
  int64_t steps = kMostSteps;
  size_t tiles = 0;
  passes.push_back(file.layers.size());
  size_t first = 0;
  for (const size_t end : passes) {
    follower.FollowTo(file.blocks[file.layers[end - 1].end_block - 1].end);
    Room room = follower.EndPass(steps);
    const size_t of_room = room.tip.tiles() + room.head.tiles();
    tiles += of_room;
    if (tiles > kMostTiles || steps <= 0) return;
    if (of_room > 0) {
      std::fill(rooms_.begin() + static_cast<std::ptrdiff_t>(first),
                rooms_.begin() + static_cast<std::ptrdiff_t>(end),
                std::make_shared<const Room>(std::move(room)));
    }
    first = end;
  }
}

}  // namespace traverse::gcode
