#include "client/gcode/verify/machine/print_settings.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "client/gcode/verify/text.h"
#include "client/gcode/verify/trace/path_class.h"

namespace traverse::gcode {
namespace {

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

bool NamesFeature(std::string_view comment) {
  return comment.starts_with(";TYPE:") || comment.starts_with("; FEATURE:");
}

std::optional<bool> BeginsWipe(std::string_view comment) {
  if (comment == ";WIPE_START" || comment == "; WIPE_START") return true;
  if (comment == ";WIPE_END" || comment == "; WIPE_END") return false;
  return std::nullopt;
}

bool PrintSettings::SetByComment(std::string_view text) {
  constexpr std::pair<std::string_view, Slot> kMarks[] = {
      {";TYPE:", kType},         {"; FEATURE:", kType}, {";WIDTH:", kWidth},
      {"; LINE_WIDTH:", kWidth}, {";HEIGHT:", kHeight}, {"; LAYER_HEIGHT:", kHeight}};
  for (const auto& [mark, slot] : kMarks) {
    if (!text.starts_with(mark)) continue;
    Set(slot, DigestOf(TrimLine(text.substr(mark.size()))));
    return true;
  }
  // Names of features in the words of slicers without such marks.
  const bool other_quote =
      text.starts_with("; '") && text.find(" Path',") == std::string_view::npos;
  if (!other_quote && ClassOfComment(text)) {
    Set(kType, DigestOf(text));
    return true;
  }
  if (!text.starts_with("; tool H")) return false;
  Set(kWidth, DigestOf(text));
  Set(kHeight, DigestOf(text));
  return true;
}

bool PrintSettings::SetFan(int number, const CommandWords& words) {
  const Micro index = words.ValueOr('P', 0) / 1'000'000;
  if (!words.OnlyFrom("SP") || index < 0) return false;
  const auto speed = static_cast<uint64_t>(number == 107 ? 0 : words.ValueOr('S', 255'000'000)) + 1;
  if (index >= 4) {
    return SetNamed({{{Mix(DigestOf("M106"), static_cast<uint64_t>(index)), true}, speed}});
  }
  Set(kFans + static_cast<size_t>(index), speed);
  RenewFan();
  return true;
}

void PrintSettings::RenewFan() {
  sets_fan_ = true;
  fan_ = Mix(Mix(values_[kFans], values_[kFans + 1]), Mix(values_[kFans + 2], values_[kFans + 3]));
  fan_ += NamedDigest(true);
}

// All of `values`, or none if there would be too many names.
bool PrintSettings::SetNamed(const std::vector<NamedValue>& values) {
  const auto place_of = [this](uint64_t key) {
    const auto known = std::ranges::find(named_, key, &Named::key);
    return static_cast<size_t>(known - named_.begin());
  };
  for (const NamedValue& given : values) {
    if (place_of(given.named.key) < named_.size()) continue;
    if (named_.size() == kMostNamed) return false;
    named_.push_back(given.named);
  }
  for (const NamedValue& given : values) {
    Set(kSlots + place_of(given.named.key), given.value);
    if (given.named.fan) RenewFan();
  }
  return true;
}

// In whatever order they were named.
uint64_t PrintSettings::NamedDigest(bool of_fans) const {
  uint64_t digest = 0;
  for (size_t i = 0; i < named_.size(); ++i) {
    if (!of_fans || named_[i].fan) digest += Mix(named_[i].key, values_[kSlots + i]);
  }
  return digest;
}

// The commands whose words each are a setting, whichever of them are given.
bool PrintSettings::SetWords(int number, const CommandWords& words) {
  struct Command {
    int number;
    std::string_view letters;  // no others
    std::vector<std::pair<char, size_t>> slots;
    char needs = 0;
  };
  static const std::vector<Command> commands = {
      {201, "XYZE", {{'X', kMaxAccelX}, {'Y', kMaxAccelY}, {'Z', kLimits}, {'E', kLimits + 1}}},
      {202, "XY", {{'X', kMaxTravelX}, {'Y', kMaxTravelY}}},
      {203,
       "XYZE",
       {{'X', kLimits + 2}, {'Y', kLimits + 3}, {'Z', kLimits + 4}, {'E', kLimits + 5}}},
      {204,
       "SPTR",
       {{'S', kAccelPrint},
        {'P', kAccelPrint},
        {'S', kAccelTravel},
        {'T', kAccelTravel},
        {'R', kAccelRetract}}},
      {205,
       "XYZEJ",
       {{'X', kJerkX}, {'Y', kJerkY}, {'Z', kLimits + 6}, {'E', kLimits + 7}, {'J', kLimits + 8}}},
      // Repetier's jerk in the plane; without X how other machines retract at G10.
      {207, "XZ", {{'X', kJerkX}, {'X', kJerkY}, {'Z', kLimits + 6}}, 'X'},
      {215, "XY", {{'X', kJerkX}, {'Y', kJerkY}}},
      {220, "S", {{'S', kSpeed}}},
      {566, "XYZE", {{'X', kJerkX}, {'Y', kJerkY}, {'Z', kLimits + 6}, {'E', kLimits + 7}}},
  };
  for (const Command& command : commands) {
    if (command.number != number || !words.OnlyFrom(command.letters)) continue;
    if (command.needs != 0 && !words.Has(command.needs)) continue;
    for (const auto& [letter, slot] : command.slots) {
      if (words.Has(letter)) Set(slot, static_cast<uint64_t>(words[letter]) + 1);
    }
    return true;
  }
  return false;
}

bool PrintSettings::SetByM(int number, const CommandWords& words) {
  if (number == 106 || number == 107) return SetFan(number, words);
  if (words.set == 0) return false;
  if (SetWords(number, words)) return true;
  if (number == 221 && words.Has('S') && words.OnlyFrom("ST")) {
    return SetOfTool(number, words, 'T', kFlow);
  }
  // Bambu Lab's L and M belong to what K says.
  if (number == 900 && words.Has('K') && words.OnlyFrom("KLMT")) {
    return SetOfTool(number, words, 'T', kPressure);
  }
  if (number == 572 && words.Has('S') && words.OnlyFrom("SD")) {
    return SetOfTool(number, words, 'D', kPressure);
  }
  if (number == 233 && words.OnlyFrom("XY")) {
    Set(kPressure, Mix(WordOr0(words, 'X'), WordOr0(words, 'Y')));
    return true;
  }
  return SetNamedByM(number, words);
}

// For the tool in use, or for that which the word `tool` names: what it is told stays with it, too.
bool PrintSettings::SetOfTool(int number, const CommandWords& words, char tool, size_t slot) {
  uint64_t value = static_cast<uint64_t>(number);
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    if (words.Has(letter)) value = MixAll(value, letter, WordOr0(words, letter));
  }
  const uint64_t of = Mix(static_cast<uint64_t>(number), WordOr0(words, tool));
  if (words.Has(tool) && !SetNamed({{{Mix(DigestOf("tool"), of)}, value}})) return false;
  Set(slot, value);
  return true;
}

// Lights; input shaping, of both axes or of those that are named.
bool PrintSettings::SetNamedByM(int number, const CommandWords& words) {
  const auto known = [number](uint64_t what) { return MixAll(DigestOf("named M"), number, what); };
  const auto value = [&words](char letter) { return WordOr0(words, letter) + 1; };
  if (number == 960 && words.OnlyFrom("SP") && words.Has('P') && words.Has('S')) {
    return SetNamed({{{known(WordOr0(words, 'S'))}, value('P')}});
  }
  const std::string_view letters = number == 150   ? "RUWPB"
                                   : number == 355 ? "SP"
                                   : number == 593 ? "FD"
                                                   : "";
  if (letters.empty() || !words.OnlyFrom(number == 593 ? "FDXY" : letters)) return false;
  std::vector<NamedValue> values;
  for (const char letter : letters) {
    if (!words.Has(letter)) continue;
    for (const char axis : {'X', 'Y'}) {
      const bool all = number != 593 || words.Has('X') == words.Has('Y');
      if (!all && !words.Has(axis)) continue;
      const auto what = static_cast<uint64_t>(letter) * 256 + static_cast<uint64_t>(axis);
      values.push_back({{known(what)}, value(letter)});
    }
  }
  return !values.empty() && SetNamed(values);
}

// `NAME=VALUE NAME=VALUE ; comment`; unset where it is written otherwise.
std::optional<PrintSettings::Parameters> PrintSettings::ParametersIn(std::string_view text) {
  Parameters parameters;
  std::string_view rest = TrimLine(text.substr(0, text.find(';')));
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
    rest = TrimLine(rest.substr(word.size()));
    const size_t equals = word.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    parameters.emplace_back(word.substr(0, equals), DigestOf(word.substr(equals)));
  }
  return parameters;
}

