// What applies while something is printed, besides position and speed: feature, width, fan,
// acceleration.
//
// Slicers set these by lines such as `;TYPE:Perimeter`, `;WIDTH:0.45`, `M106 S204`, `M204 P800`.
// Such a line is a setter: it gives one or several slots a value. The value of a slot is the
// setter itself, so a writer can restore it by writing that line again, without knowing its
// meaning.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_PRINT_STATE_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_PRINT_STATE_H_

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/text/lexer.h"

namespace traverse::gcode {

enum Slot : uint8_t {
  kSlotType,    // ;TYPE:, ; FEATURE:
  kSlotWidth,   // ;WIDTH:, ; LINE_WIDTH:
  kSlotHeight,  // ;HEIGHT:, ; LAYER_HEIGHT:
  kSlotFan,     // M106, M107 of the part cooling fan
  kSlotFan1,    // M106 P1, and so on
  kSlotFan2,
  kSlotFan3,
  kSlotPrintAccel,     // M204 P, S
  kSlotTravelAccel,    // M204 T, S
  kSlotRetractAccel,   // M204 R
  kSlotJerkX,          // M205 X, M566 X, M207 X, M215 X
  kSlotJerkY,          // M205 Y, M566 Y, M207 X, M215 Y
  kSlotMaxAccelX,      // M201 X
  kSlotMaxAccelY,      // M201 Y
  kSlotMaxTravelX,     // M202 X, of Repetier
  kSlotMaxTravelY,     // M202 Y
  kSlotMaxAccelZ,      // M201 Z
  kSlotMaxAccelE,      // M201 E
  kSlotMaxSpeedX,      // M203 X
  kSlotMaxSpeedY,      // M203 Y
  kSlotMaxSpeedZ,      // M203 Z
  kSlotMaxSpeedE,      // M203 E
  kSlotJerkZ,          // M205 Z, M566 Z, M207 Z
  kSlotJerkE,          // M205 E, M566 E
  kSlotJunction,       // M205 J
  kSlotKlipperAccel,   // SET_VELOCITY_LIMIT ACCEL
  kSlotKlipperDecel,   // SET_VELOCITY_LIMIT ACCEL_TO_DECEL, MINIMUM_CRUISE_RATIO
  kSlotKlipperCorner,  // SET_VELOCITY_LIMIT SQUARE_CORNER_VELOCITY
  kSlotKlipperSpeed,   // SET_VELOCITY_LIMIT VELOCITY
  kSlotSpeed,          // M220
  kSlotPressure,       // M900, M572, M233, SET_PRESSURE_ADVANCE
  kSlotFlow,           // M221
  // Settings with names of their own, such as fans and input shapers (named_setting.h): each in one
  // of its kind's slots, to which its name falls. Two that share one cannot both be restored, which
  // the verifier finds.
  kSlotNamedFan,
  kSlotNamedTool = kSlotNamedFan + 6,
  kSlotNamedShaper = kSlotNamedTool + 6,
  kSlotNamedCurrent = kSlotNamedShaper + 6,
  kSlotNamedLight = kSlotNamedCurrent + 6,
  kSlotCount = kSlotNamedLight + 7,
};

using SlotMask = uint64_t;

static_assert(kSlotCount < 64);

constexpr SlotMask SlotBit(Slot slot) { return SlotMask{1} << slot; }

// From `first` to the one before `end`.
constexpr SlotMask SlotsUpTo(Slot first, Slot end) { return SlotBit(end) - SlotBit(first); }

inline constexpr SlotMask kAllSlots = SlotsUpTo(kSlotType, kSlotCount);

// The slots for how the machine moves, not what it deposits. They may differ between the travel to
// a path and the path.
inline constexpr SlotMask kDynamicsSlots = SlotsUpTo(kSlotPrintAccel, kSlotPressure);

inline constexpr SlotMask kFanSlots =
    SlotsUpTo(kSlotFan, kSlotPrintAccel) | SlotsUpTo(kSlotNamedFan, kSlotNamedTool);

// The slots that a line sets; 0 if it is not a setter. Reads the words of commands that may be one.
SlotMask CommentSlots(std::string_view comment);
SlotMask CommandSlots(Command& command);
SlotMask TextSlots(std::string_view line);

// Setters, numbered. 0 stands for "never set".
class SetterTable {
 public:
  SetterTable() { setters_.push_back({}); }

  // The number of the setter `line`, which sets `slots`.
  uint32_t Intern(std::string_view line, SlotMask slots);

  // The number of a known setter; 0 for others.
  uint32_t Find(std::string_view line) const;

  const std::string& Line(uint32_t setter) const { return setters_[setter].line; }
  SlotMask Slots(uint32_t setter) const { return setters_[setter].slots; }

 private:
  struct Setter {
    std::string line;
    SlotMask slots = 0;
  };
  std::deque<Setter> setters_;  // a deque: the keys below point into it
  absl::flat_hash_map<std::string_view, uint32_t> index_;
};

// [slot] the setter in force.
using PrintState = std::array<uint32_t, kSlotCount>;

inline void ApplySetter(PrintState& state, uint32_t setter, SlotMask slots) {
  for (int slot = 0; slot < kSlotCount; ++slot) {
    if ((slots >> slot) & 1u) state[static_cast<size_t>(slot)] = setter;
  }
}

// Print states, numbered from 0.
class StateTable {
 public:
  uint32_t Intern(const PrintState& state);
  const PrintState& operator[](uint32_t id) const { return states_[id]; }
  size_t size() const { return states_.size(); }

 private:
  std::deque<PrintState> states_;
  absl::flat_hash_map<PrintState, uint32_t> index_;
};

// The setters to write, in this order, so that the slots in `mask` change from `from` to `to`.
// Updates `from`.
std::vector<uint32_t> SettersBetween(PrintState& from, const PrintState& to, SlotMask mask,
                                     const SetterTable& setters);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_PRINT_STATE_H_
