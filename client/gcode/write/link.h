// A link, line by line: what stands between two paths.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_LINK_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_LINK_H_

#include <algorithm>
#include <cstddef>
#include <vector>

#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

struct LinkStep {
  StepKind kind = StepKind::kBlank;
  Line line;
  Position from;
  Position to;
  Decimal filament = 0;  // pushed or pulled back; of kSetE: what the register is set to
  Decimal feed = 0;      // in force for this line
  SlotMask slots = 0;    // kSlot
  uint32_t words = 0;    // of commands
  double way_mm = 0;     // of motion in XY, along the arc if it is one
  bool arc = false;      // G2 or G3
};

struct Link {
  std::vector<LinkStep> steps;

  // Steps [0, fixed) stay as they are; `behind_fixed` is the machine behind them.
  size_t fixed = 0;
  PartStart behind_fixed;

  // Index of the travel move that arrives at the next path: the last one in XY, or the last one
  // with filament pulled back if there are such; not among the fixed ones. -1: none.
  int arrival = -1;
  bool arrives_retracted = false;

  // Filament pulled back before the arrival; 0 if none.
  Decimal pulled = 0;

  // What holds during the arrival.
  PrintState travel_state{};

  // The height of what is printed on either side.
  Decimal z_before = 0;
  Decimal z_behind = 0;

  // The arrival leads, or begins, this much above both of them.
  Decimal lift = 0;

  // The arrival itself leads down to what follows, which lies lower than what was printed before.
  bool sinks = false;

  // Moves in XY that rise to there as well: how long they are, and whether the arrival, level,
  // follows them. 0: it rises by moves of Z alone, or not at all.
  double ramp_mm = 0;
  bool ramp_ends = false;

  // Feed rate of moves of Z alone; 0 if there are none.
  Decimal lift_feed = 0;

  bool retracts() const { return pulled > 0 || firmware; }
  bool SameRetraction(const Link& other) const {
    return pulled == other.pulled && firmware == other.firmware;
  }

  // True if step `i` stands before the arrival.
  bool Leaves(size_t i) const { return static_cast<int>(i) < arrival; }
  bool firmware = false;  // retracts by G10
  bool wipes = false;
  bool departs = false;  // steps before the arrival begin with a short move away from the path

  // The height at which the arrival leads, or that of what follows if it leads lower.
  Decimal top = 0;
};

// Link `index` of the file; 0 < index < file.blocks.size().
Link ReadLink(const GcodeFile& file, size_t index);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_LINK_H_
