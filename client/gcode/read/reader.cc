#include "client/gcode/read/reader.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/gcode/read/block_builder.h"
#include "client/gcode/text/digest_line.h"
#include "client/gcode/text/text.h"

namespace traverse {
namespace gcode {
namespace {

// Slicers name themselves in the first lines, or after a thumbnail.
constexpr size_t kHeadBytes = size_t{64} << 10;

// Moves from which the style of numbers is learnt.
constexpr int kStyleMoves = 2000;

class StyleScan {
 public:
  void Take(const Step& step, std::string_view text) {
    if (!IsXyMotion(step.kind)) {
      lone_feed_ = lone_feed_ || (step.kind == StepKind::kFeed && step.command.Has('F') &&
                                  step.command.words == Command::Bit('F'));
      return;
    }
    if (moves_ >= kStyleMoves) return;
    ++moves_;
    for (WordCursor word(step.line.Text(text)); word.Next();) {
      if (word.letter() == 'X' || word.letter() == 'Y') xy_.Show(word.value());
      if (word.letter() == 'E') e_.Show(word.value());
    }
  }

  void Finish(GcodeFile& file) const {
    file.xy_style = xy_.Learned();
    file.e_style = e_.Learned();
    file.feed_on_own_line = lone_feed_;
  }

 private:
  int moves_ = 0;
  bool lone_feed_ = false;
  NumberStyleLearner xy_;
  NumberStyleLearner e_;
};

absl::Status Fault(const GcodeFile& file, Offset at, std::string_view what) {
  return absl::InvalidArgumentError(absl::StrCat(file.Place(at), ": ", std::string(what)));
}

// Lines are read in less than a microsecond.
constexpr size_t kLinesToLimit = 256;

// The fewest bytes of most lines that extrude.
constexpr size_t kBytesPerSegment = 25;

// A line is M82 or M83, in large or small letters.
bool SaysHowECounts(std::string_view text) {
  for (const std::string_view mode : {"M82", "M83", "m82", "m83"}) {
    for (size_t at = text.find(mode); at != std::string_view::npos; at = text.find(mode, at + 1)) {
      const size_t before = text.substr(0, at).find_last_not_of(" \t");
      if (before == std::string_view::npos || text[before] == '\n') return true;
    }
  }
  return false;
}

// Some slicers count E from the move before without saying so: then its words fall as often as they
// rise, where those that count from a register hardly ever fall.
bool CountsFromMoveBefore(std::string_view text) {
  constexpr int kMoves = 200;
  constexpr int kFallsInTen = 2;
  if (SaysHowECounts(text)) return false;
  Interpreter interpreter(text);
  Decimal before = 0;
  int moves = 0;
  int falls = 0;
  for (Step step; moves < kMoves && interpreter.Next(step);) {
    if (step.kind == StepKind::kSetE) before = step.command.Value('E');
    if (!IsXyMotion(step.kind) || !step.command.Has('E')) continue;
    ++moves;
    falls += step.command.Value('E') <= before ? 1 : 0;
    before = step.command.Value('E');
  }
  return falls * 10 > moves * kFallsInTen;
}

// A move that prints to a point given from where it begins.
bool PrintsRelative(const Step& step, const MachineState& state) {
  return state.relative_xyz && step.filament > 0 && !state.at.SameXy(step.from);
}

// The words of a line that begins as a move does and cannot be read; else nothing.
std::string_view WordsOfUnreadMove(const Step& step, std::string_view text) {
  if (step.command.kind != LineKind::kText) return {};
  const std::string_view line = TrimBlanks(step.line.Text(text));
  const std::string_view words = line.substr(0, line.find(';'));
  const bool moves = words.size() > 2 && (words[0] == 'G' || words[0] == 'g') && words[1] >= '0' &&
                     words[1] <= '3' && !IsDigit(words[2]);
  return moves ? words : std::string_view();
}

// A line that would print if its words could be read.
bool MayBePrinting(const Step& step, std::string_view text) {
  return WordsOfUnreadMove(step, text).find_first_of("Ee") != std::string_view::npos;
}

absl::Status ReadBlocks(GcodeFile& file) {
  file.ends.reserve(file.text.size() / kBytesPerSegment);
  BlockBuilder builder(file);
  StyleScan style;
  MachineState start;
  start.relative_e = CountsFromMoveBefore(file.text);
  Interpreter interpreter(file.text, 0, start);
  Step step;
  size_t lines = 0;
  for (MachineState before = interpreter.state(); interpreter.Next(step);
       before = interpreter.state()) {
    if (++lines % kLinesToLimit == 0 && file.limit.Ended()) return file.limit.status();
    style.Take(step, file.text);
    builder.Take(step, before, interpreter);
    const Offset at = step.line.begin;
    if (PrintsRelative(step, interpreter.state())) file.relative_moves.Add(at);
    if (step.kind == StepKind::kTravel && step.command.Has('E')) file.empty_moves.Add(at);
    if (!WordsOfUnreadMove(step, file.text).empty()) file.unread_moves.Add(at);
  }
  builder.Finish();
  style.Finish(file);
  return absl::OkStatus();
}

// Why `step` may print though no E word does; null if it does not.
const char* OtherExtruder(const Step& step, std::string_view text) {
  const Command& c = step.command;
  if (c.Is('G', 1) && !c.Has('E') && (c.Has('X') || c.Has('Y'))) {
    if (c.Has('A') || c.Has('B')) {
      return "no extruding move: filament is moved by an A or B word here, as MakerBot and GPX "
             "have "
             "it, and not by E; export the file for a printer with E words (Marlin, Klipper), and "
             "convert it for the printer afterwards";
    }
  }
  if (c.Is('M', 101) || c.Is('M', 103)) {
    return "no extruding move: M101 and M103 switch the extruder on and off here, and no E word "
           "says "
           "how much it pushes; export the file with E words (Marlin, Klipper)";
  }
  const std::string_view words = TrimBlanks(step.line.Text(text));
  if ((c.Is('M', 3) || c.Is('M', 4)) && words.find('S') != std::string_view::npos) {
    return "no extruding move: M3 S sets a spindle, a laser or an extruder by its speed here, and "
           "no "
           "E word says how much it pushes; only files with E words can be optimised";
  }
  return nullptr;
}

// Why there is no path in `file`: the first line that prints and is not followed, if there is one.
absl::Status NoPath(const GcodeFile& file) {
  Interpreter interpreter(file.text);
  for (Step step; interpreter.Next(step);) {
    const MachineState& state = interpreter.state();
    if (const char* other = OtherExtruder(step, file.text)) {
      return Fault(file, step.line.begin, other);
    }
    if (MayBePrinting(step, file.text)) {
      return Fault(file, step.line.begin,
                   "no extruding move that can be read; in this one a word is no number, is there "
                   "twice, has more than 9 decimals or is too large");
    }
    if (PrintsRelative(step, state)) {
      return Fault(file, step.line.begin,
                   "no extruding move with absolute coordinates (G90); from here on the moves that "
                   "print are relative (G91), and none of these may change places");
    }
  }
  return absl::InvalidArgumentError(absl::StrCat(file.name, ": no extruding move"));
}

// Removes the numbers of lines, if all of them are right; otherwise returns the first line that is
// wrong.
std::optional<Offset> TakeNumbers(GcodeFile& file) {
  std::optional<LineNumbers> numbers = LearnLineNumbers(file.text);
  if (!numbers) return std::nullopt;
  std::string plain = WithoutLineNumbers(file.text, *numbers);
  const std::optional<Offset> odd = FirstOtherLine(file.text, WithLineNumbers(plain, *numbers));
  if (odd) return odd;
  file.text = std::move(plain);
  file.numbers = *std::move(numbers);
  return std::nullopt;
}

}  // namespace

bool CountAlike(const GcodeFile& a, const GcodeFile& b) {
  return a.modes.empty() || b.modes.empty() || a.modes[0].relative_e == b.modes[0].relative_e;
}

}  // namespace gcode

size_t GcodeFile::LayerOf(size_t block) const {
  const auto behind = std::ranges::upper_bound(layers, block, {}, &gcode::Layer::first_block);
  assert(behind != layers.begin());
  return static_cast<size_t>(behind - layers.begin()) - 1;
}

std::string GcodeFile::Place(gcode::Offset offset) const {
  return absl::StrCat(name, ":", 1 + std::count(text.begin(), text.begin() + offset, '\n'));
}

absl::StatusOr<std::shared_ptr<GcodeFile>> ReadGcode(std::string text, const std::string& name,
                                                     const gcode::WorkLimit& limit) {
  auto file = std::make_shared<GcodeFile>();
  file->limit = limit;
  file->name = name;
  file->text = std::move(text);
  if (file->text.size() >= std::numeric_limits<gcode::Offset>::max()) {
    return absl::ResourceExhaustedError(absl::StrCat(name, ": 4 GiB of G-code or more"));
  }
  const size_t nul = file->text.find('\0');
  if (nul != std::string::npos) {
    return gcode::Fault(*file, static_cast<gcode::Offset>(nul), "NUL byte: this is not text");
  }
  file->states_digest = gcode::StatesItsDigest(file->text);
  const std::optional<gcode::Offset> misnumbered = gcode::TakeNumbers(*file);
  file->slicer = gcode::SlicerOf(std::string_view(file->text).substr(0, gcode::kHeadBytes));
  file->profile = gcode::ReadProfile(file->text);
  if (absl::Status status = gcode::ReadBlocks(*file); !status.ok()) return status;
  if (file->blocks.empty() && misnumbered) {
    return gcode::Fault(*file, *misnumbered,
                        "its number or checksum does not follow from those of the other lines");
  }
  const bool returns_alone =
      file->text.find('\r') != std::string::npos && file->text.find('\n') == std::string::npos;
  if (file->blocks.empty() && returns_alone) {
    return absl::InvalidArgumentError(
        absl::StrCat(name,
                     ": no extruding move: its lines end with carriage returns alone, but must end "
                     "with line feeds"));
  }
  if (file->blocks.empty()) return gcode::NoPath(*file);
  return file;
}

}  // namespace traverse
