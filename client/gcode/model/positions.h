// Arithmetic on positions in the plane, in the unit of the file's words.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_POSITIONS_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_POSITIONS_H_

#include <cmath>
#include <utility>
#include <vector>

#include "client/gcode/machine/interpreter.h"
#include "engine/model/point.h"

namespace traverse::gcode {

// Filament is written as slicers do, to hundredths of a micrometre.
inline constexpr Decimal kFilamentStep = kDecimalOne / 100'000;

// New positions are written as slicers do, to thousandths of a mm; in longer units as finely at
// least.
inline Decimal RoundedWord(double value, double unit_mm) {
  const Decimal step = unit_mm > 1 ? kDecimalOne / 100'000 : kDecimalOne / 1000;
  return std::llround(value * static_cast<double>(kDecimalOne / step)) * step;
}

// A point in mm, in words of `unit_mm`; at no height.
inline Position InWords(Point mm, double unit_mm) {
  return {RoundedWord(mm.x / unit_mm, unit_mm), RoundedWord(mm.y / unit_mm, unit_mm), 0};
}

inline double LengthXy(const Position& from, const Position& to) {
  return std::hypot(ToDouble(to.x - from.x), ToDouble(to.y - from.y));
}

// Of the travel from `from` through the points of `travel`.
inline double LengthXy(Position from, const std::vector<Position>& travel) {
  double length = 0;
  for (const Position& to : travel) length += LengthXy(std::exchange(from, to), to);
  return length;
}

// The point that lies `length` beyond `from` towards `to`, in words of `unit_mm`, at the height of
// `from`; not rounded up to `to` itself.
inline Position Along(const Position& from, const Position& to, double length, double unit_mm) {
  const double whole = LengthXy(from, to);
  Position at = from;
  if (!(whole > 0)) return at;
  at.x = RoundedWord(ToDouble(from.x) + ToDouble(to.x - from.x) / whole * length, unit_mm);
  at.y = RoundedWord(ToDouble(from.y) + ToDouble(to.y - from.y) / whole * length, unit_mm);
  return at;
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_POSITIONS_H_
