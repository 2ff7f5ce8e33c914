#include "client/gcode/verify/machine/verify_machine.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "client/gcode/verify/machine/extruder_mode.h"
#include "client/gcode/verify/machine/object_labels.h"
#include "client/gcode/verify/machine/told_progress.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// A line of which no more is needed than what it begins with.
struct Ahead {
  std::string_view line;
  char letter = 0;
  int number = -1;

  explicit Ahead(std::string_view of_line) : line(of_line) {
    if (line.empty()) return;
    letter = UpperCase(line[0]);
    std::from_chars(line.data() + 1, line.data() + line.size(), number);
  }

  bool HasReturn() const { return line.find('\r') != std::string_view::npos; }
};

// The next one that is not blank and no comment; empty if none follows.
Ahead NextCommand(std::string_view& rest) {
  while (!rest.empty()) {
    const std::string_view line = TrimLine(TakeLine(rest));
    if (!line.empty() && line[0] != ';') return Ahead(line);
  }
  return Ahead({});
}

// Commands that are looked at for how a lift or a wait goes on.
constexpr size_t kMostAhead = 16;

}  // namespace

void VerifyMachine::NoteMotion(int number, uint32_t words, const std::array<Micro, 3>& from,
                               Micro filament) {
  motion_ = Motion{from, at_, filament, pulled_, feed_, number, words, retracted()};
  moved_at_ = lines_.number();
}

VerifyMachine::VerifyMachine(std::string_view text)
    : lines_(text), relative_e_(CountsFromTheMoveBefore(text)) {}

bool VerifyMachine::Next(VerifyLine& line) {
  std::string_view text;
  if (!lines_.Next(text)) return false;
  line = VerifyLine{};
  line.number = lines_.number();
  line.text = TrimLine(text);
  if (!line.text.empty()) Do(line);
  return true;
}

void VerifyMachine::Fence(VerifyLine& line, LineRole role) {
  line.role = role;
  line.digest = DigestOf(line.text);
}

void VerifyMachine::Do(VerifyLine& line) {
  const std::string_view text = line.text;
  if (text[0] == ';') return DoComment(line);
  const char letter = UpperCase(text[0]);
  int number = 0;
  const auto read = std::from_chars(text.data() + 1, text.data() + text.size(), number);
  settings_.BeginLine();
  waits_ = std::exchange(pulls_, false);
  const bool numbered =
      read.ec == std::errc{} && text[1] != '-' &&
      (read.ptr == text.data() + text.size() || (*read.ptr != '.' && *read.ptr != '_'));
  if (letter == 'G' && numbered) {
    DoG(number, line);
    const bool moving = number <= 3 || number == 10 || number == 11 || number == 92 || line.moves;
    if (!moving && !InLift()) line.command = Mix('G', static_cast<uint64_t>(number));
  } else if (letter == 'M' && numbered) {
    DoM(number, line);
    if (!InLift() && !line.moves) line.command = Mix('M', static_cast<uint64_t>(number));
  } else {
    DoKlipper(line);
    line.command = DigestOf(text.substr(0, text.find_first_of(" \t=")));
  }
  if (line.role == LineRole::kFixed && (letter != 'M' || (number != 109 && number != 190))) {
    nozzle_ = bed_ = 0;
  }
  line.sets = line.command != 0 && line.role == LineRole::kNothing;
  line.sets_back = settings_.sets_back();
  line.sets_fan = settings_.sets_fan();
}

void VerifyMachine::DoComment(VerifyLine& line) {
  const std::string_view text = line.text;
  if (settings_.SetByComment(text)) return;
  if (BeginsWipe(text)) return;
  for (const std::string_view mark :
       {";LAYER_CHANGE", ";LAYER:", ";LAYER ", "; CHANGE_LAYER", ";MESH:", "; printing object",
        "; stop printing object", "; start printing object",
        "; OBJECT_ID:", ";layer:", "; BEGIN_LAYER_OBJECT", "; END_LAYER_OBJECT", "; <layer>",
        "; </layer>", ";; --- layer ", ";PRINTING:", ";PRINTING_ID:"}) {
    if (!text.starts_with(mark)) continue;
    line.label = text.find("printing object") != std::string_view::npos;
    return Fence(line, LineRole::kFence);
  }
  constexpr std::string_view kNumbered = "; layer ";
  const bool numbered = text.size() > kNumbered.size() && text[kNumbered.size()] >= '0' &&
                        text[kNumbered.size()] <= '9';
  if (numbered && text.starts_with(kNumbered)) return Fence(line, LineRole::kFence);
  Fence(line, CommentTellsProgress(text) ? LineRole::kProgress : LineRole::kComment);
}

