#include "client/gcode/write/path_writer.h"

#include <string>
#include <string_view>

#include "client/gcode/model/outline.h"

namespace traverse::gcode {
namespace {

// I and J, or R, of an arc.
std::string ArcWords(const BodySegment& segment, NumberStyle style) {
  std::string words;
  const auto add = [&words, style](char letter, Decimal value) {
    words.push_back(' ');
    words.push_back(letter);
    AppendDecimal(value, style, words);
  };
  if (segment.command < 2) return words;
  if (segment.by_radius) {
    add('R', segment.radius);
  } else {
    add('I', segment.center_i);
    add('J', segment.center_j);
  }
  return words;
}

void WriteSegment(const BodySegment& segment, const PathBody& body, GcodeOut& out) {
  static constexpr std::string_view kCommands[] = {"G1", "G1", "G2", "G3"};
  out.Set(body.states[segment.state], kAllSlots);
  out.Segment(kCommands[segment.command], segment.to, true, segment.filament, segment.feed,
              ArcWords(segment, out.file().xy_style), segment.comment);
}

}  // namespace

void WritePath(const PlacedPath& path, GcodeOut& out) {
  if (path.as_given()) {
    const GcodeFile& file = out.file();
    const Block& block = path.block();
    const PartStart start{StateAt(file, block), file.states[block.state_in]};
    const bool has_progress = (block.flags & kBlockProgress) != 0;
    return out.Copy({block.begin, block.end, start, StartBehind(file, block), has_progress});
  }
  const Position* at = &path.first();
  const auto travel = [&at, &out](const Position& to) {
    if (!to.SameXy(*at)) out.Segment("G1", to, false, 0, out.at.machine.feed);
  };
  for (const BodySegment& segment : path.body().segments) {
    travel(segment.from);  // the gap of a loop that ends short of its start
    WriteSegment(segment, path.body(), out);
    at = &segment.to;
  }
  travel(path.last());
}

}  // namespace traverse::gcode
