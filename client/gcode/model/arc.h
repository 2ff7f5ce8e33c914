// The circular moves, G2 (clockwise) and G3.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_ARC_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_ARC_H_

#include <vector>

#include "client/gcode/machine/interpreter.h"
#include "client/gcode/model/outline.h"

namespace traverse::gcode {

// The length in mm of the arc that `command` (G2 or G3) makes between two positions, and optionally
// the directions in which it begins and ends (bx, by, ex, ey). `unit_mm` is the length of one unit.
double ArcLength(const Command& command, const Position& from, const Position& to, double unit_mm,
                 double directions[4] = nullptr);

// The length in mm that the move of `step` has in the plane, along its arc if it is one. The
// machine is in `after` behind it.
double StepLengthMm(const Step& step, const MachineState& after);

// Points on that arc between its ends, in mm and in order, such that the lines between them stay
// within `tolerance_mm` of it; none for a flatter arc. At most 719, or 15 of an arc of more than
// 10 m.
std::vector<Point> ArcPoints(const Command& command, const Position& from, const Position& to,
                             double unit_mm, double tolerance_mm);

// The points between its ends that divide the arc into `lines` equal pieces, at most 720, as
// firmware without true arcs does. `lines` is a whole number, at least 1.
std::vector<Point> ArcChords(const Command& command, const Position& from, const Position& to,
                             double unit_mm, double lines);

// An arc that ends beside its circle is not a true arc: how a machine executes it depends on where
// it begins. False if it ends farther off than rounding explains.
bool EndsOnItsCircle(const Command& command, const Position& from, const Position& to,
                     double unit_mm);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_ARC_H_
