// What a link does, decided before it is composed.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LINK_FORM_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LINK_FORM_H_

#include <cstdint>
#include <optional>
#include <utility>

#include "client/gcode/plan/travel_rules.h"

namespace traverse::gcode {

struct Departure;

struct LinkForm {
  // It is the file's own, as it is there, unless it is hidden.
  bool given = false;

  // How it leads, and what comes ahead of that, if it is made; null: nothing.
  PlannedTravel travel;
  const Departure* departure = nullptr;

  // The travel must retract.
  bool retracts = false;

  // The file wipes after the path before.
  bool wipes = false;

  // New travel may begin with the short move away from that path with which the file's does.
  bool departs = false;

  // The path before begins elsewhere than in the file: where its departure leads now, in mm, if it
  // is made.
  std::optional<Point> turned_departure;

  // The link with the marks of a boundary (a new layer, an object) that is due here; all its lines
  // are written. In the file it stands before block `boundary`.
  std::optional<uint32_t> boundary;

  // Nobody sees the travel: it does without a retraction, a lift and a wipe.
  bool hidden = false;

  // Leave out lines of progress of what is copied unchanged.
  bool without_progress = false;

  // `open`: how it leads then.
  void Hide(PlannedTravel open) {
    hidden = true;
    travel = std::move(open);
    departure = nullptr;
    retracts = wipes = departs = false;
    turned_departure.reset();
  }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LINK_FORM_H_
