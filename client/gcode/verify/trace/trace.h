// A print as the rules see it: paths, what stands between them, sections and layers.
//
//   layer    | section            | section | ...
//   path     link path link path    link path
//   segment       |||||     ||||         ||||
//
// A path is a run of deposits without any other move between them. Link i has the moves and
// commands before path i; the last link of a chunk follows its last path, and is also the first
// link of the next chunk. A section ends at a line whose position matters (sections.h). A layer is
// a run of sections at one height, within one mark of the slicer.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_TRACE_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_TRACE_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "client/gcode/verify/machine/verify_machine.h"
#include "client/gcode/verify/trace/path_class.h"
#include "engine/model/point.h"

namespace traverse::gcode {

struct TraceSegment {
  uint64_t digest = 0;      // of a deposit: VerifyLine
  uint64_t conditions = 0;  // the same
  Point end;
  double filament_mm = 0;
  uint32_t line = 0;
  int32_t arc = -1;  // index in TraceChunk::arcs
};

// Of words that are `unit` each.
inline Point PointOf(const std::array<Micro, 3>& at, double unit) {
  return {static_cast<double>(at[0]) * unit, static_cast<double>(at[1]) * unit};
}

struct TraceArc {
  Point center;
  bool clockwise = false;
};

// That of `motion`, in words that are `unit` each. With a positive radius it takes the short way
// round: the center then lies on the right of the chord where it turns clockwise.
TraceArc ArcOf(const Motion& motion, double unit);

// The way along an arc from one point to another, once round if they are one.
class ArcWay {
 public:
  ArcWay(Point from, Point to, const TraceArc& arc);

  double radius() const { return radius_; }
  double angle() const { return std::abs(turn_); }  // in radians

  // Behind `k` of `n` equal parts.
  Point At(int k, int n) const;

 private:
  Point center_;
  double radius_;
  double begin_;
  double turn_;  // in radians, to the left
};

struct TracePath {
  uint32_t first_segment = 0;
  uint32_t end_segment = 0;
  Point start;
  double z_mm = 0;
  float length_mm = 0;
  float filament_mm = 0;
  double begun_seconds = 0;   // since the file began: clock.h
  double left_seconds = 0;    // when it ends
  Micro feed = 0;             // of its last segment
  uint64_t fan = 0;           // PrintSettings::fan at its first segment
  uint64_t acceleration = 0;  // PrintSettings::PathAccelerationDigest there
  bool states_fan = false;    // a fan is set before it, behind the path before
  PathClass path_class = PathClass::kUnnamed;
  bool overhangs = false;  // part of it is of class kOverhang
  bool outer = false;      // part of it is of class kOuterWall
  bool inner = false;      // part of it is of class kInnerWall
  bool joined = false;     // begins where the path before it ends, without a move in between
  uint32_t size() const { return end_segment - first_segment; }
};

// What was pulled back may be returned with what rounding makes of it, piece by piece; some slicers
// prime with next to nothing.
inline constexpr Micro kPrimeRounding = 1'000;

// Heights no farther apart are one, but for arithmetic.
inline constexpr double kOneHeightMm = 1e-4;

enum class MoveKind : uint8_t {
  kTravel,  // sideways, no filament
  kWipe,    // sideways, retracting
  kUp,
  kDown,
  kRetraction,  // retracting at a standstill
  kPriming,     // filament pushed at a standstill
  kDwell,       // waiting behind one of these two; its speed is how long
  kCount,
};

std::string_view MoveKindName(MoveKind kind);

struct TraceMove {
  uint64_t identity = 0;      // from, to, filament, speed, acceleration
  uint64_t acceleration = 0;  // PrintSettings::AccelerationDigest
  uint64_t tool = 0;
  Point from;
  Point to;
  Point middle;  // of an arc, halfway along it
  double z_from_mm = 0;
  double z_to_mm = 0;
  uint64_t spiral = 0;  // of an arc that rises: its direction, center from where it begins, turns
  Micro filament = 0;
  Micro feed = 0;
  uint32_t line = 0;
  uint32_t section = 0;
  MoveKind kind = MoveKind::kTravel;
  bool open = true;       // the nozzle, when it begins
  bool firmware = false;  // G10, G11
  bool states_z = false;  // has a Z word
  bool arc = false;
  bool in_print = false;  // not in the start script
  bool rounding = false;  // a segment whose extrusion was rounded to nothing

  bool sideways() const { return kind == MoveKind::kTravel || kind == MoveKind::kWipe; }
  double length_mm() const;

