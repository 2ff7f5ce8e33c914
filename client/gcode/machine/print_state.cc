#include "client/gcode/machine/print_state.h"

#include <algorithm>
#include <bit>

#include "absl/strings/str_cat.h"
#include "client/gcode/dialects/dialect.h"
#include "client/gcode/machine/named_setting.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

// The words of `command` must all be among `allowed`; then returns the slots of those present.
struct WordSlots {
  char letter;
  SlotMask slots;
};

template <size_t n>
SlotMask SlotsOfWords(Command& command, const WordSlots (&known)[n]) {
  if (!ReadWords(command)) return 0;
  uint32_t left = command.words;
  SlotMask slots = 0;
  for (const WordSlots& word : known) {
    if (!command.Has(word.letter)) continue;
    slots |= word.slots;
    left &= ~Command::Bit(word.letter);
  }
  return left == 0 ? slots : 0;
}

SlotMask FanSlots(Command& command) {
  if (!ReadWords(command)) return 0;
  const uint32_t others = command.words & ~(Command::Bit('S') | Command::Bit('P'));
  if (others != 0) return 0;
  const Decimal fan = command.Has('P') ? command.Value('P') / kDecimalOne : 0;
  if (fan < 0) return 0;
  if (fan > 3) return SlotOfName(absl::StrCat("M106 P", fan), kSlotNamedFan);
  return SlotBit(static_cast<Slot>(kSlotFan + fan));
}

// What a setting of the tool in use, or of the one that the value of `tool` names, sets: the latter
// holds for itself, too.
SlotMask OfTool(Command& command, SlotMask slots, char tool) {
  if (slots == 0 || !command.Has(tool)) return slots;
  return slots |
         SlotOfName(absl::StrCat("M", command.number, " ", command.Value(tool)), kSlotNamedTool);
}

// Repetier's, as CuraEngine writes it; elsewhere M207 says how G10 retracts, by S and F.
SlotMask RepetierJerkSlots(Command& command) {
  const SlotMask slots = SlotsOfWords(
      command, {{'X', SlotBit(kSlotJerkX) | SlotBit(kSlotJerkY)}, {'Z', SlotBit(kSlotJerkZ)}});
  return (slots & SlotBit(kSlotJerkX)) != 0 ? slots : 0;
}

// Of the extruder in use, or of the one that is named, which holds for itself, too.
SlotMask PressureSlots(std::string_view rest) {
  SlotMask slots = 0;
  SlotMask of_extruder = 0;
  for (std::string_view parameter; !(parameter = NextWord(rest)).empty();) {
    if (parameter.starts_with("SMOOTH_TIME=")) {
      slots |= SlotOfName("SMOOTH_TIME", kSlotNamedTool);
    } else if (parameter.starts_with("EXTRUDER=")) {
      of_extruder = SlotOfName(parameter, kSlotNamedTool);
    } else {
      slots |= SlotBit(kSlotPressure);
    }
  }
  return slots == 0 ? 0 : slots | of_extruder;
}

SlotMask LimitSlots(std::string_view rest) {
  SlotMask slots = 0;
  for (std::string_view parameter; !(parameter = NextWord(rest)).empty();) {
    if (parameter.starts_with("ACCEL=")) {
      slots |= SlotBit(kSlotKlipperAccel);
    } else if (parameter.starts_with("ACCEL_TO_DECEL=") ||
               parameter.starts_with("MINIMUM_CRUISE_RATIO=")) {
      slots |= SlotBit(kSlotKlipperDecel);
    } else if (parameter.starts_with("SQUARE_CORNER_VELOCITY=")) {
      slots |= SlotBit(kSlotKlipperCorner);
    } else if (parameter.starts_with("VELOCITY=")) {
      slots |= SlotBit(kSlotKlipperSpeed);
    } else {
      return 0;
    }
  }
  return slots;
}

}  // namespace

SlotMask CommentSlots(std::string_view comment) {
  const Mark* mark = MarkOf(comment);
  switch (mark == nullptr ? MarkKind::kQuotedType : mark->kind) {
    case MarkKind::kType:
      return SlotBit(kSlotType);
    case MarkKind::kQuotedType:
      return TypeIn(comment).empty() ? 0 : SlotBit(kSlotType);
    case MarkKind::kWidth:
      return SlotBit(kSlotWidth);
    case MarkKind::kHeight:
      return SlotBit(kSlotHeight);
    case MarkKind::kWidthAndHeight:
      return SlotBit(kSlotWidth) | SlotBit(kSlotHeight);
    default:
      return 0;
  }
}

