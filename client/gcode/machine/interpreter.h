// A machine that executes G-code line by line: what each line does, and where the machine is then.
//
// It knows Marlin's and Klipper's commands as slicers use them. Anything else is kUnknown, and
// everything built on it lets nothing cross such a line.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_INTERPRETER_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_INTERPRETER_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "client/gcode/machine/print_state.h"
#include "client/gcode/text/lexer.h"
#include "engine/model/point.h"

namespace traverse::gcode {

// Coordinates in the file's own unit (mm, or inch after G20) as its words state them.
struct Position {
  Decimal x = 0;
  Decimal y = 0;
  Decimal z = 0;

  friend bool operator==(const Position&, const Position&) = default;
  bool SameXy(const Position& other) const { return x == other.x && y == other.y; }
};

// A primed nozzle may lack this much of what was retracted, because wipes round their parts.
inline constexpr Decimal kRetractionSlack = kDecimalOne / 10'000;

// Only scripts lead so far beyond what is printed, and wait there: slicers lead around walls, move
// inwards, coast and wipe less far.
inline constexpr double kAsideMm = 10;

// The modal state of the machine, except what print_state.h has.
struct MachineState {
  Position at;
  Decimal e = 0;          // the extruder's register, from which absolute E words count
  Decimal feed = 0;       // F, per minute; 0: not yet set
  Decimal retracted = 0;  // filament retracted by E words and not yet pushed back; at least 0
  Decimal deepest = 0;    // the most of it since it was last 0
  bool firmware_retracted = false;  // between G10 and G11
  bool relative_xyz = false;        // G91
  bool relative_e = false;          // M83
  bool inches = false;              // G20
  bool plane_xy = true;             // G17
  bool in_wipe = false;             // between the marks of a wipe
  int tool = 0;

  bool Retracted() const { return firmware_retracted || retracted > kRetractionSlack; }
  bool RelativeE() const { return relative_e || relative_xyz; }

  // The length in mm of one unit of the words.
  double UnitMm() const { return inches ? 25.4 : 1; }

  // A position in these units as a point in mm.
  Point InMm(const Position& place) const {
    return {ToDouble(place.x) * UnitMm(), ToDouble(place.y) * UnitMm()};
  }
};

enum class StepKind : uint8_t {
  kBlank,
  kComment,    // one without meaning here
  kSlot,       // sets slots of the print state
  kWipeMark,   // ;WIPE_START, ;WIPE_END
  kProgress,   // M73 and others (progress_line.h): has meaning only in the file's order
  kStay,       // known, and harmless where it is: M104 and M140 to another temperature, M118
  kSays,       // a message, a beep, or what is in force already: goes with the path behind it
  kPlane,      // G17 in the XY plane: goes with the lift behind it
  kLabel,      // begin or end of an object
  kLayerMark,  // ;LAYER_CHANGE, ;LAYER:7
  kUnknown,
  kModeChange,   // G91, M82, G20 and the like, if they change anything; T; G92 of X, Y, Z
  kExtrude,      // XY motion that deposits
  kZeroExtrude,  // XY motion with an E word that pushes nothing
  kTravel,       // XY motion without an E word, or too long for one that may round to nothing
  kWipe,         // XY motion that retracts, or stands between the marks of a wipe
  kFilament,     // only E
  kLift,         // only Z; also a spiral, G2 or G3 with Z that ends where it began
  kRelative,     // G91 and G90 around lifts, and M82 or M83 behind that, which changes nothing
  kDwell,        // G4 or M400 beside a move of filament alone, at an end of a path: goes with it
  kFeed,         // only F, or a motion of no length
  kSetE,         // G92 of only E
  kFirmwareRetract,
  kFirmwareUnretract,
};

inline bool IsXyMotion(StepKind kind) {
  return kind == StepKind::kExtrude || kind == StepKind::kZeroExtrude ||
         kind == StepKind::kTravel || kind == StepKind::kWipe;
}

// Filament alone.
inline bool MovesFilament(StepKind kind) {
  return kind == StepKind::kFilament || kind == StepKind::kFirmwareRetract ||
         kind == StepKind::kFirmwareUnretract;
}

// The effect of one line.
struct Step {
  Line line;
  StepKind kind = StepKind::kBlank;
  bool arc = false;             // G2 or G3
  bool relative = false;        // its words count from where the head is
  Position from;                // before the line; the state has the position after it
  bool retracted = false;       // before the line: filament is retracted
  Decimal pulled = 0;           // before the line: how much of it, by E words
  Decimal filament = 0;         // pushed (above 0) or retracted by this line
  SlotMask slots = 0;           // kSlot
  const char* fault = nullptr;  // why machines interpret this line differently
  Command command;
};

class Interpreter {
 public:
  // No slicer writes so many lines between two that deposit, and what is known of each takes
  // memory. The last of so many is kUnknown, whatever it is: they stay as they are.
  static constexpr int kMostOfLink = 10'000;

  // Executes `text` from `begin`, with the machine in `state`. `text` must outlive the interpreter.
  explicit Interpreter(std::string_view text, Offset begin = 0, const MachineState& state = {})
      : text_(text), next_(begin), deposited_(state.at), state_(state) {}

  // Executes the next line; false at the end of the text.
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
  void FollowHeat(Step& step);
  // Lexes the line at `next`, which moves behind it; false at the end of the text.
  bool LexAhead(Offset& next, Command& command) const;
  // The same without blank lines and comments, however many there are.
  bool LexCommandAhead(Offset& next, Command& command) const;
  // The end of the lines that lift relatively, G91, moves of Z, G90, if such begin at the line
  // before `next`; otherwise 0.
  Offset LiftsUntil(Offset next) const;
  // The end of `M622 J1` and what it makes depend on a state of the machine, up to M623, if nothing
  // of that moves or sets anything; otherwise 0.
  Offset ConditionUntil(Offset next) const;
  // The next command, but for waiting, moves filament alone or pulls it back.
  bool PullsNext() const;
  // The next deposit begins near to where the head is, and it goes nowhere else before.
  bool PrintsNext() const;
  StepKind KindOfWait() const;
  void SwitchUnits();

  std::string_view text_;
  Offset next_;
  int lines_ = 0;               // without a deposit, up to kMostOfLink
  Offset lifts_until_ = 0;      // the end of the relative lift that was found last
  Offset condition_until_ = 0;  // the end of the condition that was found last
  bool behind_pull_ = false;    // the command before this one, but for waiting, was such a move
  Position deposited_;          // where it deposited last
  MachineState state_;

  // What the nozzle and the bed were last told; nothing behind lines that may have told them.
  struct Target {
    int tool = 0;
    Decimal degrees = 0;

    friend bool operator==(const Target&, const Target&) = default;
  };
  std::array<std::optional<Target>, 2> targets_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_INTERPRETER_H_
