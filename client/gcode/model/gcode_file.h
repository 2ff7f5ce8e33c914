// A sliced file, divided into its paths and the text between them.
//
//   head | link 0 | block 0 | link 1 | block 1 | ... | foot
//
// A block is the text of one path: from its first extruding line to its last, with the moves
// without extrusion that belong to its end. Link i is the text between blocks i - 1 and i:
// retraction, travel, and the lines that set the state for what follows. Nothing is copied; the
// text stays as it was read.
//
// Memory beside the text: about 160 bytes per path and 16 bytes per segment. Sliced files have at
// least 190 bytes of text per path, and mostly many times that; and 25 bytes per segment.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_GCODE_FILE_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_GCODE_FILE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/gcode/dialects/dialect.h"
#include "client/gcode/machine/interpreter.h"
#include "client/gcode/machine/machine_profile.h"
#include "client/gcode/machine/print_state.h"
#include "client/gcode/text/line_numbers.h"
#include "client/gcode/work_limit.h"
#include "engine/model/point.h"

namespace traverse {
namespace gcode {

// Slicers move in by about a line width before they leave a path.
inline constexpr double kMaxDepartureMm = 1;

// The parts of a link.
enum LinkFlag : uint16_t {
  kLinkRetracts = 1 << 0,
  kLinkWipes = 1 << 1,     // retracts while moving
  kLinkDeparts = 1 << 2,   // begins with a short inward move, before the travel proper
  kLinkComments = 1 << 3,  // has comments without meaning here
  kLinkSplits = 1 << 4,    // nothing crosses it, but its travel may be written again
  kLinkFixed = 1 << 5,     // stays byte by byte, and so do the paths on both sides of it
  kLinkNewLayer = 1 << 6,
  // Begins with lines that stay byte by byte, and so does the path before it; the rest is as in a
  // link that splits.
  kLinkFixedFrom = 1 << 7,
  kLinkRetractsAgain = 1 << 8,  // after a prime: no example for other links
  kLinkHeats = 1 << 9,          // sets a temperature
  // To a layer no lower, or to the first one: leads beyond all that is printed so far, but for the
  // start script's, and back. A script's, up to the last travel move.
  kLinkAside = 1 << 10,
};

enum BlockFlag : uint16_t {
  kBlockTail = 1 << 0,        // ends with a short move at print speed that extrudes nothing
  kBlockCoast = 1 << 1,       // that move completes the path with the pressure left in the nozzle
  kBlockFan = 1 << 2,         // the fan changes inside it
  kBlockType = 1 << 3,        // the feature changes inside it
  kBlockComments = 1 << 4,    // has comments inside without meaning here
  kBlockProgress = 1 << 5,    // has lines of progress inside
  kBlockPinned = 1 << 6,      // printed while retracted or rising, or no true arc: stays as it is
  kBlockZero = 1 << 7,        // has a segment whose extrusion rounds to nothing
  kBlockScript = 1 << 8,      // before the first mark of a layer: a start script's
  kBlockCommand = 1 << 9,     // a command inside it sets a slot
  kBlockGoesOn = 1 << 10,     // closed; a move without filament continues along it after its end
  kBlockArcs = 1 << 11,       // has arcs
  kBlockOwnFan = 1 << 12,     // the link before it sets the fan, changed or not
  kBlockRetracted = 1 << 13,  // printed while retracted
};

struct Block {
  Offset begin = 0;
  Offset end = 0;
  uint32_t state_in = 0;   // StateTable: the state of its first segment
  uint32_t state_out = 0;  // and the state after its end
  Decimal feed_in = 0;     // F of its first segment
  Decimal feed_out = 0;    // F after its end
  Position first;          // where its first segment begins
  Position last;           // where the head is after its end, including its tail
  Decimal e_in = 0;        // the extruder's register before and after
  Decimal e_out = 0;
  float length_mm = 0;     // of its extruding segments
  float travel_mm = 0;     // of the link before it, as in the file
  Decimal lift = 0;        // of the link before it: how far it rises above both its ends
  uint32_t object = 0;     // SetterTable: the label in force; 0: none
  uint32_t first_end = 0;  // of its segments' ends in GcodeFile::ends
  uint32_t end_count = 0;
  uint16_t flags = 0;  // BlockFlag
  uint16_t link = 0;   // LinkFlag, of the link before it
  uint16_t mode = 0;   // index into GcodeFile::modes
};

// A run of blocks at one height. A mark of the slicer begins a new one in any case.
struct Layer {
  uint32_t first_block = 0;
  uint32_t end_block = 0;
  Decimal z = 0;
  Offset fault_at = 0;          // if `fault`, its line
  const char* fault = nullptr;  // of a line in it or on the travel to or from it: it stays as it is
  double height_mm = 0.2;  // above the one below it, or above the plate; 0.2: that tells nothing
};

// How many lines of a kind there are, and the first of them.
struct OddLines {
  int64_t count = 0;
  Offset at = 0;

