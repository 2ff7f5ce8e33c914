// What a print is set to while it deposits, and the lines that set it: widths, fans, accelerations.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_PRINT_SETTINGS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_PRINT_SETTINGS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "client/gcode/verify/machine/command_words.h"

namespace traverse::gcode {

// `;TYPE:Perimeter`, `; FEATURE: Inner wall`: the comment says of what the following paths are.
bool NamesFeature(std::string_view comment);

// Whether a mark of a wipe is that of its begin; nothing if the comment is none.
std::optional<bool> BeginsWipe(std::string_view comment);

// Values are digests or numbers, to be compared; 0 where nothing was set yet.
class PrintSettings {
 public:
  // Each takes a line and returns true if it is one that sets something and nothing else; else
  // nothing is changed. What is given without text is the command and its words.
  bool SetByComment(std::string_view comment);
  bool SetByM(int number, const CommandWords& words);
  bool SetByKlipper(std::string_view line);

  // What is set so is compared with what held since the last call of Move.
  void Move() { ++motions_; }

  // A new line begins: sets_back() and sets_fan() are false.
  void BeginLine() { sets_back_ = sets_fan_ = false; }

  // The line gave a setting a value that it had, and lost, since the last move.
  bool sets_back() const { return sets_back_; }

  // The line set a fan, to whatever value.
  bool sets_fan() const { return sets_fan_; }

  // Of all that deposits depend on.
  uint64_t Digest() {
    if (changed_) Renew();
    return digest_;
  }

  // Of the accelerations, jerks and limits, those of travel included.
  uint64_t AccelerationDigest() {
    if (changed_) Renew();
    return acceleration_digest_;
  }

  // The same without those of travel and retractions alone.
  uint64_t PathAccelerationDigest() {
    if (changed_) Renew();
    return path_acceleration_digest_;
  }

  // Of all but what comments say: what a line may depend on of which no more is known.
  uint64_t SettingsDigest() const;

  uint64_t fan() const { return fan_; }

 private:
  enum Slot : size_t {
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
    kLimits,  // M201 Z and E, M203 X, Y, Z and E, M205 Z, E and J
    kKlipperAccel = kLimits + 9,
    kKlipperDecel,
    kKlipperCorner,
    kKlipperSpeed,
    kSpeed,
    kPressure,
    kFlow,
    kAccelTravel,  // from here on what no deposit depends on
    kAccelRetract,
    kSlots,  // and from here on what has a name of its own, such as fans and input shapers
  };

  // Of a line of Klipper: their names, and digests of their values.
  using Parameters = std::vector<std::pair<std::string_view, uint64_t>>;

  static constexpr size_t kMostNamed = 32;

  // What has a name of its own: a digest of that, of the command and of what it sets.
  struct Named {
    uint64_t key = 0;
    bool fan = false;
  };

  // A value to be given to what is called `named`.
  struct NamedValue {
    Named named;
    uint64_t value = 0;
  };

  // The values that a setting had since a move; four are enough to find out that one came back.
  struct Held {
    uint64_t behind = 0;  // how many moves
    size_t count = 0;
    std::array<uint64_t, 4> values{};
  };

  void Set(size_t slot, uint64_t value);
  bool SetWords(int number, const CommandWords& words);
  bool SetFan(int number, const CommandWords& words);
  bool SetOfTool(int number, const CommandWords& words, char tool, size_t slot);
  bool SetNamed(const std::vector<NamedValue>& values);
  bool SetNamedByM(int number, const CommandWords& words);
  bool SetNamedByKlipper(std::string_view command, const Parameters& parameters);
  bool SetPressure(const Parameters& parameters);
  bool SetLimits(const Parameters& parameters);
  static std::optional<Parameters> ParametersIn(std::string_view text);
  uint64_t NamedDigest(bool of_fans) const;
  void RenewFan();
  void Renew();

  std::array<uint64_t, kSlots + kMostNamed> values_{};
  std::array<Held, kSlots + kMostNamed> held_{};
  std::vector<Named> named_;          // [slot - kSlots]
  uint64_t digest_ = 0;               // of values_, unless changed_
  uint64_t acceleration_digest_ = 0;  // the same
  uint64_t path_acceleration_digest_ = 0;
  bool changed_ = true;
  uint64_t fan_ = 0;
  uint64_t motions_ = 1;
  bool sets_back_ = false;
  bool sets_fan_ = false;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_PRINT_SETTINGS_H_
