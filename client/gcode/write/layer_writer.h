// Writes one layer with its paths in a new order.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_LAYER_WRITER_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_LAYER_WRITER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/link/link.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/plan/head_room.h"
#include "client/gcode/plan/joints.h"
#include "client/gcode/plan/travel_model.h"
#include "client/gcode/plan/travel_rules.h"
#include "client/gcode/write/gcode_out.h"
#include "client/gcode/write/travel_totals.h"

namespace traverse::gcode {

// The state where the paths of an order begin, set as its first path needs it. The extruder's
// register is as in the file.
PartStart StartOfPaths(const GcodeFile& file, const Placement& first);

// One layer. What writes appends to `text` and returns the machine's state after it. Thread-safe.
class LayerWriter {
 public:
  // All outlive the writer. `room`: what the head needs in the layer; null: nothing is in the way.
  // Unless `hides`, what is hidden retracts too. `travel`: of the layer, by which hidden moves make
  // detours; null: they make none.
  LayerWriter(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
              const LinkDonors& donors, const Room* room = nullptr, bool hides = true,
              const TravelModel* travel = nullptr);
  LayerWriter(const GcodeFile&, const Layer&, RetractionHabit&&, const LinkDonors&,
              const Room* = nullptr, bool = true, const TravelModel* = nullptr) = delete;

  const VisibleWalls& walls() const { return walls_; }
  const Room* room() const { return room_; }
  const std::vector<Outline>& outlines() const { return outlines_; }
  bool hides() const { return hides_; }

  // The file's own order.
  LayerOrder GivenOrder() const;

  // [place of `order`] the place in the file of what stands before the path here: its own place,
  // but where whole objects have changed places. What stands between two objects stays between
  // two, and what stands within one goes with it.
  std::vector<uint32_t> PlacesOf(const LayerOrder& order) const;

  // Writes the travel to the path `first` from `before`, the last path of the layer before, with
  // the marks of the new layer. `start` is the state of the machine after `before`.
  PartStart WriteTravel(const Placement& before, const Placement& first, const PartStart& start,
                        std::string& text) const;

  // Writes the paths in `order` and the travel between them. `start` is the state at the first.
  // `as_sliced`: where that is the file's own order, what is hidden retracts as it did. `ends`, if
  // not null, gets for each place the size of `text` behind the path there, unless the text is that
  // of the file.
  PartStart WritePaths(const LayerOrder& order, const PartStart& start, std::string& text,
                       std::vector<size_t>* ends = nullptr, bool as_sliced = false) const;

  // Whether the file's own order is written otherwise than it is in the file.
  bool ChangesGiven() const;

  // The same without lines of progress, unless the order is the file's: as it is measured. Adds
  // to `marks`, unless that is null, where in `text` each path begins and ends.
  PartStart WriteBarePaths(const LayerOrder& order, const PartStart& start, std::string& text,
                           std::vector<size_t>* marks = nullptr, bool as_sliced = false) const;

  // Estimates the travel to place `place` of the file's layer, from 1, if `to` follows `from`
  // there, with the crossings and the retraction that would be written.
  TravelTotals EstimateTravel(size_t place, const Placement& from, const Placement& to,
                              const TravelModel& model) const;

 private:
  Vertex Begin(const Placement& placement) const;
  Vertex End(const Placement& placement) const;

  // What the head does after a path before it leaves for the next one.
  struct Leaving {
    double mm = 0;
    Vertex as_given;      // where that ends after the path as sliced
    bool wipes = false;   // pulls filament back meanwhile; else continues along the path
    bool stands = false;  // and before, at a standstill

    // Where a short move away from the path as sliced leads, before it wipes or as all that it does
    // (`departs`). In the latter case it is made only if what follows retracts, or does not, as in
    // the file.
    std::optional<Vertex> departs_to;
    bool turns = false;  // that move comes before anything else, and is made behind any start
    bool departs = false;
    bool retracts = false;
  };

  // Null if the travel begins at the end of the path. `wipes`: if the file wipes the path, so does
  // the travel.
  const Leaving* LeavingOf(const Placement& from, bool wipes = true) const;

  // Where the short move away from `from` leads. Nothing if there is none, as behind turned lines.
  std::optional<Vertex> DepartsTo(const Placement& from) const;

