#include "client/gcode/link/new_link.h"

#include <cassert>

namespace traverse::gcode {

LinkLine& NewLink::Add(LineForm form, std::string_view raw, StepKind kind, const Position& to) {
  LinkLine& line = lines_.emplace_back();
  line.form = form;
  line.raw = raw;
  line.step.kind = kind;
  line.step.from = machine_.at;
  line.step.to = machine_.at = to;
  line.step.feed = machine_.feed;
  return line;
}

void NewLink::Keep(const FilePart& part) {
  assert(lines_.empty());
  part_ = part;
  machine_ = part.behind.machine;
  pulled_ = machine_.retracted;
}

void NewLink::Raw(std::string_view line) {
  Add(LineForm::kRaw, line, StepKind::kComment, machine_.at);
}

void NewLink::Set(const PrintState& state, SlotMask slots) {
  LinkLine& line = Add(LineForm::kState, {}, StepKind::kSlot, machine_.at);
  line.step.slots = slots;
  line.state = states_.size();
  states_.push_back(state);
}

void NewLink::SetBy(std::string_view line, SlotMask slots) {
  Add(LineForm::kSetter, line, StepKind::kSlot, machine_.at).step.slots = slots;
}

void NewLink::Edited(const LinkStep& step, const GcodeFile& file, const Position& to) {
  const bool moves =
      step.kind == StepKind::kFilament || step.kind == StepKind::kLift || IsXyMotion(step.kind);
  const Position from = machine_.at;
  LinkLine& line = Add(LineForm::kEdited, step.line.Raw(file.text), step.kind, to);
  line.in_file = step.to;
  line.step = step;
  line.step.from = from;
  line.step.to = to;
  if (moves || (step.words & Command::Bit('F')) != 0) machine_.feed = step.feed;
  if (step.kind != StepKind::kSetE) pulled_ -= step.filament;
}

void NewLink::Travel(std::string_view line, const Position& to, Decimal feed) {
  machine_.feed = feed;
  Add(LineForm::kTravel, line, StepKind::kTravel, to);
}

void NewLink::Feed(Decimal feed) {
  machine_.feed = feed;
  Add(LineForm::kStand, {}, StepKind::kFeed, machine_.at);
}

void NewLink::Lift(Decimal z, Decimal feed) {
  machine_.feed = feed;
  Add(LineForm::kStand, {}, StepKind::kLift, {machine_.at.x, machine_.at.y, z});
}

void NewLink::Pull(Decimal filament, Decimal feed) {
  machine_.feed = feed;
  Add(LineForm::kStand, {}, StepKind::kFilament, machine_.at).step.filament = -filament;
  pulled_ += filament;
}

void NewLink::Segment(const Position& to, bool extrudes, Decimal filament, Decimal feed) {
  machine_.feed = feed;
  const StepKind kind = extrudes ? StepKind::kWipe : StepKind::kTravel;
  LinkLine& line = Add(LineForm::kSegment, {}, kind, {to.x, to.y, machine_.at.z});
  line.step.filament = filament;
  pulled_ -= filament;
}

}  // namespace traverse::gcode