void VerifyMachine::Mode(bool& mode, bool value, VerifyLine& line) {
  // What holds before the print begins is not known.
  const LineRole again = prints_ ? LineRole::kComment : LineRole::kFence;
  if (!InLift()) Fence(line, mode == value ? again : LineRole::kFixed);
  mode = value;
}

// Where the head is, and what the register says, is the same in other units.
void VerifyMachine::SwitchUnits(bool inches, VerifyLine& line) {
  if (inches != inches_) {
    const double scale = inches ? 1 / kInchMm : kInchMm;
    for (Micro* value : {&at_[0], &at_[1], &at_[2], &e_, &feed_, &pulled_, &deepest_}) {
      *value = std::llround(static_cast<double>(*value) * scale);
    }
  }
  Mode(inches_, inches, line);
}

void VerifyMachine::DoG(int number, VerifyLine& line) {
  const CommandWords words(WordsOf(line.text));
  switch (number) {
    case 0:
    case 1:
    case 2:
    case 3:
      // On a straight move R takes a stored point to some machines, and P means other things.
      if (!words.OnlyFrom(number < 2 ? "XYZEF" : "XYZEFIJRP") || (number >= 2 && !plane_xy_)) {
        return Fence(line, LineRole::kFixed);
      }
      if (number >= 2 && !words.Has('I') && !words.Has('J') && !words.Has('R')) {
        // No arc, and where the head is behind it each machine says otherwise.
        feed_ = words.ValueOr('F', feed_);
        return Fence(line, LineRole::kFixed);
      }
      return Move(number, words, line);
    case 10:
    case 11:
      if (words.set != 0 || !words.readable) return Fence(line, LineRole::kFixed);
      NoteMotion(number, 0, at_, 0);
      settings_.Move();
      line.moves = pulls_ = true;
      firmware_retracted_ = number == 10;
      return;
    case 4:
      if (!words.OnlyFrom("PS")) return Fence(line, LineRole::kFixed);
      return Wait(words.ValueOr('P', 0) + 1000 * words.ValueOr('S', 0), line);
    case 17:
      // Slicers write it before each spiral lift.
      if (plane_xy_) return;
      [[fallthrough]];
    case 18:
    case 19:
      return Mode(plane_xy_, number == 17, line);
    case 20:
    case 21:
      return SwitchUnits(number == 20, line);
    case 90:
    case 91:
      if (number == 91 && !relative_) {
        if (const size_t lines = LinesOfLift(); lines > 0) last_of_lift_ = lines_.number() + lines;
      }
      return Mode(relative_, number == 91, line);
    case 92:
      return SetPosition(words, line);
    default:
      return Fence(line, LineRole::kFixed);
  }
}

// Beside a move that pulls filament back, or pushes it alone, it goes with that; but not where a
// script waits for something, far from the paths on both sides.
void VerifyMachine::Wait(Micro milliseconds, VerifyLine& line) {
  const bool of_pull = waits_ || PullsBehind();
  if (!of_pull || (IsFar(left_[0], left_[1]) && !DepositsBehind()))
    return Fence(line, LineRole::kFixed);
  NoteMotion(4, 0, at_, 0);
  motion_.feed = milliseconds;
  line.moves = true;
  pulls_ = waits_;
}

bool VerifyMachine::IsFar(Micro x, Micro y) const {
  constexpr double kMostMicro = 10'000'000;  // slicers lead inwards, coast and wipe less far
  const double scale = inches_ ? kInchMm : 1;
  return scale * std::hypot(static_cast<double>(at_[0] - x), static_cast<double>(at_[1] - y)) >
         kMostMicro;
}

