#include "client/gcode/link/link_meter.h"

#include <string_view>

namespace traverse::gcode {
namespace {

class LinkMeter {
 public:
  LinkMeter(const GcodeFile& file, const PartStart& start, PrintMeter& meter)
      : file_(file), at_(start), meter_(meter) {}

  void Follow(const NewLink& link) {
    if (link.part()) FollowPart(*link.part());
    for (const LinkLine& line : link.lines()) {
      if (line.form == LineForm::kState) {
        Set(link.state(line), line.step.slots);
      } else if (line.form == LineForm::kSetter) {
        PrintState state = at_.state;
        const std::string_view text = LineAt(line.raw, 0).Text(line.raw);
        ApplySetter(state, file_.setters.Find(text), line.step.slots);
        Set(state, line.step.slots);
      } else {
        FollowLine(line);
      }
    }
  }

 private:
  void FollowPart(const FilePart& part) {
    const std::string_view text = std::string_view(file_.text).substr(0, part.end);
    Interpreter interpreter(text, part.begin, part.before.machine);
    for (Step step; interpreter.Next(step);) meter_.Follow(step, interpreter);
    at_ = part.behind;
  }

  void FollowLine(const LinkLine& line) {
    Step step;
    step.kind = line.step.kind;
    step.from = at_.machine.at;
    step.filament = line.step.filament;
    step.arc = line.step.arc;
    if (step.arc || step.kind == StepKind::kDwell) LexLine(line.raw, step.command);
    at_.machine.at = line.step.to;
    at_.machine.feed = line.step.feed;
    meter_.Follow(step, at_.machine);
  }

  void Set(const PrintState& state, SlotMask slots) {
    bool changes = false;
    for (size_t slot = 0; slot < kSlotCount; ++slot) {
      const bool dynamic = ((kDynamicsSlots & slots) >> slot & 1u) != 0;
      if (!dynamic || at_.state[slot] == state[slot]) continue;
      at_.state[slot] = state[slot];
      changes = true;
    }
    if (changes) meter_.Set(DynamicsOf(file_.profile, at_.state, file_.setters));
  }

  const GcodeFile& file_;
  PartStart at_;
  PrintMeter& meter_;
};

}  // namespace

double LinkSeconds(const GcodeFile& file, const PathEnds& from, const MachineState& at,
                   const NewLink& link, const PathEnds& to) {
  PrintMeter meter = from.Meter();
  from.Follow(from.last(), meter);
  LinkMeter(file, {at, from.state_behind()}, meter).Follow(link);
  to.Follow(to.first(), meter);
  return meter.Finish().seconds - from.last().seconds - to.first().seconds;
}

}  // namespace traverse::gcode
