// The links of one layer: what each of them does where two paths follow one another, decided once
// for those who write it and those who ask what it takes.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LAYER_LINKS_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LAYER_LINKS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/gcode/link/layer_departures.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/link/link_form.h"
#include "client/gcode/link/link_parts.h"
#include "client/gcode/link/travel_totals.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/model/visible_walls.h"
#include "client/gcode/plan/head_room.h"
#include "client/gcode/plan/travel_model.h"
#include "client/gcode/plan/travel_rules.h"

namespace traverse::gcode {

// What becomes of retracted moves that nobody sees.
enum class Hiding : uint8_t {
  kNone,      // they stay
  kStraight,  // those that are hidden as they lead do without
  kBent,      // also those that bends hide, where that takes less time
};

// Thread-safe.
class LayerLinks {
 public:
  // All outlive the links; see LayerWriter.
  LayerLinks(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
             const LinkDonors& donors, const Room* room, bool hides, const TravelModel* travel);

  const VisibleWalls& walls() const { return walls_; }
  const Room* room() const { return room_; }
  const std::vector<Outline>& outlines() const { return outlines_; }
  bool hides() const { return hides_; }

  // The link from `from`, which ends at `end`, to `to` where the file has the one before block
  // `place`. `from` may be of the layer before.
  LinkForm FormOf(const Placement& from, Point end, const Placement& to, uint32_t place) const;

  // Leaves out of `form`, which links `from` and `to`, what is for those who see it, if nobody
  // does.
  void Hide(const Placement& from, const Placement& to, Hiding hiding, LinkForm& form) const;

  // Whether the file's own order is written otherwise than it is in the file.
  bool ChangesGiven() const;

  // The travel to place `place` of the file's layer, from 1, if `to` follows `from` there. Orders
  // are searched for without bends: a search that counted on them found no faster ones.
  TravelTotals EstimateTravel(size_t place, const Placement& from, const Placement& to,
                              LinkParts& parts, Hiding hiding = Hiding::kStraight) const;

 private:
  Feature FeatureOf(const Placement& path) const {
    return outlines_[path.block - layer_.first_block].feature;
  }

  // Where the travel leads that `from`, which ends at `end`, and the way it is left leave to do,
  // and what comes ahead of it.
  void DecideTravel(const Placement& from, Point end, const Placement& to, uint32_t place,
                    LinkForm& form) const;

  // Whether travel that the file does not have begins with the short move that leads away from
  // `from` in the file. It does not where nothing is retracted and that move would put a visible
  // wall between the nozzle and the next path. `straight`: the travel without that move; `behind`:
  // the travel after it.
  bool Departs(const Placement& from, const Departure& departure, const PlannedTravel& straight,
               const PlannedTravel& behind) const;

  // The bends by which the move that leads openly from `from` to `to` is hidden in less time than a
  // retraction takes; none if there are none.
  std::vector<Point> HiddenBends(const Placement& from, const Placement& to) const;

  // The travel of a hidden move.
  PlannedTravel OpenTravel(const Placement& from, const Placement& to) const;

  // What the link takes as it is composed (LinkSeconds), and what `to` takes longer alone than as
  // it is in the file.
  double SecondsOf(const Placement& from, const Placement& to, const LinkForm& form,
                   LinkParts& parts) const;

  // Something is in the way, at the height of the layer or, if it retracts, of the layer's lifts.
  bool IsBlocked(const PlannedTravel& travel) const;
  double LeastLiftMm() const;

  const GcodeFile& file_;
  const Layer& layer_;
  const LinkDonors& donors_;
  const RetractionHabit& habit_;
  const Room* const room_;
  const double
      lift_mm_;  // the least of the layer's retracted travel; 0 where nothing is in the way
  const std::vector<Outline> outlines_;
  const VisibleWalls walls_;
  const TravelRules rules_;
  const LayerDepartures departures_;
  const bool hides_;
  const TravelModel* const travel_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LAYER_LINKS_H_