SlotMask CommandSlots(Command& command) {
  if (command.letter != 'M') return 0;
  switch (command.number) {
    case 106:
    case 107:
      return FanSlots(command);
    case 201:
      return SlotsOfWords(command, {{'X', SlotBit(kSlotMaxAccelX)},
                                    {'Y', SlotBit(kSlotMaxAccelY)},
                                    {'Z', SlotBit(kSlotMaxAccelZ)},
                                    {'E', SlotBit(kSlotMaxAccelE)}});
    case 202:
      return SlotsOfWords(command,
                          {{'X', SlotBit(kSlotMaxTravelX)}, {'Y', SlotBit(kSlotMaxTravelY)}});
    case 203:
      return SlotsOfWords(command, {{'X', SlotBit(kSlotMaxSpeedX)},
                                    {'Y', SlotBit(kSlotMaxSpeedY)},
                                    {'Z', SlotBit(kSlotMaxSpeedZ)},
                                    {'E', SlotBit(kSlotMaxSpeedE)}});
    case 204:
      return SlotsOfWords(command, {{'S', SlotBit(kSlotPrintAccel) | SlotBit(kSlotTravelAccel)},
                                    {'P', SlotBit(kSlotPrintAccel)},
                                    {'T', SlotBit(kSlotTravelAccel)},
                                    {'R', SlotBit(kSlotRetractAccel)}});
    case 205:
      return SlotsOfWords(command, {{'X', SlotBit(kSlotJerkX)},
                                    {'Y', SlotBit(kSlotJerkY)},
                                    {'Z', SlotBit(kSlotJerkZ)},
                                    {'E', SlotBit(kSlotJerkE)},
                                    {'J', SlotBit(kSlotJunction)}});
    case 207:
      return RepetierJerkSlots(command);
    case 215:  // Cheetah's
      return SlotsOfWords(command, {{'X', SlotBit(kSlotJerkX)}, {'Y', SlotBit(kSlotJerkY)}});
    case 220:
      return SlotsOfWords(command, {{'S', SlotBit(kSlotSpeed)}});
    case 221:
      return OfTool(command, SlotsOfWords(command, {{'S', SlotBit(kSlotFlow)}, {'T', 0}}), 'T');
    case 233:  // Repetier's
      return SlotsOfWords(command, {{'X', SlotBit(kSlotPressure)}, {'Y', SlotBit(kSlotPressure)}});
    case 566:  // RepRapFirmware's
      return SlotsOfWords(command, {{'X', SlotBit(kSlotJerkX)},
                                    {'Y', SlotBit(kSlotJerkY)},
                                    {'Z', SlotBit(kSlotJerkZ)},
                                    {'E', SlotBit(kSlotJerkE)}});
    case 572:
      return OfTool(command, SlotsOfWords(command, {{'S', SlotBit(kSlotPressure)}, {'D', 0}}), 'D');
    case 900:  // L and M: Bambu Lab's; T: a tool
      return OfTool(
          command,
          SlotsOfWords(command, {{'K', SlotBit(kSlotPressure)}, {'L', 0}, {'M', 0}, {'T', 0}}),
          'T');
    default:
      return NamedCommandSlots(command);
  }
}

SlotMask TextSlots(std::string_view line) {
  const size_t end = std::min(line.find_first_of(" \t;"), line.size());
  const std::string_view command = line.substr(0, end);
  if (!command.starts_with("SET_")) return 0;
  const std::string_view parameters = line.substr(end, std::min(line.find(';'), line.size()) - end);
  if (command == "SET_PRESSURE_ADVANCE") return PressureSlots(parameters);
  if (command == "SET_VELOCITY_LIMIT") return LimitSlots(parameters);
  return NamedTextSlots(command, parameters);
}

uint32_t SetterTable::Intern(std::string_view line, SlotMask slots) {
  const auto found = index_.find(line);
  if (found != index_.end()) return found->second;
  const auto id = static_cast<uint32_t>(setters_.size());
  setters_.push_back(Setter{std::string(line), slots});
  index_.emplace(setters_.back().line, id);
  return id;
}

uint32_t SetterTable::Find(std::string_view line) const {
  const auto found = index_.find(line);
  return found == index_.end() ? 0 : found->second;
}

uint32_t StateTable::Intern(const PrintState& state) {
  const auto [found, inserted] = index_.try_emplace(state, static_cast<uint32_t>(states_.size()));
  if (inserted) states_.push_back(state);
  return found->second;
}

std::vector<uint32_t> SettersBetween(PrintState& from, const PrintState& to, SlotMask mask,
                                     const SetterTable& setters) {
  std::vector<uint32_t> lines;
  if (from == to) return lines;
  // A setter of several slots may undo what another one did: these come first, and the last pass
  // puts right what they undid of each other.
  for (int pass = 0; pass < 3; ++pass) {
    for (size_t slot = 0; slot < kSlotCount; ++slot) {
      if (((mask >> slot) & 1u) == 0 || from[slot] == to[slot] || to[slot] == 0) continue;
      if (pass == 0 && std::has_single_bit(setters.Slots(to[slot]))) continue;
      lines.push_back(to[slot]);
      ApplySetter(from, to[slot], setters.Slots(to[slot]));
    }
  }
  return lines;
}

}  // namespace traverse::gcode
