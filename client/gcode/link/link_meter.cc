#include "client/gcode/link/link_meter.h"

#include <string_view>

namespace traverse::gcode {

LinkMeter::LinkMeter(const GcodeFile& file, const PartStart& start, const Joint& joint)
    : file_(file),
      at_(start),
      meter_(file.profile, DynamicsOf(file.profile, start.state, file.setters), nullptr) {
  Print(joint);
}

void LinkMeter::Follow(const NewLink& link) {
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

void LinkMeter::Set(const PrintState& state, SlotMask slots) {
  bool changes = false;
  for (size_t slot = 0; slot < kSlotCount; ++slot) {
    const bool dynamic = ((kDynamicsSlots & slots) >> slot & 1u) != 0;
    if (!dynamic || at_.state[slot] == state[slot]) continue;
    at_.state[slot] = state[slot];
    changes = true;
  }
  if (changes) meter_.Set(DynamicsOf(file_.profile, at_.state, file_.setters));
}

void LinkMeter::FollowPart(const FilePart& part) {
  const std::string_view text = std::string_view(file_.text).substr(0, part.end);
  Interpreter interpreter(text, part.begin, part.before.machine);
  for (Step step; interpreter.Next(step);) meter_.Follow(step, interpreter);
  at_ = part.behind;
}

void LinkMeter::FollowLine(const LinkLine& line) {
  Step step;
  step.kind = line.step.kind;
  step.from = at_.machine.at;
  step.filament = line.step.filament;
  step.arc = line.step.arc;
  if (step.arc) LexLine(line.raw, step.command);
  at_.machine.at = line.step.to;
  at_.machine.feed = line.step.feed;
  meter_.Follow(step, at_.machine);
}

// Straight on, long enough to get going from standstill to the joint and to stop there. That it
// stands still where the path goes on is no loss.
void LinkMeter::Print(const Joint& joint) {
  if (!(joint.speed_mm_s > 0)) return;
  const double ramp_seconds = joint.speed_mm_s / joint.accel_mm_s2;
  const double length = joint.speed_mm_s * ramp_seconds;
  meter_.Print(joint.along.x * length, joint.along.y * length, joint.speed_mm_s, joint.accel_mm_s2);
  printing_seconds_ += 1.5 * ramp_seconds;
}

double LinkMeter::Finish(const Joint& joint) {
  Print(joint);
  return meter_.Finish().seconds - printing_seconds_;
}

}  // namespace traverse::gcode
