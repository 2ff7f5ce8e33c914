// A link, line by line: what stands between two paths.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_H_
#define TRAVERSE_CLIENT_GCODE_LINK_H_

#include <cstddef>
#include <vector>

#include "client/gcode/gcode_file.h"

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
};

struct Link {
  std::vector<LinkStep> steps;

  // Index of the travel move that arrives at the next path: the last one in XY, or the last one
  // with filament pulled back if there are such. -1: none.
  int arrival = -1;

  // Filament pulled back before the arrival; 0 if none.
  Decimal pulled = 0;

  // What holds during the arrival.
  PrintState travel_state{};

  // The height of what is printed on either side.
  Decimal z_before = 0;
  Decimal z_behind = 0;

  bool retracts() const { return pulled > 0 || firmware; }
  bool SameRetraction(const Link& other) const {
    return pulled == other.pulled && firmware == other.firmware;
  }

  // True if step `i` stands before the arrival.
  bool Leaves(size_t i) const { return static_cast<int>(i) < arrival; }
  bool firmware = false;  // retracts by G10
  bool wipes = false;
  bool departs = false;  // steps before the arrival begin with a short move away from the path
};

// Link `index` of the file; 0 < index < file.blocks.size().
Link ReadLink(const GcodeFile& file, size_t index);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_H_
