#include <algorithm>
#include <cassert>
#include <cmath>
#include <string_view>
#include <utility>

#include "client/gcode/link/link.h"
#include "client/gcode/model/arc.h"
#include "client/gcode/model/positions.h"

namespace traverse::gcode {
namespace {

LinkStep StepOf(const Step& step, const MachineState& after) {
  LinkStep taken;
  taken.kind = step.kind;
  taken.line = step.line;
  taken.from = step.from;
  taken.to = after.at;
  taken.filament = step.kind == StepKind::kSetE ? step.command.Value('E') : step.filament;
  taken.e = after.e;
  taken.feed = after.feed;
  taken.slots = step.slots;
  taken.arc = step.arc;
  taken.relative = step.relative;
  if (step.command.kind == LineKind::kCommand) taken.words = step.command.words;
  if (IsXyMotion(step.kind)) {
    taken.travel_mm =
        step.arc ? ArcLength(step.command, step.from, after.at, 1) : LengthXy(step.from, after.at);
  }
  return taken;
}

// How the travel proper comes to its height.
void NoteLift(Link& link) {
  for (const LinkStep& step : link.steps) {
    if (step.kind == StepKind::kLift && step.feed > 0) link.lift_feed = step.feed;
  }
  if (link.arrival < 0) return;
  const LinkStep& arrival = link.arriving();
  const Decimal top = std::max(arrival.from.z, arrival.to.z);
  link.lift = std::max<Decimal>(0, top - std::max(link.z_before, link.z_behind));
  // Slicers that lift by less than a layer travel to the next one below its height.
  link.top = top > link.z_before ? top : std::max(top, link.z_behind);
  link.sinks = link.lift == 0 && arrival.to.z < arrival.from.z && arrival.to.z == link.z_behind;
  for (size_t i = link.fixed; i <= static_cast<size_t>(link.arrival); ++i) {
    const LinkStep& step = link.steps[i];
    if (step.kind == StepKind::kTravel && step.to.z > step.from.z) link.ramp_mm += step.travel_mm;
  }
  link.ramp_ends = link.ramp_mm > 0 && arrival.to.z == arrival.from.z;
}

// Reads the lines between two blocks.
class LinkReader {
 public:
  LinkReader(const GcodeFile& file, size_t index)
      : file_(file), aside_((file.blocks[index].link & kLinkAside) != 0) {
    const Block& before = file.blocks[index - 1];
    const Block& behind = file.blocks[index];
    link_.z_before = before.last.z;
    link_.z_behind = behind.first.z;
    link_.layer_behind = std::max(behind.first.z, behind.last.z);
    link_.departs = MayDepart(file, index);
    Read(before.end, behind.begin, StartBehind(file, before));
    NoteLift(link_);
  }

  Link link() && { return std::move(link_); }

 private:
  void Read(Offset begin, Offset end, PartStart start) {
    state_ = start.state;
    Interpreter interpreter(std::string_view(file_.text).substr(0, end), begin, start.machine);
    for (Step step; interpreter.Next(step);) {
      const LinkStep added = Follow(step, interpreter.state());
      const bool travels_on = aside_ && added.kind == StepKind::kTravel;
      if (travels_on && up_to_travel_ > link_.fixed) Keep(up_to_travel_, behind_travel_);
      if (added.kind == StepKind::kTravel) NoteTravel(step.retracted);
      link_.steps.push_back(added);
      if (travels_on) {
        up_to_travel_ = link_.steps.size();
        behind_travel_ = {interpreter.state(), state_};
      }
      if (Stays(step)) KeepAll({interpreter.state(), state_});
    }
  }

  // The step, and what the link does by it.
  LinkStep Follow(const Step& step, const MachineState& after) {
    LinkStep added = StepOf(step, after);
    marked_ = marked_ || added.kind == StepKind::kWipeMark;
    // A wipe's pull may round to nothing.
    if (added.kind == StepKind::kZeroExtrude) {
      added.kind = step.retracted || marked_ ? StepKind::kWipe : StepKind::kTravel;
    }
    if (added.kind == StepKind::kFirmwareRetract) link_.firmware = true;
    if (added.kind != StepKind::kSetE) {
      retracted_ = std::max<Decimal>(retracted_ - added.filament, 0);
      link_.pulled = std::max(link_.pulled, retracted_);
    }
    link_.wipes = link_.wipes || added.kind == StepKind::kWipe;
    if (added.kind == StepKind::kSlot) {
      ApplySetter(state_, file_.setters.Find(step.line.Text(file_.text)), step.slots);
    }
    return added;
  }

  // The next step travels.
  void NoteTravel(bool retracted) {
    // If CuraEngine primes before the last stretch of the travel, the travel proper ends there.
    const bool behind_prime = link_.retracts() && !retracted;
    if (link_.arrival >= 0 && behind_prime) return;
    link_.arrival = static_cast<int>(link_.steps.size());
    link_.arrives_retracted = retracted;
    link_.travel_state = state_;
  }

  bool Stays(const Step& step) const {
    return step.kind == StepKind::kUnknown || step.kind == StepKind::kModeChange ||
           step.line.begin < file_.script_end;
  }

  void KeepAll(const PartStart& behind) {
    // Of so many lines that stay nothing matters but where they end.
    if (link_.steps.size() >= Interpreter::kMostOfLink) {
      link_.steps = {link_.steps.back()};
      link_.departs = false;
      up_to_travel_ = 0;
    }
    Keep(link_.steps.size(), behind);
  }

  // The first `steps` of the link stay, and leave `behind`.
  void Keep(size_t steps, const PartStart& behind) {
    link_.fixed = steps;
    link_.behind_fixed = behind;
    link_.arrival = -1;
  }

  const GcodeFile& file_;
  const bool aside_;
  Link link_;
  PrintState state_{};
  Decimal retracted_ = 0;
  bool marked_ = false;
  size_t up_to_travel_ = 0;  // the steps up to the last travel aside
  PartStart behind_travel_;  // what they leave behind
};

}  // namespace

Link ReadLink(const GcodeFile& file, size_t index) {
  assert(index < file.blocks.size());
  if (index == 0) return {};
  return LinkReader(file, index).link();
}

}  // namespace traverse::gcode
