#include "client/gcode/model/part_start.h"

#include "client/gcode/model/outline.h"

namespace traverse::gcode {

PartStart StartBehind(const GcodeFile& file, const Block& block) {
  PartStart start{StateAt(file, block), file.states[block.state_out]};
  start.machine.at = block.last;
  start.machine.e = block.e_out;
  start.machine.feed = block.feed_out;
  return start;
}

}  // namespace traverse::gcode
