#include "client/gcode/write/going_on.h"

namespace traverse::gcode {

std::optional<LinkStep> ReadGoingOn(const GcodeFile& file, uint32_t block) {
  const bool goes_on = (file.blocks[block].flags & kBlockGoesOn) != 0;
  if (!goes_on || block + 1 >= file.blocks.size()) return std::nullopt;
  for (const LinkStep& step : ReadLink(file, block + 1).steps) {
    if (step.kind == StepKind::kTravel) return step;
  }
  return std::nullopt;
}

}  // namespace traverse::gcode
