#include "client/gcode/verify/machine/print_settings.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "client/gcode/verify/text.h"
#include "client/gcode/verify/trace/path_class.h"

namespace traverse::gcode {
namespace {

// The text after the colon of a comment.
uint64_t ValueOf(std::string_view comment) {
  return DigestOf(TrimLine(comment.substr(comment.find(':') + 1)));
}

uint64_t WordOr0(const CommandWords& words, char letter) {
  return static_cast<uint64_t>(words.ValueOr(letter, 0));
}

}  // namespace

void PrintSettings::Set(size_t slot, uint64_t value) {
  if (slot > kHeight) {
    Held& held = held_[slot];
    if (held.behind != motions_) held = {motions_, 0, {}};
    if (held.count < held.values.size()) held.values[held.count++] = values_[slot];
    const auto end = held.values.begin() + held.count;
    if (value != values_[slot] && std::find(held.values.begin(), end, value) != end) {
      sets_back_ = true;
    }
  }
  values_[slot] = value;
  changed_ = true;
}

void PrintSettings::SetWord(const CommandWords& words, char letter, size_t slot) {
  if (words.Has(letter)) Set(slot, static_cast<uint64_t>(words[letter]) + 1);
}

bool NamesFeature(std::string_view comment) {
  return Begins(comment, ";TYPE:") || Begins(comment, "; FEATURE:");
}

bool PrintSettings::SetByComment(std::string_view text) {
  if (NamesFeature(text)) {
    Set(kType, ValueOf(text));
    return true;
  }
  if (Begins(text, ";WIDTH:") || Begins(text, "; LINE_WIDTH:")) {
    Set(kWidth, ValueOf(text));
    return true;
  }
  if (Begins(text, ";HEIGHT:") || Begins(text, "; LAYER_HEIGHT:")) {
    Set(kHeight, ValueOf(text));
    return true;
  }
  // Names of features in the words of slicers without such marks.
  const bool other_quote = Begins(text, "; '") && text.find(" Path',") == std::string_view::npos;
  if (!other_quote && ClassOfComment(text)) {
    Set(kType, DigestOf(text));
    return true;
  }
  if (!Begins(text, "; tool H")) return false;
  Set(kWidth, DigestOf(text));
  Set(kHeight, DigestOf(text));
  return true;
}

bool PrintSettings::SetFan(int number, const CommandWords& words) {
  const Micro index = words.ValueOr('P', 0) / 1'000'000;
  if (!words.OnlyFrom("SP") || index < 0 || index >= 4) return false;
  const Micro speed = number == 107 ? 0 : words.ValueOr('S', 255'000'000);
  Set(kFans + static_cast<size_t>(index), static_cast<uint64_t>(speed) + 1);
  fan_ = Mix(Mix(values_[kFans], values_[kFans + 1]), Mix(values_[kFans + 2], values_[kFans + 3]));
  return true;
}

bool PrintSettings::SetByM(int number, const CommandWords& words) {
  if (number == 106 || number == 107) return SetFan(number, words);
  if (words.set == 0) return false;
  if (number == 204 && words.OnlyFrom("SPTR")) {
    SetWord(words, 'S', kAccelPrint);
    SetWord(words, 'P', kAccelPrint);
    SetWord(words, 'S', kAccelTravel);
    SetWord(words, 'T', kAccelTravel);
    SetWord(words, 'R', kAccelRetract);
    return true;
  }
  if ((number == 205 && words.OnlyFrom("XYZEJ")) || (number == 566 && words.OnlyFrom("XYZE")) ||
      (number == 215 && words.OnlyFrom("XY"))) {
    SetWord(words, 'X', kJerkX);
    SetWord(words, 'Y', kJerkY);
    SetWord(words, 'Z', kLimits + 6);
    SetWord(words, 'E', kLimits + 7);
    SetWord(words, 'J', kLimits + 8);
    return true;
  }
  if (number == 207 && words.Has('X') && words.OnlyFrom("XZ")) {
    // Repetier's jerk in the plane; with other words how other machines retract at G10.
    SetWord(words, 'X', kJerkX);
    SetWord(words, 'X', kJerkY);
    SetWord(words, 'Z', kLimits + 6);
    return true;
  }
  if (number == 201 && words.OnlyFrom("XYZE")) {
    SetWord(words, 'X', kMaxAccelX);
    SetWord(words, 'Y', kMaxAccelY);
    SetWord(words, 'Z', kLimits);
    SetWord(words, 'E', kLimits + 1);
    return true;
  }
  if (number == 202 && words.OnlyFrom("XY")) {
    SetWord(words, 'X', kMaxTravelX);
    SetWord(words, 'Y', kMaxTravelY);
    return true;
  }
  if (number == 203 && words.OnlyFrom("XYZE")) {
    SetWord(words, 'X', kLimits + 2);
    SetWord(words, 'Y', kLimits + 3);
    SetWord(words, 'Z', kLimits + 4);
    SetWord(words, 'E', kLimits + 5);
    return true;
  }
  if (number == 221 && words.OnlyFrom("S")) {
    SetWord(words, 'S', kFlow);
  } else if (number == 900 && words.Has('K') && words.OnlyFrom("KLMT")) {
    // Bambu Lab's L and M belong to what K says.
    Set(kPressure, Mix(Mix(static_cast<uint64_t>(words['K']), WordOr0(words, 'L')),
                       Mix(WordOr0(words, 'M'), WordOr0(words, 'T'))));
  } else if (number == 233 && words.OnlyFrom("XY")) {
    Set(kPressure, Mix(WordOr0(words, 'X'), WordOr0(words, 'Y')));
  } else if (number == 572 && words.OnlyFrom("SD") && words.Has('S')) {
    SetWord(words, 'S', kPressure);
  } else {
    return false;
  }
  return true;
}

bool PrintSettings::SetByKlipper(std::string_view text) {
  if (Begins(text, "SET_PRESSURE_ADVANCE ")) {
    Set(kPressure, DigestOf(text));
    return true;
  }
  constexpr std::string_view kLimit = "SET_VELOCITY_LIMIT ";
  if (!Begins(text, kLimit)) return false;
  std::vector<std::pair<size_t, uint64_t>> settings;
  std::string_view rest = TrimLine(text.substr(kLimit.size(), text.find(';') - kLimit.size()));
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
    rest = TrimLine(rest.substr(word.size()));
    const size_t equals = std::min(word.find('='), word.size());
    const std::string_view name = word.substr(0, equals);
    const uint64_t value = DigestOf(word.substr(equals));
    if (name == "ACCEL") {
      settings.emplace_back(kKlipperAccel, value);
    } else if (name == "ACCEL_TO_DECEL" || name == "MINIMUM_CRUISE_RATIO") {
      settings.emplace_back(kKlipperDecel, value);
    } else if (name == "SQUARE_CORNER_VELOCITY") {
      settings.emplace_back(kKlipperCorner, value);
    } else if (name == "VELOCITY") {
      settings.emplace_back(kKlipperSpeed, value);
    } else {
      return false;
    }
  }
  for (const auto& [slot, value] : settings) Set(slot, value);
  return true;
}

uint64_t PrintSettings::SettingsDigest() const {
  uint64_t digest = 0;
  for (size_t i = kFans; i < kSlots; ++i) digest = Mix(digest, values_[i]);
  return digest;
}

void PrintSettings::Renew() {
  digest_ = 0;
  for (size_t i = 0; i < kAccelTravel; ++i) digest_ = Mix(digest_, values_[i]);
  path_acceleration_digest_ = 0;
  for (size_t i = kAccelPrint; i < kPressure; ++i) {
    path_acceleration_digest_ = Mix(path_acceleration_digest_, values_[i]);
  }
  acceleration_digest_ = Mix(path_acceleration_digest_, values_[kAccelTravel]);
  acceleration_digest_ = Mix(acceleration_digest_, values_[kAccelRetract]);
  changed_ = false;
}

}  // namespace traverse::gcode
