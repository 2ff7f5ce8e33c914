#include "client/gcode/model/path_body.h"

#include "client/gcode/model/arc.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/model/positions.h"

namespace traverse::gcode {
namespace {

BodySegment SegmentOf(const Step& step, const MachineState& after) {
  BodySegment segment;
  segment.from = step.from;
  segment.to = after.at;
  segment.filament = step.filament;
  segment.feed = after.feed;
  segment.comment = step.command.comment;
  if (!step.arc) return segment;
  const Command& c = step.command;
  segment.command = static_cast<uint8_t>(c.number);
  segment.by_radius = !c.Has('I') && !c.Has('J');
  if (segment.by_radius) {
    segment.radius = c.Value('R');
  } else {
    segment.center_i = c.Has('I') ? c.Value('I') : 0;
    segment.center_j = c.Has('J') ? c.Value('J') : 0;
  }
  return segment;
}

}  // namespace

PathBody ReadBody(const GcodeFile& file, const Block& block) {
  PathBody body;
  body.states.push_back(file.states[block.state_in]);
  body.segments.reserve(block.end_count);
  Interpreter interpreter(std::string_view(file.text).substr(0, block.end), block.begin,
                          StateAt(file, block));
  for (Step step; interpreter.Next(step);) {
    if (step.kind == StepKind::kSlot) {
      const uint32_t setter = file.setters.Find(step.line.Text(file.text));
      PrintState state = body.states.back();
      ApplySetter(state, setter, step.slots);
      body.states.push_back(state);
    } else if (step.kind == StepKind::kExtrude || step.kind == StepKind::kZeroExtrude) {
      body.segments.push_back(SegmentOf(step, interpreter.state()));
      body.segments.back().state = static_cast<uint32_t>(body.states.size() - 1);
    } else if (step.kind == StepKind::kTravel) {
      body.tail_length += LengthXy(step.from, interpreter.state().at);
    }
  }
  return body;
}

Command ArcCommand(const BodySegment& segment) {
  Command command;
  command.kind = LineKind::kCommand;
  command.letter = 'G';
  command.number = segment.command;
  const auto set = [&command](char letter, Decimal value) {
    command.words |= Command::Bit(letter);
    command.values[letter - 'A'] = value;
  };
  if (segment.by_radius) {
    set('R', segment.radius);
  } else {
    set('I', segment.center_i);
    set('J', segment.center_j);
  }
  return command;
}

std::vector<Point> BendsOf(const BodySegment& segment, double unit_mm) {
  constexpr double kToleranceMm = 0.01;
  if (segment.command < 2) return {};
  return ArcPoints(ArcCommand(segment), segment.from, segment.to, unit_mm, kToleranceMm);
}

BodySegment Reversed(const BodySegment& segment) {
  BodySegment reversed = segment;
  reversed.from = segment.to;
  reversed.to = segment.from;
  if (segment.command >= 2) {
    reversed.command = static_cast<uint8_t>(5 - segment.command);
    reversed.center_i = segment.from.x + segment.center_i - segment.to.x;
    reversed.center_j = segment.from.y + segment.center_j - segment.to.y;
  }
  return reversed;
}

}  // namespace traverse::gcode