bool PrintSettings::SetByKlipper(std::string_view text) {
  const size_t end = std::min(text.find_first_of(" \t;"), text.size());
  const std::string_view command = text.substr(0, end);
  const bool known = command.starts_with("SET_");
  const auto parameters = known ? ParametersIn(text.substr(end)) : std::nullopt;
  if (!parameters) return false;
  if (command == "SET_PRESSURE_ADVANCE") return SetPressure(*parameters);
  if (command == "SET_VELOCITY_LIMIT") return SetLimits(*parameters);
  return SetNamedByKlipper(command, *parameters);
}

// Of the extruder in use, or of the one that is named: what it is told stays with it, too.
bool PrintSettings::SetPressure(const Parameters& parameters) {
  uint64_t extruder = 0;
  for (const auto& [name, value] : parameters) {
    if (name == "EXTRUDER") extruder = value;
  }
  std::vector<NamedValue> named;
  uint64_t advance = 0;
  for (const auto& [name, value] : parameters) {
    if (name == "EXTRUDER") continue;
    if (name == "SMOOTH_TIME") {
      named.push_back({{DigestOf(name)}, Mix(extruder, value)});
    } else {
      advance = Mix(Mix(advance, extruder), Mix(DigestOf(name), value));
    }
    if (extruder != 0) named.push_back({{Mix(extruder, DigestOf(name))}, value});
  }
  if ((advance == 0 && named.empty()) || !SetNamed(named)) return false;
  if (advance != 0) Set(kPressure, advance);
  return true;
}