bool VerifyMachine::DepositsBehind() const {
  std::string_view rest = lines_.rest();
  Micro x = at_[0];
  Micro y = at_[1];
  Nano e = e_;
  for (size_t i = 0; i < kMostAhead; ++i) {
    const Ahead next = NextCommand(rest);
    if (next.line.empty()) return false;
    const bool moves = next.number >= 0 && next.number <= 3;
    if (next.letter != 'G' || (!moves && next.number != 92)) continue;
    const CommandWords words(WordsOf(next.line));
    if (!words.readable) return false;
    const bool sideways = moves && (words.Has('X') || words.Has('Y'));
    if (sideways) {
      if (words.Has('E') && words.filament > (relative_ || relative_e_ ? 0 : e)) return true;
      if (words.Has('X')) x = relative_ ? x + words['X'] : words['X'];
      if (words.Has('Y')) y = relative_ ? y + words['Y'] : words['Y'];
      if (IsFar(x, y)) return false;
    }
    if (words.Has('E')) e = words.filament;
  }
  return false;
}

bool VerifyMachine::PullsBehind() const {
  std::string_view rest = lines_.rest();
  for (size_t i = 0; i < kMostAhead; ++i) {
    const Ahead next = NextCommand(rest);
    if (next.line.empty() || next.HasReturn()) return false;
    const auto [line, letter, number] = next;
    const CommandWords words(WordsOf(line));
    const bool waits = (letter == 'G' && number == 4) || (letter == 'M' && number == 400);
    if (waits) continue;
    if (letter != 'G' || !words.readable) return false;
    if (number == 10 || number == 11) return words.set == 0;
    const bool feed = words.set == 1u << ('F' - 'A');
    if (feed && (number == 0 || number == 1)) continue;
    if (number > 1 || number < 0 || !words.Has('E')) return false;
    const Nano pushed = words.filament - (relative_ || relative_e_ ? 0 : e_);
    return pushed < 0 || words.OnlyFrom("EF");
  }
  return false;
}

void VerifyMachine::SetPosition(const CommandWords& words, VerifyLine& line) {
  if (words.readable && words.Has('E')) e_ = words.filament;
  if (words.readable && words.set == 1u << ('E' - 'A')) return;
  for (size_t axis = 0; axis < 3 && words.readable; ++axis) {
    const char letter = static_cast<char>('X' + axis);
    if (words.Has(letter)) at_[axis] = words[letter];
  }
  Fence(line, LineRole::kFixed);
}

size_t VerifyMachine::LinesOfLift() const {
  std::string_view rest = lines_.rest();
  bool lifts = false;
  bool ended = false;
  for (size_t lines = 0; lines < kMostAhead; ++lines) {
    const Ahead next(TrimLine(TakeLine(rest)));
    if (next.HasReturn()) return 0;
    const auto [line, letter, number] = next;
    if (ended) return letter == 'M' && number == (relative_e_ ? 83 : 82) ? lines + 1 : lines;
    if (line.empty()) continue;
    if (letter != 'G') return 0;
    const CommandWords words(WordsOf(line));
    ended = number == 90 && lifts;
    const bool lift = (number == 0 || number == 1) && words.Has('Z') && words.OnlyFrom("ZF");
    if (!lift && !ended) return 0;
    lifts = lifts || lift;
  }
  return 0;
}

// Behind M622: all lines up to M623 are pictures, notes or comments.
bool VerifyMachine::ConditionOnlyTells() const {
  std::string_view rest = lines_.rest();
  for (size_t i = 0; i < kMostAhead; ++i) {
    const Ahead next = NextCommand(rest);
    if (next.HasReturn()) return false;
    const std::string_view name = next.line.substr(0, next.line.find_first_of(" \t;"));
    if (name == "M623") return true;
    const bool tells =
        name == "M971" || name == "M9711" || name == "M991" || name == "M1002" || name == "M1004";
    if (!tells) return false;
  }
  return false;
}

