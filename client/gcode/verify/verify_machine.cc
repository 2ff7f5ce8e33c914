#include "client/gcode/verify/verify_machine.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "client/gcode/verify/trace/path_class.h"

namespace traverse::gcode {
namespace {

// State of the machine and of the slicer's comments, as places in VerifyMachine::state_.
enum StatePlace : size_t {
  kType,
  kWidth,
  kHeight,
  kFans,  // and the three behind it
  kAccelPrint = kFans + 4,
  kJerkX,
  kJerkY,
  kMaxAccelX,
  kMaxAccelY,
  kMaxTravelX,
  kMaxTravelY,
  kKlipperAccel,
  kKlipperDecel,
  kKlipperCorner,
  kKlipperSpeed,
  kPressure,
  kFlow,
  kAccelTravel,  // from here on what no deposit depends on
  kAccelRetract,
  kStateCount,
};

// Numbers beyond this are not followed.
constexpr double kMaxNumber = 1e9;

bool Begins(std::string_view text, std::string_view with) {
  return text.size() >= with.size() && text.compare(0, with.size(), with) == 0;
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) {
    text.remove_suffix(1);
  }
  return text;
}

char Upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; }

// The numbers that slicers write: up to nine digits, and six decimals.
std::optional<Micro> PlainNumber(std::string_view text, size_t& used) {
  constexpr Micro kScale[] = {1'000'000, 100'000, 10'000, 1'000, 100, 10, 1};
  const bool negative = !text.empty() && text[0] == '-';
  size_t at = negative ? 1 : 0;
  Micro value = 0;
  size_t digits = 0;
  const auto take = [&] {
    const size_t begin = at;
    for (; at < text.size() && text[at] >= '0' && text[at] <= '9'; ++at) {
      value = value * 10 + (text[at] - '0');
      if (++digits > 15) break;
    }
    return at - begin;
  };
  const size_t whole = take();
  size_t decimals = 0;
  if (at < text.size() && text[at] == '.') {
    ++at;
    decimals = take();
  }
  if (digits == 0 || whole > 9 || decimals > 6) return std::nullopt;
  used = at;
  return (negative ? -value : value) * kScale[decimals];
}

std::optional<Micro> Number(std::string_view text, size_t& used) {
  if (const std::optional<Micro> plain = PlainNumber(text, used)) return plain;
  size_t at = 0;
  if (!text.empty() && text[0] == '+') at = 1;
  double value = 0;
  const auto result =
      std::from_chars(text.data() + at, text.data() + text.size(), value, std::chars_format::fixed);
  if (result.ec != std::errc{} || !(std::abs(value) <= kMaxNumber)) return std::nullopt;
  used = static_cast<size_t>(result.ptr - text.data());
  return std::llround(value * 1e6);
}

// True if the E words of the first moves in the plane hardly add up to a register, and no line says
// how they count: then they count from the move before.
bool FallsAsOftenAsItRises(std::string_view text) {
  for (const std::string_view mode : {"M82", "M83"}) {
    for (size_t at = text.find(mode); at != std::string_view::npos; at = text.find(mode, at + 1)) {
      if (at == 0 || text[at - 1] == '\n') return false;
    }
  }
  double last = 0;
  int rises = 0;
  int falls = 0;
  while (!text.empty() && rises + falls < 200) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    line = line.substr(0, line.find(';'));
    const size_t e = line.find('E');
    if (e == std::string_view::npos || line[0] != 'G') continue;
    double value = 0;
    std::from_chars(line.data() + e + 1, line.data() + line.size(), value);
    const bool sets = Begins(line, "G92");
    if (!sets && line.find('X') == std::string_view::npos &&
        line.find('Y') == std::string_view::npos) {
      continue;
    }
    if (!sets) ++(value <= last ? falls : rises);
    last = value;
  }
  return falls * 4 > rises;
}

// What lies behind the last comma, colon or blank sign of a state comment.
uint64_t ValueOf(std::string_view comment) {
  const size_t colon = comment.find(':');
  return DigestOf(Trim(comment.substr(colon + 1)));
}

}  // namespace