  // Where the head is after `leaving`.
  Vertex Behind(const Placement& from, const Leaving& leaving) const;

  // Whether the travel from `from` to `to`, where a path of `feature` begins, begins with the
  // file's wipe. `boundary`: the file has something on that travel that nothing may cross.
  bool Wipes(const Placement& from, Vertex to, Feature feature, bool boundary) const;

  // The position of the head `mm` after the end of `from`, on the way back along the path.
  Vertex BackOver(const Placement& from, double mm) const;

  void NoteLeaving(uint32_t block);

  // Where the head is behind what stays byte by byte before block `block`, if anything does: the
  // travel to a path there begins at that point, whatever is printed before.
  std::optional<Vertex> BehindFixed(uint32_t block) const;

  // Whether travel from `from` to `to` that the file does not have begins with the short move that
  // leads away from `from` in the file. It does not where nothing is retracted and that move would
  // put a visible wall between the nozzle and `to`.
  bool Departs(const Placement& from, Vertex to, Feature feature) const;

  // The travel from `from` to `to` that the file does not have, with what happens after `from`. Of
  // a wipe only the length counts, because it is the same wherever the travel leads.
  PlannedTravel NewTravel(const Placement& from, const Placement& to, bool wipes) const;

  // Where the head is when it leaves `from` on a move that pulls nothing back: behind what
  // continues along the path.
  Vertex LeavesFrom(const Placement& from) const;

  // Whether that move to `to` is hidden if it goes straight. No move at a boundary is.
  bool Hides(const Placement& from, const Placement& to, bool boundary) const;

  // The bends of that move if it is hidden, none if it goes straight. Nothing if it is seen, or if
  // to retract takes less time than to bend. Orders are estimated without bends: what these gain
  // comes on top, and a search that counted on them found no faster orders.
  std::optional<std::vector<Vertex>> HiddenBends(const Placement& from, const Placement& to,
                                                 bool boundary) const;

  // EstimateTravel of a hidden move.
  TravelTotals HiddenTravel(const Placement& from, const Placement& to,
                            const TravelModel& model) const;

  // Where travel from `from` to `to` joins them. What happens after `from`, except for a short move
  // away from it, ends with a stop.
  TravelJoints JointsOf(const Placement& from, const Placement& to, bool wipes) const;

  // What the retraction of the travel of `mm` from `from` to `to` takes beside the travel. `stays`:
  // the travel is the file's; `wipes`: it wipes `from`.
  double RetractionSeconds(const Placement& from, const Placement& to, double mm, bool stays,
                           bool wipes, const TravelModel& model) const;

  // True if continuing after the end of `from` puts a visible wall between the nozzle and `to`,
  // which must be avoided.
  bool GoesOnAcross(const Placement& from, Vertex to, Feature feature) const;
  bool IsGiven(const LayerOrder& order) const;

  // The text of the layer is that of the file.
  bool StaysAsText(const LayerOrder& order, const PartStart& start, bool as_sliced) const;
  void WriteLink(const PlacedPath& from, const PlacedPath& to, uint32_t place, bool as_sliced,
                 bool moved, GcodeOut& out) const;
  bool Retracts(const PlacedPath& from, const PlacedPath& to) const;

  // Something is in the way, at the height of the layer or, if it retracts, of the layer's lifts.
  bool IsBlocked(const PlannedTravel& travel) const;
  double LeastLiftMm() const;

  const GcodeFile& file_;
  const Layer& layer_;
  const LinkDonors& donors_;
  const Room* const room_;
  const double
      lift_mm_;  // the least of the layer's retracted travel; 0 where nothing is in the way
  const std::vector<Outline> outlines_;
  const VisibleWalls walls_;
  const TravelRules rules_;
  const LayerJoints joints_;
  const bool spares_walls_;
  const bool drops_wipes_;
  const bool hides_;
  const TravelModel* const travel_;
  absl::flat_hash_map<uint32_t, Leaving> leaving_;      // by block, if it is left this way
  absl::flat_hash_map<uint32_t, Vertex> behind_fixed_;  // by block, where something stays
  absl::flat_hash_map<uint32_t, LoopGap> gaps_;         // by block, of loops that end short
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_LAYER_WRITER_H_
