// How a placed path begins and ends, as far as a link beside it changes how fast it is printed.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_PATH_ENDS_H_
#define TRAVERSE_CLIENT_GCODE_LINK_PATH_ENDS_H_

#include <vector>

#include "client/gcode/machine/machine_profile.h"
#include "client/gcode/measure/print_meter.h"
#include "client/gcode/model/placed_path.h"

namespace traverse::gcode {

// Some moves of a path, one after the other.
struct PrintedMoves {
  std::vector<BodySegment> moves;  // those without filament are travel
  double seconds = 0;              // from standstill to standstill
};

class PathEnds {
 public:
  PathEnds(const GcodeFile& file, const PlacedPath& path);

  // The whole path alone, from standstill to standstill.
  double seconds() const { return seconds_; }

  // So much of the path that the machine may get to its speed there, and stop again.
  const PrintedMoves& first() const { return first_; }
  const PrintedMoves& last() const { return last_; }

  // What is in force behind the path.
  const PrintState& state_behind() const { return state_behind_; }

  // A meter at standstill, and what follows first() or last() with it.
  PrintMeter Meter() const { return PrintMeter(file_->profile, dynamics_.front(), nullptr); }
  void Follow(const PrintedMoves& printed, PrintMeter& meter) const;

 private:
  double SecondsOf(const PrintedMoves& printed) const;

  // Whether the machine may get to its speed and stop again within `mm`, of which `move` is a part.
  bool IsEnough(double mm, const BodySegment& move) const;

  const GcodeFile* file_;
  MachineState modes_;
  std::vector<Dynamics> dynamics_;  // [BodySegment::state]
  PrintState state_behind_;
  double seconds_ = 0;
  PrintedMoves first_;
  PrintedMoves last_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_PATH_ENDS_H_
