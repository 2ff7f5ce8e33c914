// One path in the form in which it is printed: as given, reversed, or from another start.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_PLACED_PATH_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_PLACED_PATH_H_

#include <cstdint>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/path_body.h"

namespace traverse::gcode {

// A block with its entry: for a closed path the vertex at which it begins; for an open path 0, or 1
// if it is reversed. 0 is always as in the file.
struct Placement {
  uint32_t block = 0;
  uint32_t entry = 0;
  bool closed = false;

  bool as_given() const { return entry == 0; }
  friend bool operator==(const Placement&, const Placement&) = default;
};

// Where a loop ends if it begins elsewhere than in the file: so much before its start.
struct LoopGap {
  double mm = 0;
  std::vector<bool> moves;  // [entry]; where not, the loop ends at its start
};

// The gap of closed path `block`, as PlacedPath moves it. `moves` is empty if there is none.
LoopGap LoopGapOf(const GcodeFile& file, uint32_t block);

// The paths of a layer in the order to print them.
using LayerOrder = std::vector<Placement>;

// Reversed: the same segments from the last to the first, each with its own extrusion, feed rate
// and state; arcs turn the other way; a wiping tail is made at the new end. From another start:
// segments k to the last, then segments 0 to k - 1. If the loop ends short of its start, it does
// so at the new start (seam_gap.h); where it cannot, the head crosses that gap without extrusion.
class PlacedPath {
 public:
  PlacedPath(const GcodeFile& file, const Placement& placement);

  PlacedPath(PlacedPath&&) = default;
  PlacedPath& operator=(PlacedPath&&) = default;

  const Placement& placement() const { return placement_; }
  bool as_given() const { return placement_.as_given(); }
  const Block& block() const { return file_->blocks[placement_.block]; }

  // Where the head must be to begin, and where it is at the end, after the tail.
  const Position& first() const { return first_; }
  const Position& last() const { return last_; }

  // The print state of the first segment, and its feed rate.
  const PrintState& state() const { return *state_; }
  Decimal feed() const { return feed_; }

  // Its first line sets the feed rate itself.
  bool states_feed() const { return states_feed_; }

  // Its segments in the order and direction to print them; the former is of no meaning as given.
  const PathBody& body() const { return body_; }
  PathBody PrintedBody() const;

  // Points back over what was just printed, for a wipe: on from the start of a closed path, back
  // along an open one. At most `length`, in words; at least one point if the path has any
  // length.
  std::vector<Position> Retrace(double length) const;

  // The same for a head at `begin`, which may have left the path: then it returns to it behind the
  // gap of a closed path. At most `length` from `begin` on.
  std::vector<Position> RetraceFrom(const Position& begin, double length) const;

 private:
  void PlaceGiven();
  void PlaceReversed();
  void PlaceRotated();

  // Retrace; `segments` are those of the path as it is placed.
  std::vector<Position> RetraceOver(const std::vector<BodySegment>& segments, double length) const;

  double unit_mm() const { return file_->modes[block().mode].UnitMm(); }

  const GcodeFile* file_;
  Placement placement_;
  Position first_;
  Position last_;
  const PrintState* state_ = nullptr;
  Decimal feed_ = 0;
  bool states_feed_ = false;
  PathBody body_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_PLACED_PATH_H_
