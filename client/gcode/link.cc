#include "client/gcode/link.h"

#include <algorithm>

#include "client/gcode/layer_meter.h"

namespace traverse::gcode {
namespace {

// Slicers' moves inwards; combing moves of CuraEngine look the same but lead somewhere.
bool MayDepart(const GcodeFile& file, const Block& block) {
  return file.dialect != Dialect::kCura && (block.link & kLinkDeparts) != 0;
}

void NoteRetraction(const LinkStep& step, Decimal& retracted, Link& link) {
  if (step.kind == StepKind::kFirmwareRetract) link.firmware = true;
  retracted = std::max<Decimal>(retracted - step.filament, 0);
  link.pulled = std::max(link.pulled, retracted);
}

}  // namespace

Link ReadLink(const GcodeFile& file, size_t index) {
  const Block& before = file.blocks[index - 1];
  const Block& behind = file.blocks[index];
  Link link;
  link.z_before = before.last.z;
  link.z_behind = behind.first.z;
  link.departs = MayDepart(file, behind);
  PartStart start = StartBehind(file, before);
  Interpreter interpreter(std::string_view(file.text).substr(0, behind.begin), before.end,
                          start.machine);
  Decimal retracted = 0;
  PrintState state = start.state;
  for (Step step; interpreter.Next(step);) {
    LinkStep added{step.kind,     step.line,
                   step.from,     interpreter.state().at,
                   step.filament, interpreter.state().feed,
                   step.slots,    step.command.words};
    if (step.command.kind != LineKind::kCommand) added.words = 0;
    // A wipe's pull may round to nothing.
    if (added.kind == StepKind::kZeroExtrude) added.kind = StepKind::kWipe;
    if (added.kind == StepKind::kSetE) {
      added.filament = step.command.Value('E');
    } else {
      NoteRetraction(added, retracted, link);
    }
    link.wipes = link.wipes || added.kind == StepKind::kWipe;
    if (added.kind == StepKind::kSlot) {
      ApplySetter(state, file.setters.Find(step.line.Text(file.text)), step.slots);
    }
    // Where CuraEngine primes before the last stretch of the way, the way proper ends there.
    const bool behind_prime = link.retracts() && !step.retracted;
    if (added.kind == StepKind::kTravel && (link.arrival < 0 || !behind_prime)) {
      link.arrival = static_cast<int>(link.steps.size());
      link.travel_state = state;
    }
    link.steps.push_back(added);
  }
  return link;
}

}  // namespace traverse::gcode
