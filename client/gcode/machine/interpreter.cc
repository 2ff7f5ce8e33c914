#include "client/gcode/machine/interpreter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/gcode/dialects/dialect.h"
#include "client/gcode/dialects/label.h"
#include "client/gcode/machine/progress_line.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

// So many commands are looked at for how a lift or a wait goes on.
constexpr int kMostAhead = 16;

// kUnknown if it is none.
StepKind KindOfMark(std::string_view line) {
  const Mark* mark = MarkOf(line);
  switch (mark == nullptr ? MarkKind::kNoType : mark->kind) {
    case MarkKind::kWipeBegins:
    case MarkKind::kWipeEnds:
      return StepKind::kWipeMark;
    case MarkKind::kLayer:
      return StepKind::kLayerMark;
    case MarkKind::kStays:
      return StepKind::kStay;
    case MarkKind::kSays:
      return StepKind::kSays;
    default:
      return LabelOf(line).kind != LabelKind::kNone ? StepKind::kLabel : StepKind::kUnknown;
  }
}

StepKind KindOfComment(std::string_view comment, SlotMask& slots) {
  slots = CommentSlots(comment);
  if (slots != 0) return StepKind::kSlot;
  const StepKind kind = KindOfMark(comment);
  if (kind != StepKind::kUnknown) return kind;
  return IsProgressComment(comment) ? StepKind::kProgress : StepKind::kComment;
}

StepKind KindOfText(std::string_view line, SlotMask& slots) {
  slots = TextSlots(line);
  if (slots != 0) return StepKind::kSlot;
  return IsProgressMacro(line) ? StepKind::kProgress : KindOfMark(line);
}

// Bambu's: a picture (971, 9711), a shutter (1004), notes for the display and the host (991, 1002).
bool OnlyTells(int number) {
  return number == 971 || number == 9711 || number == 991 || number == 1002 || number == 1004;
}

bool WaitsForHeat(const Command& command) { return command.Is('M', 109) || command.Is('M', 190); }

// 30 m, or half a mile of inches: no printer, and beyond what the service takes.
bool Beyond(Decimal coordinate) {
  constexpr Decimal kMax = 30'000 * kDecimalOne;
  return coordinate > kMax || coordinate < -kMax;
}

// A kilometre at once; sums stay far below overflow.
bool BeyondFilament(Decimal filament) {
  constexpr Decimal kMax = 1'000'000 * kDecimalOne;
  return filament > kMax || filament < -kMax;
}

// Longer moves with an E word that pushes nothing are travel (KISSlicer, Bambu Studio); shorter
// ones are printed, and their filament was rounded away.
constexpr double kMaxRoundedMm = 0.05;

bool IsRounded(const Position& from, const Position& to, double unit_mm) {
  return std::hypot(ToDouble(to.x - from.x), ToDouble(to.y - from.y)) * unit_mm <= kMaxRoundedMm;
}

}  // namespace

bool Interpreter::Next(Step& step) {
  if (next_ >= text_.size()) return false;
  step.line = LineAt(text_, next_);
  next_ = step.line.next;
  step.from = state_.at;
  step.retracted = state_.Retracted();
  step.pulled = state_.retracted;
  step.filament = 0;
  step.slots = 0;
  step.arc = false;
  step.relative = false;
  step.fault = nullptr;
  const std::string_view line = step.line.Text(text_);
  LexLine(line, step.command);
  switch (step.command.kind) {
    case LineKind::kBlank:
      step.kind = StepKind::kBlank;
      break;
    case LineKind::kComment:
      step.kind = KindOfComment(step.command.comment, step.slots);
      if (step.kind == StepKind::kWipeMark) {
        state_.in_wipe = MarkOf(step.command.comment)->kind == MarkKind::kWipeBegins;
      }
      if (step.kind == StepKind::kLayerMark) state_.in_wipe = false;
      break;
    case LineKind::kText:
      behind_pull_ = false;
      step.kind = KindOfText(TrimBlanks(line), step.slots);
      break;
    case LineKind::kCommand:
      FollowCommand(step);
      if (step.kind == StepKind::kDwell) break;
      behind_pull_ = MovesFilament(step.kind);
      break;
  }
  if (step.kind == StepKind::kExtrude) {
    lines_ = 0;
  } else if (++lines_ == kMostOfLink) {
    step.kind = StepKind::kUnknown;
    lines_ = 0;
  }
  const bool may_heat = step.kind == StepKind::kUnknown || step.kind == StepKind::kModeChange;
  if (may_heat && !WaitsForHeat(step.command)) targets_ = {};
  return true;
}

