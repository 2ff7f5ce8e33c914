// Text under construction, and the machine as it is behind it.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_GCODE_OUT_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_GCODE_OUT_H_

#include <string>
#include <string_view>

#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/text/line_edit.h"
#include "client/gcode/write/link.h"

namespace traverse::gcode {

// How the first line of `text` ends: "\n", "\r\n", or with more carriage returns.
std::string LineEndOf(std::string_view text);

class GcodeOut {
 public:
  // Appends to `text`, which outlives this object. `at` is the machine behind what `text` holds.
  GcodeOut(const GcodeFile& file, const PartStart& at, std::string& text);

  // The machine behind the text, but for what Set() left to do.
  PartStart at;

  const GcodeFile& file() const { return file_; }

  // Appends a part of the file as it is, but for the extruder's absolute positions, which go on
  // from where they are here. `before` and `behind` are the machine around the part in the file.
  // M73 lines are left out if `without_progress`.
  void Copy(Offset begin, Offset end, const PartStart& before, const PartStart& behind,
            bool without_progress);

  // Appends one line as it is. What it does to the machine is the caller's.
  void Raw(std::string_view line) {
    Flush();
    text_.append(line);
  }

  // Sees to it that the slots in `mask` are as in `state` when the next line is appended: nothing
  // is set that is set to something else before anything was done.
  void Set(const PrintState& state, SlotMask mask);

  // The line `setter`, which stands here in the file.
  void SetBy(std::string_view line, SlotMask slots);

  // Appends the setters that are still to be written.
  void Flush();

  // Appends a line of a link that moves nothing in XY: an absolute E word goes on from here, and X
  // and Y words, if it has any, say where the head is already.
  void LinkLine(const LinkStep& step);

  // Appends a line of a link that moves to where it does in the file.
  void MoveLine(const LinkStep& step);

  // The same of a line that moves Z, to `z` instead of where it leads in the file.
  void LiftLine(const LinkStep& step, Decimal z);

  // Appends `line` as a move to (x, y) at `z` with `feed` in force: the words of the line are
  // changed, and those that are needed and lacking added.
  void Travel(std::string_view line, const Position& to, Decimal feed);

  // A line of our own: `G1` with the words given, in the styles of the file.
  void Feed(Decimal feed);
  void Lift(Decimal z, Decimal feed);
  void Pull(Decimal filament, Decimal feed);

  // G1 (or another `command`) to `to`; with an E word if `extrudes`. `words` are put behind X and
  // Y, `comment` at the end.
  void Segment(std::string_view command, const Position& to, bool extrudes, Decimal filament,
               Decimal feed, std::string_view words, std::string_view comment);

 private:
  void EndLine() { text_.append(line_end_); }
  void EditedLine(const LinkStep& step, const Position& to);
  void StraightTravel(const Position& to, Decimal feed);
  void CopyShifted(Offset begin, Offset end, Decimal shift, MachineState modes,
                   bool without_progress);
  void AppendE(Decimal filament);
  void AppendWord(char letter, Decimal value, NumberStyle style);

  const GcodeFile& file_;
  std::string& text_;
  std::string line_end_;
  PrintState wanted_;  // in the slots of wanted_slots_
  SlotMask wanted_slots_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_GCODE_OUT_H_
