// Writes one layer with its paths in a new order.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_LAYER_WRITER_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_LAYER_WRITER_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "client/gcode/link/layer_links.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/link/link_parts.h"
#include "client/gcode/link/travel_totals.h"
#include "client/gcode/model/part_start.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/plan/head_room.h"
#include "client/gcode/plan/travel_model.h"
#include "client/gcode/plan/travel_rules.h"
#include "client/gcode/write/gcode_out.h"

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

  const GcodeFile& file() const { return file_; }
  const VisibleWalls& walls() const { return links_.walls(); }
  const Room* room() const { return links_.room(); }
  const std::vector<Outline>& outlines() const { return links_.outlines(); }
  bool hides() const { return links_.hides(); }

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
  bool ChangesGiven() const { return links_.ChangesGiven(); }

  // The same without lines of progress, unless the order is the file's: as it is measured. Adds
  // to `marks`, unless that is null, where in `text` each path begins and ends.
  PartStart WriteBarePaths(const LayerOrder& order, const PartStart& start, std::string& text,
                           std::vector<size_t>* marks = nullptr, bool as_sliced = false) const;

  // See LayerLinks.
  TravelTotals EstimateTravel(size_t place, const Placement& from, const Placement& to,
                              LinkParts& parts, Hiding hiding = Hiding::kStraight) const {
    return links_.EstimateTravel(place, from, to, parts, hiding);
  }

  // The same, asked once.
  TravelTotals EstimateTravel(size_t place, const Placement& from, const Placement& to) const {
    LinkParts parts(file_);
    return EstimateTravel(place, from, to, parts);
  }

 private:
  bool IsGiven(const LayerOrder& order) const;

  // Whether objects stand at other places than in the file.
  bool MovesObjects(const LayerOrder& order, const std::vector<uint32_t>& places) const;

  // The text of the layer is that of the file.
  bool StaysAsText(const LayerOrder& order, const PartStart& start, bool as_sliced) const;
  void WriteLink(const PlacedPath& from, const PlacedPath& to, uint32_t place, bool as_sliced,
                 bool moved, LinkParts& parts, GcodeOut& out) const;

  const GcodeFile& file_;
  const Layer& layer_;
  const LinkDonors& donors_;
  const LayerLinks links_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_LAYER_WRITER_H_
