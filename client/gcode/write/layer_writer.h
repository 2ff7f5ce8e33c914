// Writes one layer with its paths in a new order.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_LAYER_WRITER_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_LAYER_WRITER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/plan/travel_model.h"
#include "client/gcode/plan/travel_rules.h"
#include "client/gcode/write/gcode_out.h"
#include "client/gcode/write/link.h"
#include "client/gcode/write/link_donors.h"
#include "client/gcode/write/placed_path.h"
#include "client/gcode/write/way_totals.h"

namespace traverse::gcode {

// Where the paths of an order begin, with everything set as its first path needs it. The extruder's
// register is as it is there in the file.
PartStart StartOfPaths(const GcodeFile& file, const Placement& first);

// Behind `last`; the same holds for the extruder's register.
PartStart StartBehindPath(const GcodeFile& file, const Placement& last);

// One layer. What writes appends to `text` and returns the machine behind that. Thread-safe.
class LayerWriter {
 public:
  // `file`, `habit` and `donors` outlive the writer.
  LayerWriter(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
              const LinkDonors& donors);

  const VisibleWalls& walls() const { return walls_; }
  const std::vector<Outline>& outlines() const { return outlines_; }

  // The order of the file.
  LayerOrder GivenOrder() const;

  // The way to the path `first` from `before`, the last path of the layer before, with the marks of
  // the new layer. `start` is the machine behind `before`.
  PartStart WriteWay(const Placement& before, const Placement& first, const PartStart& start,
                     std::string& text) const;

  // The paths in `order` and the ways between them. `start` is the machine where the first begins.
  PartStart WritePaths(const LayerOrder& order, const PartStart& start, std::string& text) const;

  // About what the way to place `place` of the layer, from 1, comes to if `to` follows `from`
  // there. Walls are crossed, and filament is pulled back, as it is written.
  WayTotals EstimateWay(size_t place, const Placement& from, const Placement& to,
                        const TravelModel& model) const;

 private:
  Vertex Begin(const Placement& placement) const;
  Vertex End(const Placement& placement) const;

  // What the head does behind a path before it leaves for the next one.
  struct Leaving {
    double mm = 0;
    Vertex as_given;     // where that ends behind the path as it is given
    bool wipes = false;  // filament is pulled back meanwhile; else it goes on along the path
  };

  // Nothing where the way begins at the end of the path.
  const Leaving* LeavingOf(const Placement& from) const;

  // Where the head is `mm` behind the end of `from`, on the way over what was just printed.
  Vertex BackOver(const Placement& from, double mm) const;

  void NoteLeaving(uint32_t block);

  // The way from `from` to `to` where the file has none, with what is done behind `from`; a wipe
  // counts for its length alone, for it is the same wherever the way leads.
  TravelWay NewWay(const Placement& from, const Placement& to) const;

  // The way that goes on behind the end of `from` leads the nozzle to where a visible wall is
  // between it and `to`, which has to be spared.
  bool GoesOnAcross(const Placement& from, Vertex to, Feature feature) const;
  bool IsGiven(const LayerOrder& order, const PartStart& start) const;
  void WriteLink(const PlacedPath& from, const PlacedPath& to, uint32_t place, GcodeOut& out) const;
  bool Retracts(const PlacedPath& from, const PlacedPath& to) const;

  const GcodeFile& file_;
  const Layer& layer_;
  const LinkDonors& donors_;
  const std::vector<Outline> outlines_;
  const VisibleWalls walls_;
  const TravelRules rules_;
  const bool spares_walls_;
  absl::flat_hash_map<uint32_t, Leaving> leaving_;  // behind blocks that are left so
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_LAYER_WRITER_H_
