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
  double i = 0;  // the center
  double j = 0;
  double radius = 0;
  double turn = 1;   // -1: clockwise
  double angle = 0;  // from the first end to the last, as it turns; radians, above 0
};

// The center of the arc relative to its start.
void CenterOffset(const Command& command, double dx, double dy, double& i, double& j) {
  i = command.Has('I') ? ToDouble(command.Value('I')) : 0;
  j = command.Has('J') ? ToDouble(command.Value('J')) : 0;
  if (command.Has('I') || command.Has('J') || !command.Has('R')) return;
  // R: the center lies on the chord's bisector, on the right of a G2's chord; negative R: the long
  // way round.
  const double radius = ToDouble(command.Value('R'));
  const double chord = std::hypot(dx, dy);
  if (!(chord > 0)) return;
  const double height = std::sqrt(std::max(radius * radius - chord * chord / 4, 0.0));
  const double side = (command.number == 2) == (radius > 0) ? 1 : -1;
  i = dx / 2 + side * height * dy / chord;
  j = dy / 2 - side * height * dx / chord;
}

Circle CircleOf(const Command& command, double dx, double dy) {
  Circle circle;
  CenterOffset(command, dx, dy, circle.i, circle.j);
  circle.radius = std::hypot(circle.i, circle.j);
  circle.turn = command.number == 2 ? -1 : 1;
  // From the radius of the start to that of the end. Of two angles of their own one could be pi and
  // the other -pi.
  const double cross = circle.j * (dx - circle.i) - circle.i * (dy - circle.j);
  const double dot = -circle.i * (dx - circle.i) - circle.j * (dy - circle.j);
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
  const double first = std::atan2(-circle.j, -circle.i);
  const double center_x = (ToDouble(from.x) + circle.i) * unit_mm;
  const double center_y = (ToDouble(from.y) + circle.j) * unit_mm;
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
  const double dx = ToDouble(to.x - from.x);
  const double dy = ToDouble(to.y - from.y);
  const Circle circle = CircleOf(command, dx, dy);
  if (directions != nullptr && circle.radius > 0) {
    directions[0] = circle.turn * circle.j / circle.radius;
    directions[1] = -circle.turn * circle.i / circle.radius;
    directions[2] = -circle.turn * (dy - circle.j) / circle.radius;
    directions[3] = circle.turn * (dx - circle.i) / circle.radius;
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
  const Circle circle = CircleOf(command, ToDouble(to.x - from.x), ToDouble(to.y - from.y));
  const double radius_mm = circle.radius * unit_mm;
  if (!(radius_mm > tolerance_mm)) return {};
  // A line within the arc misses it by the radius times 1 - cos(half its angle).
  const double step = 2 * std::acos(1 - tolerance_mm / radius_mm);
  return Parted(circle, from, unit_mm, std::ceil(circle.angle / step));
}

std::vector<Point> ArcChords(const Command& command, const Position& from, const Position& to,
                             double unit_mm, double lines) {
  const Circle circle = CircleOf(command, ToDouble(to.x - from.x), ToDouble(to.y - from.y));
  return Parted(circle, from, unit_mm, lines);
}

bool EndsOnItsCircle(const Command& command, const Position& from, const Position& to,
                     double unit_mm) {
  constexpr double kMaxOffMm = 0.02;
  if (!command.Has('I') && !command.Has('J')) return true;
  const double i = command.Has('I') ? ToDouble(command.Value('I')) : 0;
  const double j = command.Has('J') ? ToDouble(command.Value('J')) : 0;
  const double x = ToDouble(to.x - from.x) - i;
  const double y = ToDouble(to.y - from.y) - j;
  return std::abs(std::hypot(i, j) - std::hypot(x, y)) * unit_mm <= kMaxOffMm;
}

}  // namespace traverse::gcode
