// What a link does, decided before it is composed.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LINK_FORM_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LINK_FORM_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "client/gcode/plan/detour.h"

namespace traverse::gcode {

struct LinkForm {
  // The travel must retract.
  bool retracts = false;

  // The file wipes after the path before.
  bool wipes = false;

  // New travel may begin with the short move away from that path with which the file's does.
  bool departs = true;

  // The path before begins elsewhere than in the file: where its departure leads now, in mm, if it
  // is made.
  std::optional<Vertex> turned_departure;

  // The link with the marks of a boundary (a new layer, an object) that is due here; all its lines
  // are written. In the file it stands before block `boundary`.
  std::optional<uint32_t> boundary;

  // Detours around visible walls, if travel makes them; null: travel is straight.
  const Detours* detours = nullptr;

  // Nobody sees the travel: it goes straight, or by these bends, without a retraction, a lift and a
  // wipe.
  bool hidden = false;
  std::vector<Vertex> hidden_bends = {};

  // Leave out lines of progress of what is copied unchanged.
  bool without_progress = false;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LINK_FORM_H_