  // A feed rate alone, or what rounding left: nothing is moved by `least_mm` or farther, nor waited
  // for.
  bool IsNothing(double least_mm) const;
};

struct TraceLink {
  uint32_t first_move = 0;
  uint32_t end_move = 0;
  bool new_layer = false;  // it contains a mark of a layer or a change of height
  bool scripted = false;   // it contains unknown lines
  bool first = false;      // of the print: it comes from nowhere, or from the start script
  uint32_t fixed = 0;      // so many of its moves stand before the last of these
};

// A command within a path, before segment `segment`.
struct TraceCommand {
  uint64_t name = 0;
  uint32_t segment = 0;
  uint32_t line = 0;
};

// Filament pushed beyond what had been retracted, or short of it, by moves of the extruder alone.
struct Standstill {
  uint32_t section = 0;
  uint32_t line = 0;
  uint64_t tool = 0;
  Micro amount = 0;
  bool fresh = false;  // nothing had been retracted
  Point at;
};

// What is of no use in a file, or wrong with the marks at the begin and end of a wipe.
enum class LineFaultKind : uint8_t {
  kSetsBack,  // a setting returns to its value at the last move
  kUnmarked,  // a wipe without marks
  kBeginsTwice,
  kEndsTwice,
  kEmpty,    // nothing moves between the marks
  kDeposit,  // something is printed between the marks
};

struct LineFault {
  uint32_t section = 0;
  uint32_t line = 0;
  LineFaultKind kind = LineFaultKind::kUnmarked;
};

struct TraceSection {
  uint32_t index = 0;  // from the beginning of the file
  uint32_t first_path = 0;
  uint32_t end_path = 0;
};

struct TraceLayer {
  uint32_t index = 0;  // from the beginning of the file
  uint32_t first_section = 0;
  uint32_t end_section = 0;  // in TraceChunk::sections, those with paths
};

// A line that states the progress of the print.
struct Progress {
  uint64_t digest = 0;
  uint32_t line = 0;
  uint32_t section = 0;
  double percent = -1;  // of the print that it states as done; less than 0: none
  double seconds = 0;   // since the file began: clock.h

  // Where such a line may stand: where the deposits before it and behind it begin and end.
  std::array<double, 4> places{};
};

struct SectionBegin {
  uint32_t section = 0;
  double seconds = 0;
};

struct TraceChunk {
  std::vector<TraceSegment> segments;
  std::vector<TraceArc> arcs;
  std::vector<TracePath> paths;
  std::vector<TraceLink> links;  // one more than paths
  std::vector<TraceMove> moves;
  std::vector<uint64_t> accelerations;  // of deposits, some of them more than once
  std::vector<TraceCommand> commands;   // by segment
  std::vector<Standstill> standstills;  // by line
  std::vector<LineFault> line_faults;   // by line
  std::vector<Progress> progress;       // lines that tell it
  std::vector<SectionBegin> begins;     // of all sections, ascending
  std::vector<TraceSection> sections;
  std::vector<TraceLayer> layers;
  uint32_t end_section = 0;  // index of the section behind the last one that is whole
  double seconds = 0;        // since the file began, up to where the chunk ends: clock.h

  Point StartOf(const TracePath& path, uint32_t segment) const {
    return segment == path.first_segment ? path.start : segments[segment - 1].end;
  }
  Point EndOf(const TracePath& path) const { return segments[path.end_segment - 1].end; }
  uint32_t LineOf(const TracePath& path) const { return segments[path.first_segment].line; }
  uint32_t LineOf(uint32_t path) const { return LineOf(paths[path]); }

  absl::Span<const TraceSegment> SegmentsOf(const TraceSection& section) const {
    const uint32_t first = paths[section.first_path].first_segment;
    return absl::MakeConstSpan(segments).subspan(first,
                                                 paths[section.end_path - 1].end_segment - first);
  }

  // The moves of links `first` to `end` - 1.
  absl::Span<const TraceMove> MovesOfLinks(uint32_t first, uint32_t end) const {
    return absl::MakeConstSpan(moves)
        .first(links[end - 1].end_move)
        .subspan(links[first].first_move);
  }

  // Those of one link, without its first `skipped` ones. REQUIRES: it has as many.
  absl::Span<const TraceMove> MovesOf(uint32_t link, uint32_t skipped = 0) const {
    return MovesOfLinks(link, link + 1).subspan(skipped);
  }

  // What follows the last path.
  absl::Span<const TraceMove> MovesOfLast() const {
    return MovesOf(static_cast<uint32_t>(paths.size()));
  }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_TRACE_H_
