// Text under construction, and the state of the machine after it.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_GCODE_OUT_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_GCODE_OUT_H_

#include <string>
#include <string_view>

#include "client/gcode/link/new_link.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/text/line_edit.h"

namespace traverse::gcode {

// How the first line of `text` ends: "\n", "\r\n", or with more carriage returns.
std::string LineEndOf(std::string_view text);

class GcodeOut {
 public:
  // Appends to `text`, which must outlive this object. `at` is the machine after the present text.
  GcodeOut(const GcodeFile& file, const PartStart& at, std::string& text);

  // The machine after the text, without what Set() has yet to write.
  PartStart at;

  const GcodeFile& file() const { return file_; }

  // Appends `link`, which begins where the text ends.
  void Print(const NewLink& link);

  // Appends a part of the file unchanged, except the extruder's absolute positions, which continue
  // from here.
  void Copy(const FilePart& part);

  // Appends one line unchanged. The caller accounts for its effect on the machine.
  void Raw(std::string_view line) {
    Flush();
    text_.append(line);
  }

  // Ensures that the slots in `mask` are as in `state` when the next line is appended. Nothing is
  // set that would be set again before anything is done.
  void Set(const PrintState& state, SlotMask mask);

  // Appends the setters that are still to be written.
  void Flush();

  // Appends a line of the file, of whose words those are changed that are not right here: an
  // absolute E word continues from here, and X, Y and Z words state where the line leads now.
  // REQUIRES: line.form is kEdited.
  void Edited(const LinkLine& line);

  // A line of our own, in the styles of the file: `G1` for `step`, which moves Z alone, filament
  // alone, or nothing and states the feed rate.
  void Stand(const LinkStep& step);

  // G1 (or another `command`) to `to`; with an E word if `extrudes`. `words` follow X and Y,
  // `comment` stands at the end.
  void Segment(std::string_view command, const Position& to, bool extrudes, Decimal filament,
               Decimal feed, std::string_view words = {}, std::string_view comment = {});

 private:
  // Before a command, which moves filament alone or not.
  void Begin(bool pulls);
  void EndLine() { text_.append(line_end_); }
  void CopyShifted(const FilePart& part, Decimal shift);

  // Appends a setter, as it is in the file.
  void SetBy(std::string_view line, SlotMask slots);

  // Appends `line` as a move to `to` with `feed` in force: changes the words of the line, and adds
  // needed words that it lacks.
  void Travel(std::string_view line, const Position& to, Decimal feed);
  void AppendE(Decimal filament);
  void AppendWord(char letter, Decimal value, NumberStyle style);

  const GcodeFile& file_;
  std::string& text_;
  std::string line_end_;
  PrintState wanted_;  // in the slots of wanted_slots_
  SlotMask wanted_slots_ = 0;
  bool pulled_;  // the last command moved filament alone; or the text before this pulled it back
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_GCODE_OUT_H_