void Interpreter::FollowCommand(Step& step) {
  if (step.command.letter == 'G') {
    FollowG(step);
  } else if (step.command.letter == 'M') {
    FollowM(step);
  } else {
    // What the next tool, or filament, has in its nozzle is not known.
    if (state_.tool != step.command.number) state_.retracted = state_.deepest = 0;
    state_.tool = step.command.number;
    step.kind = StepKind::kModeChange;
  }
}

void Interpreter::FollowG(Step& step) {
  switch (step.command.number) {
    case 0:
    case 1:
      return Move(step);
    case 2:
    case 3:
      return Arc(step);
    case 4:
      step.kind = KindOfWait();
      return;
    case 10:
    case 11: {
      // With words G10 is something else: temperatures in RepRapFirmware, offsets elsewhere.
      const bool bare = TrimBlanks(step.command.rest).empty();
      const bool retract = step.command.number == 10;
      if (bare) state_.firmware_retracted = retract;
      step.kind = !bare     ? StepKind::kUnknown
                  : retract ? StepKind::kFirmwareRetract
                            : StepKind::kFirmwareUnretract;
      return;
    }
    case 17:
    case 18:
    case 19:
      // Slicers write G17 before each spiral lift; if it changes nothing, it is part of the lift.
      step.kind = SwitchMode(state_.plane_xy, step.command.number == 17);
      if (step.kind == StepKind::kSays) step.kind = StepKind::kPlane;
      return;
    case 20:
    case 21:
      step.kind = SwitchMode(state_.inches, step.command.number == 20);
      if (step.kind == StepKind::kModeChange) SwitchUnits();
      return;
    case 90:
    case 91:
      if (step.command.number == 91 && !state_.relative_xyz) {
        lifts_until_ = std::max(lifts_until_, LiftsUntil(next_));
      }
      step.kind = SwitchMode(state_.relative_xyz, step.command.number == 91);
      if (next_ <= lifts_until_) step.kind = StepKind::kRelative;
      return;
    case 92:
      return SetPosition(step);
    default:
      step.kind = StepKind::kUnknown;
  }
}

StepKind Interpreter::SwitchMode(bool& mode, bool value) {
  return std::exchange(mode, value) != value ? StepKind::kModeChange : StepKind::kSays;
}

// One that is told the same again goes on as it did.
void Interpreter::FollowHeat(Step& step) {
  Command& c = step.command;
  constexpr uint32_t kOfHeat = Command::Bit('S') | Command::Bit('T');
  std::optional<Target>& known = targets_[c.Is('M', 140) || c.Is('M', 190) ? 1 : 0];
  std::optional<Target> target;
  if (ReadWords(c) && c.Has('S') && (c.words & ~kOfHeat) == 0) {
    const auto tool = static_cast<int>(c.Has('T') ? c.Value('T') / kDecimalOne : state_.tool);
    target = Target{tool, c.Value('S')};
  }
  step.kind = WaitsForHeat(c)             ? StepKind::kUnknown
              : target && target == known ? StepKind::kSays
                                          : StepKind::kStay;
  known = target;
}

// The head stays where it is, and so does the register: from here on words use another unit.
void Interpreter::SwitchUnits() {
  const long double scale = state_.inches ? 1 / 25.4L : 25.4L;
  for (Decimal* value : {&state_.at.x, &state_.at.y, &state_.at.z, &state_.e, &state_.feed,
                         &state_.retracted, &state_.deepest}) {
    const long double scaled = static_cast<long double>(*value) * scale;
    *value = std::clamp<Decimal>(std::llroundl(scaled), -kDecimalMax, kDecimalMax);
  }
}

void Interpreter::FollowM(Step& step) {
  switch (step.command.number) {
    case 73:
    case 532:
      step.kind = StepKind::kProgress;
      return;
    case 82:
    case 83:
      step.kind = SwitchMode(state_.relative_e, step.command.number == 83);
      if (next_ <= lifts_until_) step.kind = StepKind::kRelative;
      return;
    case 104:
    case 109:
    case 140:
    case 190:
      return FollowHeat(step);
    case 74:   // mass printed so far
    case 142:  // temperature of the heat break
    case 155:
    case 591:  // watch over the filament
      step.kind = StepKind::kStay;
      return;
    case 105:  // asks for temperatures
    case 300:  // beeps
      step.kind = StepKind::kSays;
      return;
    case 117:
    case 118:  // to the host, which may act on it
      step.kind = IsProgressMessage(step.command.rest) ? StepKind::kProgress
                  : step.command.number == 117         ? StepKind::kSays
                                                       : StepKind::kStay;
      return;
    case 400:  // waits for the moves before it, and does nothing else
      step.kind = TrimBlanks(step.command.rest).empty() ? KindOfWait() : StepKind::kUnknown;
      return;
    case 622:
    case 623:
      // What may be left out does not matter if it does nothing to the print.
      if (step.command.number == 622) {
        condition_until_ = std::max(condition_until_, ConditionUntil(next_));
      }
      step.kind = next_ <= condition_until_ ? StepKind::kStay : StepKind::kUnknown;
      return;
    case 486:
    case 624:
    case 625:
      step.kind = StepKind::kLabel;
      return;
    default:
      step.slots = CommandSlots(step.command);
      step.kind = step.slots != 0                  ? StepKind::kSlot
                  : OnlyTells(step.command.number) ? StepKind::kStay
                                                   : StepKind::kUnknown;
  }
}

