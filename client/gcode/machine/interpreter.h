// A machine that follows G-code line by line: what each line does, and where the machine is then.
//
// It knows Marlin's and Klipper's commands as slicers use them. What it does not know is kUnknown,
// which everything built on it treats as a fence.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_INTERPRETER_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_INTERPRETER_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "client/gcode/machine/print_state.h"
#include "client/gcode/machine/vertex.h"
#include "client/gcode/text/lexer.h"

namespace traverse::gcode {

// Coordinates in the file's own unit (mm, or inch after G20) as its words state them.
struct Position {
  Decimal x = 0;
  Decimal y = 0;
  Decimal z = 0;

  friend bool operator==(const Position&, const Position&) = default;
  bool SameXy(const Position& other) const { return x == other.x && y == other.y; }
};

// A primed nozzle may lack this much of what was retracted: wipes round their parts.
inline constexpr Decimal kRetractionSlack = kDecimalOne / 10'000;

// The modal state of the machine, but for what print_state.h holds.
struct MachineState {
  Position at;
  Decimal e = 0;          // the extruder's register: what absolute E words count from
  Decimal feed = 0;       // F, per minute; 0: not yet set
  Decimal retracted = 0;  // filament pulled back by E words and not yet pushed again; at least 0
  Decimal deepest = 0;    // the most that this was since it last was 0
  bool firmware_retracted = false;  // between G10 and G11
  bool relative_xyz = false;        // G91
  bool relative_e = false;          // M83
  bool inches = false;              // G20
  bool plane_xy = true;             // G17
  int tool = 0;

  bool Retracted() const { return firmware_retracted || retracted > kRetractionSlack; }
  bool RelativeE() const { return relative_e || relative_xyz; }

  // The length in mm of one unit of the words.
  double UnitMm() const { return inches ? 25.4 : 1; }

  // A position in these units as a point in mm.
  Vertex InMm(const Position& place) const {
    return {ToDouble(place.x) * UnitMm(), ToDouble(place.y) * UnitMm()};
  }

  // The modes that a part of a file must share so that its lines can change places.
  bool SameModes(const MachineState& other) const {
    return relative_xyz == other.relative_xyz && relative_e == other.relative_e &&
           inches == other.inches && plane_xy == other.plane_xy && tool == other.tool;
  }
};

enum class StepKind : uint8_t {
  kBlank,
  kComment,    // one that means nothing here
  kSlot,       // sets slots of the print state
  kWipeMark,   // ;WIPE_START, ;WIPE_END
  kProgress,   // M73: means something only in the order of the file
  kStay,       // known, and harmless where it is: M104, M140, M105, M117, G90 in absolute mode
  kPlane,      // G17 in the XY plane: goes with the lift behind it
  kLabel,      // begin or end of an object
  kLayerMark,  // ;LAYER_CHANGE, ;LAYER:7
  kUnknown,
  kModeChange,   // G91, M82, G20 and the like, if they change something; T; G92 of X, Y, Z
  kExtrude,      // XY motion that deposits
  kZeroExtrude,  // XY motion with an E word that pushes nothing
  kTravel,       // XY motion without an E word, or longer than what may round to nothing
  kWipe,         // XY motion that pulls filament back
  kFilament,     // E alone
  kLift,         // Z alone; also a spiral, G2 or G3 with Z that ends where it began
  kFeed,         // F alone, or a motion of no length
  kSetE,         // G92 of E alone
  kFirmwareRetract,
  kFirmwareUnretract,
};

inline bool IsXyMotion(StepKind kind) {
  return kind == StepKind::kExtrude || kind == StepKind::kZeroExtrude ||
         kind == StepKind::kTravel || kind == StepKind::kWipe;
}

// What one line did.
struct Step {
  Line line;
  StepKind kind = StepKind::kBlank;
  bool arc = false;             // G2 or G3
  Position from;                // before; the state has where it is now
  bool retracted = false;       // before: filament is pulled back
  Decimal pulled = 0;           // before: how much of it, by E words
  Decimal filament = 0;         // pushed (above 0) or pulled back by this line
  SlotMask slots = 0;           // kSlot
  const char* fault = nullptr;  // why nobody knows what a machine makes of this line
  Command command;
};

class Interpreter {
 public:
  // Follows `text` from `begin`, with the machine in `state`. `text` outlives the interpreter.
  explicit Interpreter(std::string_view text, Offset begin = 0, const MachineState& state = {})
      : text_(text), next_(begin), state_(state) {}

  // Follows the next line; false at the end of the text.
  bool Next(Step& step);

  const MachineState& state() const { return state_; }
  std::string_view text() const { return text_; }

 private:
  void FollowCommand(Step& step);
  void FollowG(Step& step);
  void FollowM(Step& step);
  void Move(Step& step);
  void Arc(Step& step);
  void SetPosition(Step& step);
  // `still`: the head does not move in XY.
  void FollowFilament(Decimal filament, bool still);
  static StepKind SwitchMode(bool& mode, bool value);
  void SwitchUnits();

  std::string_view text_;
  Offset next_;
  MachineState state_;
};

// The object that a kLabel line begins, as the text that names it; empty if it ends one.
std::string_view LabelledObject(std::string_view line);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_INTERPRETER_H_
