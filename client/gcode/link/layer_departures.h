// How the paths of a layer are left: what the head does behind each of them in the file before it
// goes on to the next one, for the same path begun or turned otherwise too.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LAYER_DEPARTURES_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LAYER_DEPARTURES_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/model/visible_walls.h"

namespace traverse::gcode {

struct Departure {
  double mm = 0;
  Point as_given;      // where that ends after the path as sliced
  bool wipes = false;  // pulls filament back meanwhile; else continues along the path

  // Where a short move away from the path as sliced leads, before it wipes or as all that it does
  // (`departs`). In the latter case it is made only if what follows retracts, or does not, as in
  // the file.
  std::optional<Point> departs_to;
  bool turns = false;  // that move comes before anything else, and is made behind any start
  bool departs = false;
  bool retracts = false;
};

class LayerDepartures {
 public:
  // All outlive the departures.
  LayerDepartures(const GcodeFile& file, const Layer& layer, const LinkDonors& donors,
                  const std::vector<Outline>& outlines, const VisibleWalls& walls);

  // Where `path` begins and ends.
  Point Begin(const Placement& path) const;
  Point End(const Placement& path) const;

  // Null if the travel begins at the end of the path. `wipes`: if the file wipes the path, so does
  // the travel.
  const Departure* Of(const Placement& from, bool wipes = true) const;

  // Where the short move away from `from` leads. Nothing if there is none, as behind turned lines.
  std::optional<Point> ShortMove(const Placement& from) const;

  // Where the head is after `departure` from `from`.
  Point Behind(const Placement& from, const Departure& departure) const;

  // Where the head is when it leaves `from` on a move that pulls nothing back: behind what
  // continues along the path.
  Point Open(const Placement& from) const;

  // Where the head is behind what stays byte by byte before block `block`, if anything does: the
  // travel to a path there begins at that point, whatever is printed before.
  std::optional<Point> BehindFixed(uint32_t block) const;

 private:
  void Note(uint32_t block);

  // The position of the head `mm` after the end of `from`, on the way back along the path.
  // REQUIRES: it is not as given.
  Point BackOver(const Placement& from, double mm) const;

  const GcodeFile& file_;
  const LinkDonors& donors_;
  const uint32_t first_block_;
  const std::vector<Outline>& outlines_;
  const VisibleWalls& walls_;
  absl::flat_hash_map<uint32_t, Departure> departures_;  // by block, if there is one
  absl::flat_hash_map<uint32_t, Point> behind_fixed_;    // by block, where something stays
  absl::flat_hash_map<uint32_t, LoopGap> gaps_;          // by block, of loops that end short
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LAYER_DEPARTURES_H_