bool PrintSettings::SetLimits(const Parameters& parameters) {
  constexpr std::pair<std::string_view, size_t> kNames[] = {
      {"ACCEL", kKlipperAccel},
      {"ACCEL_TO_DECEL", kKlipperDecel},
      {"MINIMUM_CRUISE_RATIO", kKlipperDecel},
      {"SQUARE_CORNER_VELOCITY", kKlipperCorner},
      {"VELOCITY", kKlipperSpeed},
  };
  std::vector<std::pair<size_t, uint64_t>> settings;
  for (const auto& [name, value] : parameters) {
    const auto known = std::ranges::find(kNames, name, &std::pair<std::string_view, size_t>::first);
    if (known == std::end(kNames)) return false;
    settings.emplace_back(known->second, value);
  }
  for (const auto& [slot, value] : settings) Set(slot, value);
  return true;
}

// Each parameter of what has that name is a setting of its own.
bool PrintSettings::SetNamedByKlipper(std::string_view command, const Parameters& parameters) {
  struct Kind {
    std::string_view command;
    std::string_view name;
    bool fan;
    std::vector<std::string_view> sets;
  };
  static const std::vector<Kind> kinds = {
      {"SET_FAN_SPEED", "FAN", true, {"SPEED"}},
      {"SET_LED", "LED", false, {"RED", "GREEN", "BLUE", "WHITE", "SYNC", "TRANSMIT"}},
      {"SET_TMC_CURRENT", "STEPPER", false, {"CURRENT", "HOLDCURRENT"}},
      {"SET_INPUT_SHAPER",
       "",
       false,
       {"SHAPER_FREQ_X", "SHAPER_FREQ_Y", "SHAPER_TYPE", "SHAPER_TYPE_X", "SHAPER_TYPE_Y",
        "DAMPING_RATIO_X", "DAMPING_RATIO_Y"}},
  };
  const auto kind = std::ranges::find(kinds, command, &Kind::command);
  if (kind == kinds.end()) return false;
  uint64_t of = DigestOf(command);
  bool named = kind->name.empty();
  for (const auto& [name, value] : parameters) {
    if (name != kind->name) continue;
    of = Mix(of, value);
    named = true;
  }
  std::vector<NamedValue> values;
  for (const auto& [name, value] : parameters) {
    if (name == kind->name) continue;
    if (std::ranges::count(kind->sets, name) == 0) return false;
    values.push_back({{Mix(of, DigestOf(name)), kind->fan}, value});
  }
  return named && !values.empty() && SetNamed(values);
}

uint64_t PrintSettings::SettingsDigest() const {
  uint64_t digest = NamedDigest(false);
  for (size_t i = kFans; i < kSlots; ++i) digest = Mix(digest, values_[i]);
  return digest;
}

void PrintSettings::Renew() {
  digest_ = NamedDigest(false);
  for (size_t i = 0; i < kAccelTravel; ++i) digest_ = Mix(digest_, values_[i]);
  path_acceleration_digest_ = 0;
  for (size_t i = kAccelPrint; i < kPressure; ++i) {
    path_acceleration_digest_ = Mix(path_acceleration_digest_, values_[i]);
  }
  acceleration_digest_ =
      MixAll(path_acceleration_digest_, values_[kAccelTravel], values_[kAccelRetract]);
  changed_ = false;
}

}  // namespace traverse::gcode