uint64_t DigestOf(std::string_view text) {
  uint64_t digest = 0xcbf29ce484222325u;
  for (const char c : text) digest = (digest ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return Mix(digest, text.size());
}

// The words of one command; a letter that is there twice, or whose number is none, makes it
// unreadable.
struct VerifyMachine::Words {
  explicit Words(std::string_view text) {
    for (text = Trim(text); !text.empty(); text = Trim(text)) {
      const char letter = Upper(text[0]);
      if (letter < 'A' || letter > 'Z' || Has(letter)) {
        readable = false;
        return;
      }
      text = Trim(text.substr(1));
      Micro value = 0;
      size_t used = 0;
      if (!text.empty() && !(Upper(text[0]) >= 'A' && Upper(text[0]) <= 'Z')) {
        const std::optional<Micro> number = Number(text, used);
        if (!number) {
          readable = false;
          return;
        }
        value = *number;
      }
      set |= 1u << (letter - 'A');
      values[static_cast<size_t>(letter - 'A')] = value;
      text.remove_prefix(used);
    }
  }

  bool Has(char letter) const { return (set >> (letter - 'A')) & 1u; }
  bool OnlyFrom(std::string_view letters) const {
    uint32_t known = 0;
    for (const char c : letters) known |= 1u << (c - 'A');
    return readable && (set & ~known) == 0;
  }
  Micro operator[](char letter) const { return values[static_cast<size_t>(letter - 'A')]; }

  bool readable = true;
  uint32_t set = 0;
  std::array<Micro, 26> values;  // those in `set`
};

void VerifyMachine::SetState(size_t slot, uint64_t value) {
  if (slot > kHeight) {
    Held& held = held_[slot];
    if (held.behind != motions_) held = {motions_, 0, {}};
    if (held.count < held.values.size()) held.values[held.count++] = state_[slot];
    const auto end = held.values.begin() + held.count;
    if (value != state_[slot] && std::find(held.values.begin(), end, value) != end) {
      sets_back_ = true;
    }
  }
  state_[slot] = value;
  state_changed_ = true;
}

void VerifyMachine::NoteMotion(int number, uint32_t words, const std::array<Micro, 3>& from,
                               Micro filament) {
  motion_ = Motion{from, at_, filament, pulled_, feed_, number, words, retracted(), false, 0, 0};
  ++motions_;
}

VerifyMachine::VerifyMachine(std::string_view text) : rest_(text) {
  relative_e_ = FallsAsOftenAsItRises(text);
}

bool VerifyMachine::Next(VerifyLine& line) {
  static_assert(kStateCount <= kStates);
  if (rest_.empty()) return false;
  const size_t end = std::min(rest_.find('\n'), rest_.size());
  line = VerifyLine{};
  line.number = ++number_;
  line.text = Trim(rest_.substr(0, end));
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
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
  const char letter = Upper(text[0]);
  int number = 0;
  const auto read = std::from_chars(text.data() + 1, text.data() + text.size(), number);
  sets_back_ = false;
  const bool numbered =
      read.ec == std::errc{} && text[1] != '-' &&
      (read.ptr == text.data() + text.size() || (*read.ptr != '.' && *read.ptr != '_'));
  if (letter == 'G' && numbered) {
    DoG(number, line);
    const bool moving = number <= 3 || number == 10 || number == 11 || number == 92;
    if (!moving) line.command = Mix('G', static_cast<uint64_t>(number));
  } else if (letter == 'M' && numbered) {
    DoM(number, line);
    line.command = Mix('M', static_cast<uint64_t>(number));
  } else {
    DoKlipper(line);
    line.command = DigestOf(text.substr(0, text.find_first_of(" \t=")));
  }
  line.sets_back = sets_back_;
}

void VerifyMachine::DoComment(VerifyLine& line) {
  const std::string_view text = line.text;
  if (Begins(text, ";TYPE:") || Begins(text, "; FEATURE:")) return SetState(kType, ValueOf(text));
  if (Begins(text, ";WIDTH:") || Begins(text, "; LINE_WIDTH:")) {
    return SetState(kWidth, ValueOf(text));
  }
  if (Begins(text, ";HEIGHT:") || Begins(text, "; LAYER_HEIGHT:")) {
    return SetState(kHeight, ValueOf(text));
  }
  // Names of features in the words of slicers without such marks.
  const bool other_quote = Begins(text, "; '") && text.find(" Path',") == std::string_view::npos;
  if (!other_quote && ClassOfComment(text)) return SetState(kType, DigestOf(text));
  if (Begins(text, "; tool H")) {
    SetState(kWidth, DigestOf(text));
    return SetState(kHeight, DigestOf(text));
  }
  for (const std::string_view wipe : {";WIPE_START", ";WIPE_END", "; WIPE_START", "; WIPE_END"}) {
    if (Begins(text, wipe)) return;
  }
  for (const std::string_view mark :
       {";LAYER_CHANGE", ";LAYER:", ";LAYER ", "; CHANGE_LAYER", ";MESH:", "; printing object",
        "; stop printing object", "; start printing object",
        "; OBJECT_ID:", ";layer:", "; BEGIN_LAYER_OBJECT", "; END_LAYER_OBJECT", "; <layer>",
        "; </layer>", ";; --- layer ", ";PRINTING:", ";PRINTING_ID:"}) {
    if (Begins(text, mark)) return Fence(line, LineRole::kFence);
  }
  constexpr std::string_view kNumbered = "; layer ";
  const bool numbered = text.size() > kNumbered.size() && text[kNumbered.size()] >= '0' &&
                        text[kNumbered.size()] <= '9';
  if (numbered && Begins(text, kNumbered)) return Fence(line, LineRole::kFence);
  Fence(line, LineRole::kComment);
}

void VerifyMachine::Mode(bool& mode, bool value, VerifyLine& line) {
  Fence(line, mode == value ? LineRole::kFence : LineRole::kFixed);
  mode = value;
}

void VerifyMachine::DoG(int number, VerifyLine& line) {
  const std::string_view code = line.text.substr(0, line.text.find(';'));
  const size_t digits = code.find_first_not_of("0123456789", 1);
  const Words words(digits == std::string_view::npos ? std::string_view{} : code.substr(digits));
  switch (number) {
    case 0:
    case 1:
    case 2:
    case 3:
      if (!words.OnlyFrom("XYZEFIJRP") || (number >= 2 && !plane_xy_)) {
        return Fence(line, LineRole::kFixed);
      }
      return Move(number, words, line);
    case 10:
    case 11:
      if (words.set != 0 || !words.readable) return Fence(line, LineRole::kFixed);
      NoteMotion(number, 0, at_, 0);
      line.moves = true;
      firmware_retracted_ = number == 10;
      return;
    case 17:
      // Slicers write it before each spiral lift.
      if (plane_xy_) return;
      [[fallthrough]];
    case 18:
    case 19:
      return Mode(plane_xy_, number == 17, line);
    case 20:
    case 21:
      return Mode(inches_, number == 20, line);
    case 90:
    case 91:
      return Mode(relative_, number == 91, line);
    case 92:
      if (words.readable && words.set == 1u << ('E' - 'A')) {
        e_ = words['E'];
        return;
      }
      for (size_t axis = 0; axis < 3 && words.readable; ++axis) {
        const char letter = static_cast<char>('X' + axis);
        if (words.Has(letter)) at_[axis] = words[letter];
      }
      if (words.readable && words.Has('E')) e_ = words['E'];
      return Fence(line, LineRole::kFixed);
    default:
      return Fence(line, LineRole::kFixed);
  }
}

void VerifyMachine::Move(int number, const Words& words, VerifyLine& line) {
  if (words.Has('F')) feed_ = words['F'];
  const std::array<Micro, 3> from = at_;
  for (size_t axis = 0; axis < 3; ++axis) {
    const char letter = static_cast<char>('X' + axis);
    if (words.Has(letter)) at_[axis] = relative_ ? at_[axis] + words[letter] : words[letter];
  }
  Micro filament = 0;
  if (words.Has('E')) {
    filament = relative_ || relative_e_ ? words['E'] : words['E'] - e_;
    e_ += filament;
  }
  const bool moves = at_[0] != from[0] || at_[1] != from[1];
  line.moves = moves || at_[2] != from[2] || filament != 0 || number >= 2;
  if (line.moves) {
    NoteMotion(number, words.set, from, filament);
    motion_.has_center = number >= 2 && (words.Has('I') || words.Has('J'));
    motion_.center_x = from[0] + (words.Has('I') ? words['I'] : 0);
    motion_.center_y = from[1] + (words.Has('J') ? words['J'] : 0);
  }
  if ((moves || number >= 2) && filament > 0) {
    Deposit(number, words, from, filament, line);
  } else {
    line.travels = moves;
    if (filament > 0) {
      line.primes = true;
      line.surplus = std::max<Micro>(filament - pulled_, 0);
    }
    // Moves relative to each other are kept as they are, and circles that deposit nothing.
    const bool circle = number >= 2 && !moves && at_[2] == from[2];
    if (relative_ || circle) Fence(line, LineRole::kFixed);
  }
  FollowFilament(filament, moves);
}

// Where slicers coast before a retraction they push a little less than they pulled back.
void VerifyMachine::FollowFilament(Micro filament, bool moves) {
  constexpr Micro kPrimeShare = 30;
  if (filament < 0) deepest_ = std::max(deepest_, pulled_ - filament);
  pulled_ = std::max<Micro>(pulled_ - filament, 0);
  if (!moves && filament > 0 && pulled_ * kPrimeShare <= deepest_) pulled_ = 0;
  if (pulled_ == 0) deepest_ = 0;
}

// Gone the other way, an arc that ends beside its circle would lie elsewhere.
bool VerifyMachine::IsCircular(const Words& words, const std::array<Micro, 3>& from) const {
  constexpr double kSlackMicro = 20'000;
  if (!words.Has('I') && !words.Has('J')) return true;
  const auto i = static_cast<double>(words.Has('I') ? words['I'] : 0);
  const auto j = static_cast<double>(words.Has('J') ? words['J'] : 0);
  const double end_radius = std::hypot(static_cast<double>(at_[0] - from[0]) - i,
                                       static_cast<double>(at_[1] - from[1]) - j);
  return std::abs(std::hypot(i, j) - end_radius) * (inches_ ? 25.4 : 1) <= kSlackMicro;
}

void VerifyMachine::Deposit(int number, const Words& words, const std::array<Micro, 3>& from,
                            Micro filament, VerifyLine& line) {
  std::array<Micro, 3> begin = from;
  std::array<Micro, 3> end = at_;
  // An arc by its center, or its radius, and the way round when gone from its smaller end.
  bool clockwise = number == 2;
  if (begin > end && (number < 2 || IsCircular(words, from))) {
    std::swap(begin, end);
    clockwise = number == 3;
  }
  // Each value is mixed with its place, and the sum taken: no value waits for the one before it.
  uint64_t sum = 0;
  uint64_t place = 0;
  const auto add = [&sum, &place](uint64_t value) { sum += Mix(++place, value); };
  add(number >= 2 ? (clockwise ? 2 : 3) : 1);
  for (size_t axis = 0; axis < 3; ++axis) {
    add(static_cast<uint64_t>(begin[axis]));
    add(static_cast<uint64_t>(end[axis]));
  }
  add(static_cast<uint64_t>(filament));
  add(static_cast<uint64_t>(feed_));
  add(tool_);
  add((retracted() ? 1u : 0u) + (inches_ ? 2u : 0u));
  add(StateDigest());
  if (number >= 2 && (words.Has('I') || words.Has('J'))) {
    add(static_cast<uint64_t>(from[0] + (words.Has('I') ? words['I'] : 0)));
    add(static_cast<uint64_t>(from[1] + (words.Has('J') ? words['J'] : 0)));
  } else if (number >= 2) {
    add(static_cast<uint64_t>(words.Has('R') ? words['R'] : 0));
  }
  line.role = LineRole::kDeposit;
  line.digest = Mix(0, sum);
  line.z = at_[2];
}

uint64_t VerifyMachine::StateDigest() {
  if (state_changed_) {
    state_digest_ = 0;
    for (size_t i = 0; i < kAccelTravel; ++i) state_digest_ = Mix(state_digest_, state_[i]);
    acceleration_digest_ = 0;
    for (size_t i = kAccelPrint; i < kPressure; ++i) {
      acceleration_digest_ = Mix(acceleration_digest_, state_[i]);
    }
    acceleration_digest_ = Mix(acceleration_digest_, state_[kAccelTravel]);
    state_changed_ = false;
  }
  return state_digest_;
}

uint64_t VerifyMachine::AccelerationDigest() {
  StateDigest();
  return acceleration_digest_;
}

void VerifyMachine::DoM(int number, VerifyLine& line) {
  const std::string_view code = line.text.substr(0, line.text.find(';'));
  const size_t digits = code.find_first_not_of("0123456789", 1);
  const std::string_view rest =
      digits == std::string_view::npos ? std::string_view{} : code.substr(digits);
  if (number == 73) return Fence(line, LineRole::kProgress);
  if (number == 82 || number == 83) return Mode(relative_e_, number == 83, line);
  for (const int known : {74, 104, 105, 117, 118, 140, 142, 155, 486, 591, 624, 625}) {
    if (number == known) return Fence(line, LineRole::kFence);
  }
  const Words words(rest);
  const auto set = [&words, this](char letter, size_t place) {
    if (words.Has(letter)) SetState(place, static_cast<uint64_t>(words[letter]) + 1);
  };
  if (number == 106 || number == 107) {
    const Micro index = words.Has('P') ? words['P'] / 1'000'000 : 0;
    if (words.OnlyFrom("SP") && index >= 0 && index < 4) {
      const Micro speed = number == 107 ? 0 : words.Has('S') ? words['S'] : 255'000'000;
      SetState(kFans + static_cast<size_t>(index), static_cast<uint64_t>(speed) + 1);
      fan_ = Mix(Mix(state_[kFans], state_[kFans + 1]), Mix(state_[kFans + 2], state_[kFans + 3]));
      return;
    }
  } else if (number == 204 && words.OnlyFrom("SPTR") && words.set != 0) {
    set('S', kAccelPrint);
    set('P', kAccelPrint);
    set('S', kAccelTravel);
    set('T', kAccelTravel);
    return set('R', kAccelRetract);
  } else if (number == 205 && words.OnlyFrom("XY") && words.set != 0) {
    set('X', kJerkX);
    return set('Y', kJerkY);
  } else if (number == 201 && words.OnlyFrom("XY") && words.set != 0) {
    set('X', kMaxAccelX);
    return set('Y', kMaxAccelY);
  } else if (number == 202 && words.OnlyFrom("XY") && words.set != 0) {
    set('X', kMaxTravelX);
    return set('Y', kMaxTravelY);
  } else if (number == 221 && words.OnlyFrom("S") && words.set != 0) {
    return set('S', kFlow);
  } else if (number == 900 && words.OnlyFrom("K") && words.set != 0) {
    return set('K', kPressure);
  } else if (number == 572 && words.OnlyFrom("SD") && words.Has('S')) {
    return set('S', kPressure);
  }
  Fence(line, LineRole::kFixed);
}

void VerifyMachine::DoKlipper(VerifyLine& line) {
  const std::string_view text = line.text;
  if (Begins(text, "SET_PRESSURE_ADVANCE ")) return SetState(kPressure, DigestOf(text));
  if (Begins(text, "EXCLUDE_OBJECT_START") || Begins(text, "EXCLUDE_OBJECT_END")) {
    return Fence(line, LineRole::kFence);
  }
  constexpr std::string_view kLimit = "SET_VELOCITY_LIMIT ";
  if (!Begins(text, kLimit)) {
    // What the next tool, or filament, has in its nozzle is not known.
    if (Upper(text[0]) == 'T' && std::exchange(tool_, DigestOf(text)) != tool_) {
      pulled_ = deepest_ = 0;
    }
    return Fence(line, LineRole::kFixed);
  }
  std::vector<std::pair<size_t, uint64_t>> settings;
  std::string_view rest = Trim(text.substr(kLimit.size(), text.find(';') - kLimit.size()));
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
    rest = Trim(rest.substr(word.size()));
    const size_t equals = std::min(word.find('='), word.size());
    const std::string_view name = word.substr(0, equals);
    const uint64_t value = DigestOf(word.substr(equals));
    if (name == "ACCEL") {
      settings.emplace_back(kKlipperAccel, value);
    } else if (name == "ACCEL_TO_DECEL") {
      settings.emplace_back(kKlipperDecel, value);
    } else if (name == "SQUARE_CORNER_VELOCITY") {
      settings.emplace_back(kKlipperCorner, value);
    } else if (name == "VELOCITY") {
      settings.emplace_back(kKlipperSpeed, value);
    } else {
      return Fence(line, LineRole::kFixed);
    }
  }
  for (const auto& [slot, value] : settings) SetState(slot, value);
}

}  // namespace traverse::gcode