void Interpreter::FollowFilament(Decimal filament, bool still) {
  if (filament < 0) state_.deepest = std::max(state_.deepest, state_.retracted - filament);
  state_.retracted -= filament;
  // With a negative restart distance, or where they coast before, slicers push less than they
  // retracted. But they also push in parts.
  if (state_.retracted > 0 && still && filament > 0 && 2 * state_.retracted < state_.deepest &&
      PrintsNext() && !PullsNext()) {
    state_.retracted = 0;
  }
  if (state_.retracted <= 0) state_.deepest = 0;
  // A prime may push more than was retracted (restart extra); printing always pushes. Only an
  // unreasonable rest of a retraction stays "retracted".
  state_.retracted = std::clamp(state_.retracted, Decimal{0}, kDecimalMax);
}

void Interpreter::Move(Step& step) {
  const Command& c = step.command;
  // On a straight move R takes a stored point to some machines, and P means other things.
  constexpr uint32_t kOfLines = Command::Bit('X') | Command::Bit('Y') | Command::Bit('Z') |
                                Command::Bit('E') | Command::Bit('F');
  constexpr uint32_t kOfArcs =
      kOfLines | Command::Bit('I') | Command::Bit('J') | Command::Bit('R') | Command::Bit('P');
  if ((c.words & ~(c.number < 2 ? kOfLines : kOfArcs)) != 0) {
    step.kind = StepKind::kUnknown;
    return;
  }
  if (c.Has('F')) state_.feed = c.Value('F');
  Position to = state_.at;
  const auto follow = [&c, this](char letter, Decimal& axis) {
    if (c.Has(letter)) axis = state_.relative_xyz ? axis + c.Value(letter) : c.Value(letter);
  };
  follow('X', to.x);
  follow('Y', to.y);
  follow('Z', to.z);
  if (Beyond(to.x) || Beyond(to.y) || Beyond(to.z)) {
    step.kind = StepKind::kUnknown;
    return;
  }
  if (c.Has('E')) {
    const Decimal filament = state_.RelativeE() ? c.Value('E') : c.Value('E') - state_.e;
    if (BeyondFilament(filament) || BeyondFilament((state_.e + filament) / 1000)) {
      step.kind = StepKind::kUnknown;
      return;
    }
    step.filament = filament;
    state_.e += filament;
  }
  const bool xy = !to.SameXy(step.from);
  const bool z = to.z != step.from.z;
  if (xy || step.arc) {
    step.kind = !c.Has('E')                                              ? StepKind::kTravel
                : step.filament > 0                                      ? StepKind::kExtrude
                : step.filament < 0                                      ? StepKind::kWipe
                : !step.arc && IsRounded(step.from, to, state_.UnitMm()) ? StepKind::kZeroExtrude
                                                                         : StepKind::kTravel;
  } else if (z) {
    step.kind = step.filament == 0 ? StepKind::kLift : StepKind::kUnknown;
  } else {
    step.kind = step.filament != 0 ? StepKind::kFilament : StepKind::kFeed;
  }
  if (state_.in_wipe && xy && step.filament == 0) step.kind = StepKind::kWipe;
  if (step.kind == StepKind::kExtrude) {
    state_.in_wipe = false;
    deposited_ = to;
  }
  FollowFilament(step.filament, !xy);
  state_.at = to;
  step.relative = state_.relative_xyz;
  // But for lifts only slicers' own macros do this.
  if (step.relative && next_ > lifts_until_) step.kind = StepKind::kUnknown;
}

bool Interpreter::LexAhead(Offset& next, Command& command) const {
  if (next >= text_.size()) return false;
  const Line line = LineAt(text_, next);
  LexLine(line.Text(text_), command);
  next = line.next;
  return true;
}

bool Interpreter::LexCommandAhead(Offset& next, Command& command) const {
  while (LexAhead(next, command)) {
    if (command.kind != LineKind::kBlank && command.kind != LineKind::kComment) return true;
  }
  return false;
}

