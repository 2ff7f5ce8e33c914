// The verifier's own machine: what G-code deposits, and under which conditions.
//
// It shares no code with the reader and the writer whose work it checks, and it works otherwise:
// numbers become integers of 1e-6, and states become numbers to be compared, not lines to be
// written.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_VERIFY_MACHINE_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_VERIFY_MACHINE_H_

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "client/gcode/verify/machine/command_words.h"
#include "client/gcode/verify/machine/print_settings.h"
#include "client/gcode/verify/machine/text_lines.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {

// What one line is to the verifier.
enum class LineRole : uint8_t {
  kNothing,   // travel, retraction, a setter of state, a blank line: seen by what it leads to
  kDeposit,   // an extruding move
  kComment,   // has to be there, in its section: a command that only says something, too
  kProgress,  // tells how far the print is: the same
  kFence,     // has to be there, in the order of the file: a section ends with it
  kFixed,     // a fence that is not known: the head has to be in the same place as well
};

struct VerifyLine {
  uint32_t number = 0;  // from 1
  std::string_view text;
  LineRole role = LineRole::kNothing;
  uint64_t digest = 0;      // kDeposit: of geometry, extrusion, speed and state; else of the text
  uint64_t conditions = 0;  // kDeposit: the same without where and how much
  Micro z = 0;              // kDeposit: where it ends
  // Filament pushed by a move of its alone beyond what had been pulled back; negative if short of
  // it, and yet as much as a priming.
  Micro surplus = 0;
  bool primes = false;     // such a move ended here
  bool travels = false;    // moves in XY without depositing
  bool moves = false;      // the head or the filament moved: VerifyMachine::motion
  bool stays = false;      // states where the head is already, as far as can be told: motion, too
  bool sets = false;       // a setting and nothing else, by a command
  uint64_t command = 0;    // what is set or done, without its values; 0: moves, comments, G92 E
  bool label = false;      // of an object, whose moves a printer may be told to leave out
  bool photo = false;      // a macro leads the head away for a picture, and back
  bool sets_fan = false;   // a fan, to whatever value
  bool sets_back = false;  // gives a setting a value that it had, and lost, since the last move
};

// How the head and the filament moved.
struct Motion {
  std::array<Micro, 3> from{};
  std::array<Micro, 3> to{};
  Micro filament = 0;  // pushed; pulled back if negative
  Micro pulled = 0;    // still pulled back before it
  Micro feed = 0;      // in force
  int number = 0;      // G0 to G3, G10 and G11; G4 behind a move of filament alone
  uint32_t words = 0;  // bit (letter - 'A')
  bool was_retracted = false;
  bool has_center = false;  // of an arc
  Micro center_x = 0;
  Micro center_y = 0;
  Micro radius = 0;  // of an arc without a center: its R word
  Micro turns = 0;   // of an arc: its P word
};

class VerifyMachine {
 public:
  explicit VerifyMachine(std::string_view text);

  // The next line; false at the end.
  bool Next(VerifyLine& line);

  const std::array<Micro, 3>& at() const { return at_; }  // X, Y and Z of the head
  Micro z() const { return at_[2]; }
  bool retracted() const { return firmware_retracted_ || pulled_ > kSlack; }
  bool inches() const { return inches_; }
  uint64_t tool() const { return tool_; }

  // REQUIRES: the last line moves, or stays.
  const Motion& motion() const {
    assert(moved_at_ == lines_.number());
    return motion_;
  }

  PrintSettings& settings() { return settings_; }
  const PrintSettings& settings() const { return settings_; }

  const TextLines& lines() const { return lines_; }  // taken so far

  static constexpr Micro kSlack = 100;  // of filament that rounding may lose

 private:
  void Do(VerifyLine& line);
  void DoComment(VerifyLine& line);
  void DoG(int number, VerifyLine& line);
  void DoM(int number, VerifyLine& line);
  void DoKlipper(VerifyLine& line);
  void Move(int number, const CommandWords& words, VerifyLine& line);
  void SetPosition(const CommandWords& words, VerifyLine& line);  // G92
  void Deposit(int number, const CommandWords& words, const std::array<Micro, 3>& from,
               Micro filament, VerifyLine& line);
  void FollowFilament(Micro filament, bool moves);
  bool IsCircular(const CommandWords& words, const std::array<Micro, 3>& from) const;
  void NoteMotion(int number, uint32_t words, const std::array<Micro, 3>& from, Micro filament);
  void Mode(bool& mode, bool value, VerifyLine& line);
  // How many of the next lines move Z alone and end with G90, and with the mode of the extruder if
  // that is stated again; 0: other lines follow.
  size_t LinesOfLift() const;
  bool ConditionOnlyTells() const;
  bool PullsBehind() const;     // so does the next command, without waiting
  bool DepositsBehind() const;  // the next lines that lead sideways, near to where the head is
  bool IsFar(Micro x, Micro y) const;
  void Wait(Micro milliseconds, VerifyLine& line);
  bool InLift() const { return lines_.number() <= last_of_lift_; }
  void SwitchUnits(bool inches, VerifyLine& line);
  void Heat(int number, VerifyLine& line);
  void Fence(VerifyLine& line, LineRole role);

  TextLines lines_;
  size_t moved_at_ = 0;        // the line of motion_
  bool pulls_ = false;         // the line moves filament alone
  bool waits_ = false;         // the command before it did, or what stands before waiting
  size_t last_of_lift_ = 0;    // the line behind a lift in relative mode
  bool in_condition_ = false;  // of M622, up to M623, with nothing in it that moves or sets
  std::array<Micro, 3> at_{};
  std::array<Micro, 3> left_{};  // where it deposited last
  Nano e_ = 0;
  Micro feed_ = 0;
  Micro pulled_ = 0;
  Micro deepest_ = 0;  // the most that pulled_ was since it last was 0
  bool firmware_retracted_ = false;
  bool relative_ = false;
  bool relative_e_ = false;
  bool inches_ = false;
  bool plane_xy_ = true;
  uint64_t tool_ = DigestOf("T0");
  bool prints_ = false;  // has deposited something
  // Digests of what the nozzle and the bed were told last; 0 where it may have been something else.
  uint64_t nozzle_ = 0;
  uint64_t bed_ = 0;
  PrintSettings settings_;
  Motion motion_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_VERIFY_MACHINE_H_