  void Add(Offset line) {
    if (count++ == 0) at = line;
  }
};

}  // namespace gcode

struct GcodeFile {
  std::string name;  // for messages
  std::string text;  // without the numbers of its lines
  std::optional<gcode::LineNumbers> numbers;
  bool states_digest = false;  // of the text with its numbers: text/digest_line.h
  gcode::Slicer slicer;

  std::vector<gcode::Block> blocks;
  std::vector<gcode::Layer> layers;

  // Where the segments of all blocks end, in mm; an arc is one segment.
  std::vector<Point> ends;

  // Modes in force in blocks: units, relative or absolute, tool.
  std::vector<gcode::MachineState> modes;

  gcode::SetterTable setters;  // also holds labels of objects
  gcode::StateTable states;

  // After the last line of the start script: at the first mark of a layer or, in files without such
  // marks, after the last line near the beginning that switches modes or waits for heat; 0 if there
  // is none.
  gcode::Offset script_end = 0;

  // Moves of which none is in a block: those that print under G91, those whose E word pushes
  // nothing, and lines that begin as moves do and cannot be read.
  gcode::OddLines relative_moves;
  gcode::OddLines empty_moves;
  gcode::OddLines unread_moves;

  // Begins of the lines of progress (machine/progress_line.h), ascending.
  std::vector<gcode::Offset> progress;

  gcode::MachineProfile profile;
  gcode::NumberStyle xy_style;
  gcode::NumberStyle e_style;
  bool feed_on_own_line = false;  // a path's F stands on a line before it

  // How long the work on this file may go on: whoever goes through much of it asks.
  gcode::WorkLimit limit;

  // Link i: what stands between the blocks i - 1 and i; i = blocks.size() is the foot.
  std::string_view LinkText(size_t i) const {
    const gcode::Offset begin = i == 0 ? 0 : blocks[i - 1].end;
    const gcode::Offset end =
        i == blocks.size() ? static_cast<gcode::Offset>(text.size()) : blocks[i].begin;
    return std::string_view(text).substr(begin, end - begin);
  }

  // Filament is pulled back along block `i`, behind its end.
  bool WipedBehind(size_t i) const {
    constexpr int kFixed = gcode::kLinkFixed | gcode::kLinkFixedFrom;
    return i + 1 < blocks.size() && (blocks[i + 1].link & gcode::kLinkWipes) != 0 &&
           (blocks[i + 1].link & kFixed) == 0;
  }

  // The lines of a layer's paths and of the links between them.
  std::string_view PathsText(const gcode::Layer& layer) const {
    const gcode::Offset begin = blocks[layer.first_block].begin;
    return std::string_view(text).substr(begin, blocks[layer.end_block - 1].end - begin);
  }

  // Of the layer that block number `block` is in. O(log n) in the layers.
  size_t LayerOf(size_t block) const;

  // The height of a layer in mm.
  double HeightMm(const gcode::Layer& layer) const {
    return gcode::ToDouble(layer.z) * modes[blocks[layer.first_block].mode].UnitMm();
  }

  // The name, and the number of the line, from 1, that holds the byte at `offset`:
  // "part.gcode:118".
  std::string Place(gcode::Offset offset) const;
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_GCODE_FILE_H_
