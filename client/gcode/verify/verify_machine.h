// The verifier's own machine: what G-code deposits, and under which conditions.
//
// It shares no code with the reader and the writer whose work it checks, and it works otherwise:
// numbers become integers of 1e-6, and states become numbers to be compared, not lines to be
// written.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_VERIFY_MACHINE_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_VERIFY_MACHINE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace traverse::gcode {

// In units of 1e-6 of what the file's words count in.
using Micro = int64_t;

// What one line is to the verifier.
enum class LineRole : uint8_t {
  kNothing,   // travel, retraction, a setter of state, a blank line: seen by what it leads to
  kDeposit,   // an extruding move
  kComment,   // has to be there, in its section
  kProgress,  // M73: the same
  kFence,     // has to be there, in the order of the file: a section ends with it
  kFixed,     // a fence that is not known: the head has to be in the same place as well
};

struct VerifyLine {
  size_t number = 0;  // from 1
  std::string_view text;
  LineRole role = LineRole::kNothing;
  uint64_t digest = 0;   // kDeposit: of geometry, extrusion, speed and state; else of the text
  Micro z = 0;           // kDeposit: where it ends
  Micro surplus = 0;     // filament pushed beyond what had been pulled back, by a move of its alone
  bool primes = false;   // such a move ended here
  bool travels = false;  // moves in XY without depositing
};

class VerifyMachine {
 public:
  explicit VerifyMachine(std::string_view text) : rest_(text) {}

  // The next line; false at the end.
  bool Next(VerifyLine& line);

  Micro x() const { return at_[0]; }
  Micro y() const { return at_[1]; }
  Micro z() const { return at_[2]; }
  bool retracted() const { return firmware_retracted_ || pulled_ > kSlack; }
  uint64_t fan() const { return fan_; }

  static constexpr Micro kSlack = 100;  // of filament that rounding may lose

 private:
  struct Words;

  void Do(VerifyLine& line);
  void DoComment(VerifyLine& line);
  void DoG(int number, VerifyLine& line);
  void DoM(int number, VerifyLine& line);
  void DoKlipper(VerifyLine& line);
  void Move(int number, const Words& words, VerifyLine& line);
  void Deposit(int number, const Words& words, const std::array<Micro, 3>& from, Micro filament,
               VerifyLine& line);
  bool IsCircular(const Words& words, const std::array<Micro, 3>& from) const;
  void SetState(size_t slot, uint64_t value) {
    state_[slot] = value;
    state_changed_ = true;
  }
  uint64_t StateDigest();
  void Mode(bool& mode, bool value, VerifyLine& line);
  void Fence(VerifyLine& line, LineRole role);

  static constexpr size_t kStates = 24;

  std::string_view rest_;
  size_t number_ = 0;
  std::array<Micro, 3> at_{};
  Micro e_ = 0;
  Micro feed_ = 0;
  Micro pulled_ = 0;
  bool firmware_retracted_ = false;
  bool relative_ = false;
  bool relative_e_ = false;
  bool inches_ = false;
  bool plane_xy_ = true;
  uint64_t tool_ = 0;
  uint64_t fan_ = 0;
  std::array<uint64_t, kStates> state_{};
  uint64_t state_digest_ = 0;  // of state_, unless state_changed_
  bool state_changed_ = true;
};

// Mixes `value` into `digest`.
inline uint64_t Mix(uint64_t digest, uint64_t value) {
  uint64_t z = (digest ^ value) + 0x9e3779b97f4a7c15u + (digest << 6) + (digest >> 2);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

uint64_t DigestOf(std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_VERIFY_MACHINE_H_
