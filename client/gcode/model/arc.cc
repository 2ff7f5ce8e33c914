#include "client/gcode/model/arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::gcode {
namespace {

// Of any arc, and of one that is longer than any print's: a file may ask for thousands of a
// kilometer's radius.
constexpr double kMostLines = 720;
constexpr double kLongMm = 10'000;
constexpr double kMostLinesOfLong = 16;

// In the unit of the words, relative to the arc's start.
struct Circle {
  Point end;
  Point center;
  double radius = 0;
  double turn = 1;   // -1: clockwise
  double angle = 0;  // from the first end to the last, as it turns; radians, above 0
};

Point CenterOf(const Command& command, Point end) {
  if (command.Has('I') || command.Has('J')) {
    return {command.Has('I') ? ToDouble(command.Value('I')) : 0,
            command.Has('J') ? ToDouble(command.Value('J')) : 0};
  }
  // R: the center lies on the chord's bisector, on the right of a G2's chord; negative R: the long
  // way round.
  const double radius = command.Has('R') ? ToDouble(command.Value('R')) : 0;
  const double chord = std::hypot(end.x, end.y);
  if (!command.Has('R') || !(chord > 0)) return {};
  const double height = std::sqrt(std::max(radius * radius - chord * chord / 4, 0.0));
  const double side = (command.number == 2) == (radius > 0) ? 1 : -1;
  return {end.x / 2 + side * height * end.y / chord, end.y / 2 - side * height * end.x / chord};
}

Circle CircleOf(const Command& command, const Position& from, const Position& to) {
  Circle circle;
  circle.end = {ToDouble(to.x - from.x), ToDouble(to.y - from.y)};
  circle.center = CenterOf(command, circle.end);
  circle.radius = std::hypot(circle.center.x, circle.center.y);
  circle.turn = command.number == 2 ? -1 : 1;
  // From the radius of the start to that of the end. Of two angles of their own one could be pi and
  // the other -pi.
  const auto [i, j] = circle.center;
  const double cross = j * (circle.end.x - i) - i * (circle.end.y - j);
  const double dot = -i * (circle.end.x - i) - j * (circle.end.y - j);
  circle.angle = circle.turn * std::atan2(cross, dot);
  if (circle.angle <= 1e-9) circle.angle += 2 * std::numbers::pi;
  return circle;
}

// The points between the ends that part an arc from `from` into `lines`, or as many as it may have.
std::vector<Point> Parted(const Circle& circle, const Position& from, double unit_mm,
                          double lines) {
  const double radius_mm = circle.radius * unit_mm;
  const double most = circle.angle * radius_mm > kLongMm ? kMostLinesOfLong : kMostLines;
  const int parts = static_cast<int>(std::min(lines, most));
  const double first = std::atan2(-circle.center.y, -circle.center.x);
  const double center_x = (ToDouble(from.x) + circle.center.x) * unit_mm;
  const double center_y = (ToDouble(from.y) + circle.center.y) * unit_mm;
  std::vector<Point> points;
  for (int k = 1; k < parts; ++k) {
    const double angle = first + circle.turn * circle.angle * k / parts;
    points.push_back(
        {center_x + radius_mm * std::cos(angle), center_y + radius_mm * std::sin(angle)});
  }
  return points;
}

}  // namespace

double ArcLength(const Command& command, const Position& from, const Position& to, double unit_mm,
                 double directions[4]) {
  const Circle circle = CircleOf(command, from, to);
  if (directions != nullptr && circle.radius > 0) {
    directions[0] = circle.turn * circle.center.y / circle.radius;
    directions[1] = -circle.turn * circle.center.x / circle.radius;
    directions[2] = -circle.turn * (circle.end.y - circle.center.y) / circle.radius;
    directions[3] = circle.turn * (circle.end.x - circle.center.x) / circle.radius;
  }
  return circle.angle * circle.radius * unit_mm;
}

double StepLengthMm(const Step& step, const MachineState& after) {
  const double unit_mm = after.UnitMm();
  if (step.arc) return ArcLength(step.command, step.from, after.at, unit_mm);
  const double dx = ToDouble(after.at.x - step.from.x);
  const double dy = ToDouble(after.at.y - step.from.y);
  return std::sqrt(dx * dx + dy * dy) * unit_mm;
}

std::vector<Point> ArcPoints(const Command& command, const Position& from, const Position& to,
                             double unit_mm, double tolerance_mm) {
  const Circle circle = CircleOf(command, from, to);
  const double radius_mm = circle.radius * unit_mm;
  if (!(radius_mm > tolerance_mm)) return {};
  // A line within the arc misses it by the radius times 1 - cos(half its angle).
  const double step = 2 * std::acos(1 - tolerance_mm / radius_mm);
  return Parted(circle, from, unit_mm, std::ceil(circle.angle / step));
}

std::vector<Point> ArcChords(const Command& command, const Position& from, const Position& to,
                             double unit_mm, double lines) {
  const Circle circle = CircleOf(command, from, to);
  return Parted(circle, from, unit_mm, lines);
}

bool EndsOnItsCircle(const Command& command, const Position& from, const Position& to,
                     double unit_mm) {
  constexpr double kMaxOffMm = 0.02;
  if (!command.Has('I') && !command.Has('J')) return true;
  const Point end{ToDouble(to.x - from.x), ToDouble(to.y - from.y)};
  const Point center = CenterOf(command, end);
  const double end_radius = std::hypot(end.x - center.x, end.y - center.y);
  return std::abs(std::hypot(center.x, center.y) - end_radius) * unit_mm <= kMaxOffMm;
}

}  // namespace traverse::gcode
