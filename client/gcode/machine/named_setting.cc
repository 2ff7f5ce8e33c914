#include "client/gcode/machine/named_setting.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

struct KlipperSetting {
  std::string_view command;
  std::string_view name;        // the parameter that names what is set; empty if none does
  std::string_view parameters;  // each that it may have, between blanks
  Slot first;                   // of its kind
};

constexpr KlipperSetting kOfKlipper[] = {
    {"SET_FAN_SPEED", "FAN", " FAN SPEED ", kSlotNamedFan},
    {"SET_LED", "LED", " LED RED GREEN BLUE WHITE SYNC TRANSMIT ", kSlotNamedLight},
    {"SET_TMC_CURRENT", "STEPPER", " STEPPER CURRENT HOLDCURRENT ", kSlotNamedCurrent},
    {"SET_INPUT_SHAPER", "",
     " SHAPER_FREQ_X SHAPER_FREQ_Y SHAPER_TYPE SHAPER_TYPE_X SHAPER_TYPE_Y DAMPING_RATIO_X "
     "DAMPING_RATIO_Y ",
     kSlotNamedShaper},
};

struct CommandSetting {
  int number = 0;
  std::string_view names;  // letters whose values name what is set
  std::string_view words;  // letters that it may have
  Slot first;              // of its kind
};

constexpr CommandSetting kOfCommands[] = {
    {150, "", "RUWPB", kSlotNamedLight},
    {355, "", "SP", kSlotNamedLight},  // of the case
    {593, "", "XYFD", kSlotNamedShaper},
    {960, "S", "SP", kSlotNamedLight},  // of Bambu Lab's printers
};

bool Among(std::string_view parameters, std::string_view name) {
  return parameters.find(" " + std::string(name) + " ") != std::string_view::npos;
}

// What is called by the parameters of `setting` that are there, and by the value of its name.
std::optional<std::string> NameOf(const KlipperSetting& setting, std::string_view parameters) {
  std::string name(setting.command);
  bool named = setting.name.empty();
  bool sets = false;
  for (std::string_view word; !(word = NextWord(parameters)).empty();) {
    const size_t equals = word.find('=');
    if (equals == std::string_view::npos || !Among(setting.parameters, word.substr(0, equals))) {
      return std::nullopt;
    }
    const bool names = word.substr(0, equals) == setting.name;
    named = named || names;
    sets = sets || !names;
    name.append(" ").append(names ? word : word.substr(0, equals));
  }
  if (!named || !sets) return std::nullopt;
  return name;
}

}  // namespace

SlotMask SlotOfName(std::string_view name, Slot first) {
  constexpr Slot kKinds[] = {kSlotNamedFan,     kSlotNamedTool,  kSlotNamedShaper,
                             kSlotNamedCurrent, kSlotNamedLight, kSlotCount};
  const auto count = static_cast<uint64_t>(*std::ranges::upper_bound(kKinds, first) - first);
  uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return SlotBit(static_cast<Slot>(first + (hash >> 32) % count));
}

SlotMask NamedTextSlots(std::string_view command, std::string_view parameters) {
  for (const KlipperSetting& setting : kOfKlipper) {
    if (setting.command != command) continue;
    const auto name = NameOf(setting, parameters);
    return name ? SlotOfName(*name, setting.first) : 0;
  }
  return 0;
}

SlotMask NamedCommandSlots(Command& command) {
  if (command.letter != 'M') return 0;
  for (const CommandSetting& setting : kOfCommands) {
    if (setting.number != command.number) continue;
    if (!ReadWords(command) || command.words == 0) return 0;
    std::string name = "M" + std::to_string(command.number);
    bool sets = false;
    for (char letter = 'A'; letter <= 'Z'; ++letter) {
      if (!command.Has(letter)) continue;
      if (setting.words.find(letter) == std::string_view::npos) return 0;
      const bool names = setting.names.find(letter) != std::string_view::npos;
      sets = sets || !names;
      name.append(1, letter);
      if (names) name.append(std::to_string(command.Value(letter)));
    }
    for (const char letter : setting.names) {
      if (!command.Has(letter)) return 0;
    }
    return sets ? SlotOfName(name, setting.first) : 0;
  }
  return 0;
}

}  // namespace traverse::gcode