Offset Interpreter::LiftsUntil(Offset next) const {
  constexpr uint32_t kOfLifts = Command::Bit('Z') | Command::Bit('F');
  Command command;
  bool lifts = false;
  for (int i = 0; i < kMostAhead && LexAhead(next, command); ++i) {
    if (command.Is('G', 90)) {
      if (!lifts) return 0;
      // Some firmware lets G91 and G90 count for the extruder too: its mode is stated again.
      Offset behind = next;
      const bool stated = LexAhead(behind, command);
      return stated && command.Is('M', state_.relative_e ? 83 : 82) ? behind : next;
    }
    const bool lift = (command.Is('G', 0) || command.Is('G', 1)) && command.Has('Z') &&
                      (command.words & ~kOfLifts) == 0;
    if (!lift && command.kind != LineKind::kBlank) return 0;
    lifts = lifts || lift;
  }
  return 0;
}

// Elsewhere the head was led aside by a script, which waits there.
StepKind Interpreter::KindOfWait() const {
  const double aside_mm = Distance(state_.InMm(state_.at), state_.InMm(deposited_));
  const bool of_path = aside_mm <= kAsideMm || PrintsNext();
  return of_path && (behind_pull_ || PullsNext()) ? StepKind::kDwell : StepKind::kUnknown;
}

bool Interpreter::PrintsNext() const {
  constexpr uint32_t kOfXy = Command::Bit('X') | Command::Bit('Y');
  Command command;
  Offset next = next_;
  Position at = state_.at;
  Decimal e = state_.e;
  const auto follow = [&](char letter, Decimal& axis) {
    const Decimal from = state_.relative_xyz ? axis : 0;
    if (command.Has(letter)) axis = from + command.Value(letter);
  };
  for (int i = 0; i < kMostAhead; ++i) {
    // The text of a link ends where its path begins.
    if (!LexCommandAhead(next, command)) return true;
    if (!command.Moves() && !command.Is('G', 92)) continue;
    const bool filament = command.Has('E');
    if (command.Moves() && (command.words & kOfXy) != 0) {
      if (filament && command.Value('E') > (state_.RelativeE() ? 0 : e)) return true;
      follow('X', at.x);
      follow('Y', at.y);
      if (Beyond(at.x) || Beyond(at.y)) return false;
      if (Distance(state_.InMm(at), state_.InMm(state_.at)) > kAsideMm) return false;
    }
    if (filament) e = command.Value('E');
  }
  return false;
}

bool Interpreter::PullsNext() const {
  Command command;
  Offset next = next_;
  for (int i = 0; i < kMostAhead && LexCommandAhead(next, command); ++i) {
    if (command.kind == LineKind::kText) return false;
    if (command.Is('G', 4) || command.Is('M', 400)) continue;
    const bool bare = TrimBlanks(command.rest).empty();
    const bool moves = command.Is('G', 0) || command.Is('G', 1);
    // Slicers state the feed rate of a wipe on a line of its own.
    if (moves && command.words == Command::Bit('F')) continue;
    if (!moves || !command.Has('E')) {
      return bare && (command.Is('G', 10) || command.Is('G', 11));
    }
    constexpr uint32_t kOfPulls = Command::Bit('E') | Command::Bit('F');
    const Decimal before = state_.RelativeE() ? 0 : state_.e;
    return (command.words & ~kOfPulls) == 0 || command.Value('E') < before;
  }
  return false;
}

Offset Interpreter::ConditionUntil(Offset next) const {
  Command command;
  for (int i = 0; i < kMostAhead && LexCommandAhead(next, command); ++i) {
    if (command.Is('M', 623)) return next;
    const bool tells =
        command.kind == LineKind::kCommand && command.letter == 'M' && OnlyTells(command.number);
    if (!tells) return 0;
  }
  return 0;
}

void Interpreter::Arc(Step& step) {
  const Command& c = step.command;
  if (!state_.plane_xy) {
    Move(step);
    step.kind = StepKind::kUnknown;
    return;
  }
  if (!c.Has('I') && !c.Has('J') && !c.Has('R')) {
    // Marlin takes the feed rate and reports that this is not an arc; Klipper ends the print.
    if (c.Has('F')) state_.feed = c.Value('F');
    step.fault = step.command.number == 2 ? "G2 without I, J or R" : "G3 without I, J or R";
    step.kind = StepKind::kUnknown;
    return;
  }
  step.arc = true;
  Move(step);
  if (step.kind == StepKind::kUnknown) return;
  const bool full_circle = state_.at.SameXy(step.from);
  if (full_circle && step.filament == 0) {
    step.kind = state_.at.z != step.from.z ? StepKind::kLift : StepKind::kUnknown;
  }
}

void Interpreter::SetPosition(Step& step) {
  const Command& c = step.command;
  if (c.Has('X')) state_.at.x = c.Value('X');
  if (c.Has('Y')) state_.at.y = c.Value('Y');
  if (c.Has('Z')) state_.at.z = c.Value('Z');
  if (c.Has('E')) state_.e = c.Value('E');
  step.kind = c.words == Command::Bit('E') ? StepKind::kSetE : StepKind::kModeChange;
}

}  // namespace traverse::gcode
