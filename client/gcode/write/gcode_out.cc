#include "client/gcode/write/gcode_out.h"

#include <algorithm>
#include <utility>

namespace traverse::gcode {
namespace {

// End scripts switch to relative moves and back.
void FollowModes(const Command& command, MachineState& modes) {
  if (command.kind != LineKind::kCommand) return;
  const int number = command.number;
  if (command.letter == 'G' && (number == 90 || number == 91)) modes.relative_xyz = number == 91;
  if (command.letter == 'M' && (number == 82 || number == 83)) modes.relative_e = number == 83;
}

}  // namespace

std::string LineEndOf(std::string_view text) {
  const size_t first = std::min(text.find('\n'), text.size());
  size_t returns = 0;
  while (returns < first && text[first - 1 - returns] == '\r') ++returns;
  return std::string(returns, '\r') + "\n";
}

GcodeOut::GcodeOut(const GcodeFile& file, const PartStart& start, std::string& text)
    : at(start), file_(file), text_(text), wanted_{}, pulled_(start.machine.Retracted()) {
  line_end_ = LineEndOf(file.text);
}

void GcodeOut::Copy(const FilePart& part) {
  Begin(part.behind.machine.Retracted());
  const Decimal e = at.machine.e;
  at = part.behind;
  const Decimal shift = part.before.machine.RelativeE() ? 0 : e - part.before.machine.e;
  const auto progress = std::lower_bound(file_.progress.begin(), file_.progress.end(), part.begin);
  const bool leaves_out =
      part.without_progress && progress != file_.progress.end() && *progress < part.end;
  if (shift != 0 || leaves_out) return CopyShifted(part, shift);
  text_.append(file_.text, part.begin, part.end - part.begin);
}

void GcodeOut::CopyShifted(const FilePart& part, Decimal shift) {
  const std::string_view text = std::string_view(file_.text).substr(0, part.end);
  MachineState modes = part.before.machine;
  Command command;
  for (Offset next = part.begin; next < part.end;) {
    const Line line = LineAt(text, next);
    next = line.next;
    const std::string_view raw = line.Raw(text);
    LexLine(line.Text(text), command);
    const bool leaves_out =
        part.without_progress &&
        std::binary_search(file_.progress.begin(), file_.progress.end(), line.begin);
    if (leaves_out) continue;
    FollowModes(command, modes);
    if (command.Is('G', 92) && command.Has('E')) shift = 0;
    if (command.Moves() && command.Has('E') && shift != 0 && !modes.RelativeE()) {
      const WordChange e{'E', command.Value('E') + shift, file_.e_style};
      AppendEdited(raw, {&e, 1}, text_);
    } else {
      text_.append(raw);
    }
  }
  at.machine.e += shift;
}

void GcodeOut::Print(const NewLink& link) {
  if (link.part()) Copy(*link.part());
  for (const LinkLine& line : link.lines()) {
    const LinkStep& step = line.step;
    switch (line.form) {
      case LineForm::kRaw:
        Raw(line.raw);
        break;
      case LineForm::kEdited:
        Edited(line);
        break;
      case LineForm::kTravel:
        Travel(line.raw, step.to, step.feed);
        break;
      case LineForm::kSetter:
        SetBy(line.raw, step.slots);
        break;
      case LineForm::kState:
        Set(link.state(line), step.slots);
        break;
      case LineForm::kStand:
        Stand(step);
        break;
      case LineForm::kSegment:
        Segment("G1", step.to, step.kind == StepKind::kWipe, step.filament, step.feed);
        break;
    }
  }
}

void GcodeOut::Set(const PrintState& state, SlotMask mask) {
  for (size_t slot = 0; slot < kSlotCount; ++slot) {
    if (((mask >> slot) & 1u) != 0) wanted_[slot] = state[slot];
  }
  wanted_slots_ |= mask;
}

void GcodeOut::SetBy(std::string_view line, SlotMask slots) {
  Begin(false);
  text_.append(line);
  ApplySetter(at.state, file_.setters.Find(line.substr(0, line.find_last_not_of("\r\n") + 1)),
              slots);
}

void GcodeOut::Flush() {
  if (wanted_slots_ == 0) return;
  const SlotMask slots = std::exchange(wanted_slots_, 0);
  for (const uint32_t setter : SettersBetween(at.state, wanted_, slots, file_.setters)) {
    text_.append(file_.setters.Line(setter));
    EndLine();
    pulled_ = false;
  }
}

void GcodeOut::Begin(bool pulls) {
  Flush();
  pulled_ = pulls;
}

void GcodeOut::Edited(const LinkLine& line) {
  const LinkStep& step = line.step;
  if (step.kind == StepKind::kSetE) {
    at.machine.e = step.filament;
    return Raw(line.raw);
  }
  // Right behind what it waits for, even if that is of the start script; else it is right before.
  if (step.kind == StepKind::kDwell) {
    if (!pulled_) Flush();
    text_.append(line.raw);
    return;
  }
  Begin(MovesFilament(step.kind));
  at.machine.e += step.filament;
  WordChange changes[5];
  size_t count = 0;
  // Where the file sets the feed rate on a line before this one, that line may be left out here.
  const bool moves =
      step.kind == StepKind::kFilament || step.kind == StepKind::kLift || IsXyMotion(step.kind);
  if (moves && (step.words & Command::Bit('F')) == 0 && step.feed != at.machine.feed) {
    changes[count++] = {'F', step.feed, NumberStyle{}};
  }
  if (moves || (step.words & Command::Bit('F')) != 0) at.machine.feed = step.feed;
  const auto change = [&](char letter, Decimal value, Decimal in_file, NumberStyle style) {
    const bool right = value == in_file && !(step.relative && letter == 'Z');
    if ((step.words & Command::Bit(letter)) == 0 || right) return;
    changes[count++] = {letter, value, style};
  };
  change('X', step.to.x, line.in_file.x, file_.xy_style);
  change('Y', step.to.y, line.in_file.y, file_.xy_style);
  change('Z', step.to.z, line.in_file.z, file_.xy_style);
  const bool states_e = (step.words & Command::Bit('E')) != 0;
  if (states_e && !at.machine.RelativeE() && at.machine.e != step.e) {
    changes[count++] = {'E', at.machine.e, file_.e_style};
  }
  if (count == 0) {
    Raw(line.raw);
  } else {
    AppendEdited(line.raw, {changes, count}, text_);
  }
  at.machine.at = step.to;
}

void GcodeOut::Travel(std::string_view line, const Position& to, Decimal feed) {
  Begin(false);
  Command command;
  LexLine(line.substr(0, line.find_last_not_of("\r\n") + 1), command);
  // Where the file travels along an arc.
  if (command.number > 1) return Travel("G1" + line_end_, to, feed);
  WordChange changes[5] = {{'X', to.x, file_.xy_style}, {'Y', to.y, file_.xy_style}};
  size_t count = 2;
  if (command.Has('Z') || to.z != at.machine.at.z) changes[count++] = {'Z', to.z, file_.xy_style};
  // An E word that pushes nothing: where the register is.
  if (command.Has('E') && !at.machine.RelativeE()) {
    changes[count++] = {'E', at.machine.e, file_.e_style};
  }
  // A correct feed rate stays as it is written.
  const bool right = command.Has('F') ? command.Value('F') == feed : feed == at.machine.feed;
  if (!right) changes[count++] = {'F', feed, NumberStyle{}};
  AppendEdited(line, {changes, count}, text_);
  at.machine.at = to;
  at.machine.feed = feed;
}

void GcodeOut::AppendWord(char letter, Decimal value, NumberStyle style) {
  text_.push_back(' ');
  text_.push_back(letter);
  AppendDecimal(value, style, text_);
}

void GcodeOut::AppendE(Decimal filament) {
  at.machine.e += filament;
  AppendWord('E', at.machine.RelativeE() ? filament : at.machine.e, file_.e_style);
}

void GcodeOut::Stand(const LinkStep& step) {
  Begin(step.kind == StepKind::kFilament);
  text_.append("G1");
  if (step.kind == StepKind::kLift) AppendWord('Z', step.to.z, file_.xy_style);
  if (step.kind == StepKind::kFilament) AppendE(step.filament);
  if (step.feed != at.machine.feed) AppendWord('F', step.feed, NumberStyle{});
  EndLine();
  at.machine.at.z = step.to.z;
  at.machine.feed = step.feed;
}

void GcodeOut::Segment(std::string_view command, const Position& to, bool extrudes,
                       Decimal filament, Decimal feed, std::string_view words,
                       std::string_view comment) {
  Begin(false);
  if (feed != at.machine.feed && file_.feed_on_own_line) {
    Stand({.kind = StepKind::kFeed, .to = at.machine.at, .feed = feed});
  }
  text_.append(command);
  if (feed != at.machine.feed) AppendWord('F', feed, NumberStyle{});
  AppendWord('X', to.x, file_.xy_style);
  AppendWord('Y', to.y, file_.xy_style);
  text_.append(words);
  if (extrudes) AppendE(filament);
  if (!comment.empty()) {
    text_.push_back(' ');
    text_.append(comment);
  }
  EndLine();
  at.machine.at.x = to.x;
  at.machine.at.y = to.y;
  at.machine.feed = feed;
}

}  // namespace traverse::gcode
