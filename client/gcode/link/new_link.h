// A link that the file does not have, line by line, as it is to be printed.
//
//   M204 S1000 | short move in, pull back, wipe, up | travel | down, prime | M204 S800, ;TYPE:
//                `------------ departure ----------'           `--------- arrival ----------'

#ifndef TRAVERSE_CLIENT_GCODE_LINK_NEW_LINK_H_
#define TRAVERSE_CLIENT_GCODE_LINK_NEW_LINK_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "client/gcode/link/link.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/part_start.h"

namespace traverse::gcode {

// How a line comes to be.
enum class LineForm : uint8_t {
  kRaw,      // as it is in the file
  kEdited,   // a line of the file, of whose words those are changed that are not right here
  kTravel,   // a line of the file, whose words are changed, or added, for a travel move
  kSetter,   // as it is in the file; it sets slots
  kState,    // whatever lines set what is not set as it must be
  kStand,    // new: moves Z alone, filament alone, or nothing and states the feed rate
  kSegment,  // new: a move, with an E word if it is a wipe
};

struct LinkLine {
  LineForm form = LineForm::kRaw;
  std::string_view raw;  // of lines of the file
  LinkStep step;         // what the line does here
  Position in_file;      // kEdited: where it leads in the file
  size_t state = 0;      // kState: NewLink::states
};

// Lines of the file that stay as they are, but for the extruder's absolute positions.
struct FilePart {
  Offset begin = 0;
  Offset end = 0;
  PartStart before;  // in the file
  PartStart behind;
  bool without_progress = false;  // leaves out lines of progress
};

// What a composer says becomes a line.
class NewLink {
 public:
  // The link begins with the machine at `at`, whose extruder does not matter.
  explicit NewLink(const MachineState& at) : machine_(at), pulled_(at.retracted) {}

  // The machine behind the lines so far, but for its extruder.
  const MachineState& machine() const { return machine_; }
  const Position& at() const { return machine_.at; }

  // Filament pulled back by E words and not yet pushed.
  Decimal pulled() const { return pulled_; }

  // What stays, ahead of all lines.
  const std::optional<FilePart>& part() const { return part_; }
  const std::vector<LinkLine>& lines() const { return lines_; }
  const PrintState& state(const LinkLine& line) const { return states_[line.state]; }

  // REQUIRES: there are no lines yet.
  void Keep(const FilePart& part);

  void Raw(std::string_view line);
  void Set(const PrintState& state, SlotMask slots);
  void SetBy(std::string_view line, SlotMask slots);

  // The line of `step` of the file, which leads to `to` here.
  void Edited(const LinkStep& step, const GcodeFile& file, const Position& to);

  // `line` as a move to `to` with `feed` in force.
  void Travel(std::string_view line, const Position& to, Decimal feed);

  void Feed(Decimal feed);
  void Lift(Decimal z, Decimal feed);
  void Pull(Decimal filament, Decimal feed);
  void Segment(const Position& to, bool extrudes, Decimal filament, Decimal feed);

 private:
  LinkLine& Add(LineForm form, std::string_view raw, StepKind kind, const Position& to);

  MachineState machine_;
  Decimal pulled_ = 0;
  std::optional<FilePart> part_;
  std::vector<LinkLine> lines_;
  std::vector<PrintState> states_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_NEW_LINK_H_