void VerifyMachine::Move(int number, const CommandWords& words, VerifyLine& line) {
  if (words.Has('F')) feed_ = words['F'];
  const std::array<Micro, 3> from = at_;
  for (size_t axis = 0; axis < 3; ++axis) {
    const char letter = static_cast<char>('X' + axis);
    if (words.Has(letter)) at_[axis] = relative_ ? at_[axis] + words[letter] : words[letter];
  }
  Micro filament = 0;
  if (words.Has('E')) {
    const Nano exact = relative_ || relative_e_ ? words.filament : words.filament - e_;
    e_ += exact;
    filament = InMicros(exact);
  }
  const bool moves = at_[0] != from[0] || at_[1] != from[1];
  line.moves = moves || at_[2] != from[2] || filament != 0 || number >= 2;
  if (line.moves) settings_.Move();
  line.stays = !line.moves && (words.Has('X') || words.Has('Y') || words.Has('Z'));
  if (line.moves || line.stays) {
    NoteMotion(number, words.set, from, filament);
    motion_.has_center = number >= 2 && (words.Has('I') || words.Has('J'));
    motion_.center_x = from[0] + words.ValueOr('I', 0);
    motion_.center_y = from[1] + words.ValueOr('J', 0);
    motion_.radius = number >= 2 && !motion_.has_center ? words.ValueOr('R', 0) : 0;
    motion_.turns = number >= 2 ? words.ValueOr('P', 0) : 0;
  }
  if ((moves || number >= 2) && filament > 0) {
    Deposit(number, words, from, filament, line);
    left_ = at_;
  } else {
    line.travels = moves;
    pulls_ = filament != 0 && !moves && at_[2] == from[2];
    if (filament > 0) {
      line.primes = true;
      line.surplus = filament - pulled_;
    }
    // Moves relative to each other are kept as they are, and circles that deposit nothing, and
    // arcs by a radius, whose center is nowhere known.
    const bool circle = number >= 2 && !moves && at_[2] == from[2];
    const bool by_radius = number >= 2 && words.Has('R');
    if ((relative_ && !InLift()) || circle || by_radius) Fence(line, LineRole::kFixed);
  }
  FollowFilament(filament, moves);
  if (pulled_ > 0) line.surplus = 0;  // not all of it yet
}

// A push may be short of what was pulled back: wherever slicers coast before a retraction, or are
// told to restart so. What is pushed in parts is not short before the last one.
void VerifyMachine::FollowFilament(Micro filament, bool moves) {
  if (filament < 0) deepest_ = std::max(deepest_, pulled_ - filament);
  pulled_ = std::max<Micro>(pulled_ - filament, 0);
  const bool most = pulled_ > 0 && 2 * pulled_ < deepest_;
  if (most && !moves && filament > 0 && DepositsBehind() && !PullsBehind()) pulled_ = 0;
  if (pulled_ == 0) deepest_ = 0;
}

// Gone the other way, an arc that ends beside its circle would lie elsewhere.
bool VerifyMachine::IsCircular(const CommandWords& words, const std::array<Micro, 3>& from) const {
  constexpr double kSlackMicro = 20'000;
  if (!words.Has('I') && !words.Has('J')) return true;
  const auto i = static_cast<double>(words.ValueOr('I', 0));
  const auto j = static_cast<double>(words.ValueOr('J', 0));
  const double end_radius = std::hypot(static_cast<double>(at_[0] - from[0]) - i,
                                       static_cast<double>(at_[1] - from[1]) - j);
  return std::abs(std::hypot(i, j) - end_radius) * (inches_ ? kInchMm : 1) <= kSlackMicro;
}

void VerifyMachine::Deposit(int number, const CommandWords& words, const std::array<Micro, 3>& from,
                            Micro filament, VerifyLine& line) {
  std::array<Micro, 3> begin = from;
  std::array<Micro, 3> end = at_;
  // An arc by its center, or its radius, and the way round when gone from its smaller end.
  if (begin > end && (number < 2 || IsCircular(words, from))) {
    std::swap(begin, end);
    if (number >= 2) number = 5 - number;
  }
  // Each value is mixed with its place, and the sum taken: no value waits for the one before it.
  uint64_t sum = 0;
  uint64_t place = 0;
  const auto add = [&sum, &place](uint64_t value) { sum += Mix(++place, value); };
  add(static_cast<uint64_t>(number));
  add(static_cast<uint64_t>(begin[2]));
  add(static_cast<uint64_t>(end[2]));
  add(static_cast<uint64_t>(feed_));
  add(tool_);
  add((retracted() ? 1u : 0u) + (inches_ ? 2u : 0u));
  add(settings_.Digest());
  const size_t note = line.text.find(';');
  add(note == std::string_view::npos ? 0 : DigestOf(TrimLine(line.text.substr(note + 1))));
  line.conditions = sum;
  for (size_t axis = 0; axis < 2; ++axis) {
    add(static_cast<uint64_t>(begin[axis]));
    add(static_cast<uint64_t>(end[axis]));
  }
  add(static_cast<uint64_t>(filament));
  if (number >= 2 && (words.Has('I') || words.Has('J'))) {
    add(static_cast<uint64_t>(from[0] + words.ValueOr('I', 0)));
    add(static_cast<uint64_t>(from[1] + words.ValueOr('J', 0)));
  } else if (number >= 2) {
    add(static_cast<uint64_t>(words.ValueOr('R', 0)));
  }
  if (number >= 2) add(static_cast<uint64_t>(words.ValueOr('P', 0)));
  prints_ = true;
  line.role = LineRole::kDeposit;
  line.digest = Mix(0, sum);
  line.z = at_[2];
}

void VerifyMachine::DoM(int number, VerifyLine& line) {
  const bool message = number == 117 || number == 118;
  if (number == 73 || number == 532 || (message && MessageTellsProgress(line.text))) {
    return Fence(line, LineRole::kProgress);
  }
  if (number == 117 || number == 300 || number == 105) return Fence(line, LineRole::kComment);
  if (number == 104 || number == 109 || number == 140 || number == 190) return Heat(number, line);
  if (number == 82 || number == 83) return Mode(relative_e_, number == 83, line);
  if (number == 400 && CommandWords(WordsOf(line.text)).set == 0) return Wait(0, line);
  if (number == 622) in_condition_ = ConditionOnlyTells();
  const bool conditional = number == 622 || number == 623;
  if (conditional && in_condition_) return Fence(line, LineRole::kFence);
  for (const int known : {74, 118, 142, 155, 486, 591, 624, 625, 971, 991, 1002, 1004, 9711}) {
    if (number != known) continue;
    line.label = number == 486 || number == 624 || number == 625;
    return Fence(line, LineRole::kFence);
  }
  if (!settings_.SetByM(number, CommandWords(WordsOf(line.text)))) Fence(line, LineRole::kFixed);
}

// What waits for a temperature is fixed. One that was told before changes nothing.
void VerifyMachine::Heat(int number, VerifyLine& line) {
  const CommandWords words(WordsOf(line.text));
  uint64_t told = 0;
  if (words.OnlyFrom("ST") && words.Has('S')) {
    const uint64_t heater = words.Has('T') ? static_cast<uint64_t>(words['T']) + 1 : Mix(1, tool_);
    told = Mix(heater, static_cast<uint64_t>(words['S'])) | 1;
  }
  uint64_t& known = number < 140 ? nozzle_ : bed_;
  const bool waits = number == 109 || number == 190;
  const bool again = told != 0 && std::exchange(known, told) == told;
  if (told == 0) known = 0;
  Fence(line, waits ? LineRole::kFixed : again ? LineRole::kComment : LineRole::kFence);
}

void VerifyMachine::DoKlipper(VerifyLine& line) {
  const std::string_view text = line.text;
  if (settings_.SetByKlipper(text)) return;
  const bool shows = BeginsInAnyCase(text, "SET_DISPLAY_TEXT ");
  if (shows && MessageTellsProgress(text)) {
    return Fence(line, LineRole::kProgress);
  }
  if (shows) return Fence(line, LineRole::kComment);
  if (BeginsInAnyCase(text, "EXCLUDE_OBJECT_START") ||
      BeginsInAnyCase(text, "EXCLUDE_OBJECT_END")) {
    line.label = true;
    return Fence(line, LineRole::kFence);
  }
  if (ObjectLabels::IsOfHost(text)) return Fence(line, LineRole::kFence);
  const std::string_view name = text.substr(0, text.find_first_of(" \t;"));
  line.photo = EqualsInAnyCase(name, "TIMELAPSE_TAKE_FRAME");
  if (line.photo) return Fence(line, LineRole::kFence);
  for (const std::string_view macro : {"TIMELAPSE_RENDER", "SET_PRINT_STATS_INFO", "M622.1"}) {
    if (EqualsInAnyCase(name, macro)) return Fence(line, LineRole::kFence);
  }
  // What the next tool, or filament, has in its nozzle is not known.
  if (UpperCase(text[0]) == 'T' && std::exchange(tool_, DigestOf(text)) != tool_) {
    pulled_ = deepest_ = 0;
  }
  Fence(line, LineRole::kFixed);
}

}  // namespace traverse::gcode
