// Writes the way from one path to the next, where it is not the way that the file has.
//
// Nothing is made up: every such link follows one of the file's own, its template.
//
//   M204 S1000 | short move in, pull back, wipe, up | travel | down, prime | M204 S800, ;TYPE:
//   `--------'   `-------------------------------'    `----'   `---------'   `---------------'
//   state of     departure: from what was printed     to the   arrival:      state of the path
//   the travel   before, where its own link has one   path     as it is
//
// The template is the link that leads to the path in the file, if it retracts or not as is needed,
// and lifts where others there do; else the nearest one of that kind (link_donors.h). What it lifts
// is written as a height above what is printed here, in the form that it has: a move of Z before
// the way, a spiral, or a slope over the first stretch of the way.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_LINK_WRITER_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_LINK_WRITER_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "client/gcode/plan/detour.h"
#include "client/gcode/write/gcode_out.h"
#include "client/gcode/write/link.h"
#include "client/gcode/write/link_donors.h"
#include "client/gcode/write/placed_path.h"

namespace traverse::gcode {

// One link to write.
struct LinkRequest {
  const PlacedPath* from = nullptr;
  const PlacedPath* to = nullptr;

  // Filament has to be pulled back for the way.
  bool retract = false;

  // The link with the marks of a boundary (a new layer, an object) that is due here; all its lines
  // are written. It stands before block `boundary` in the file.
  std::optional<uint32_t> boundary;

  // Travel is led around visible walls, where there is such a way; null: it is straight.
  const Detours* detours = nullptr;

  // The file wipes behind `from`.
  bool wipe = false;

  // M73 lines are left out of what is copied as it is.
  bool without_progress = false;
};

class LinkWriter {
 public:
  LinkWriter(const GcodeFile& file, const LinkDonors& donors, GcodeOut& out)
      : file_(file), donors_(donors), out_(out) {}

  // Appends the link, up to where `to` begins, its state and feed rate set. The output is behind
  // `from`. The lines that mean nothing here and stand before `to` in the file come with it.
  void Write(const LinkRequest& request);

 private:
  void WriteGiven(const LinkRequest& request);
  void WriteBoundary(const LinkRequest& request);
  void WriteBoundaryStep(const LinkRequest& request, const Link& link, size_t i);
  void WritePlain(const LinkRequest& request);
  void SetTravelState(const PlacedPath& to, const Link& form);
  Link TemplateFor(const LinkRequest& request) const;
  std::optional<Link> OwnDeparture(const LinkRequest& request, const Link& form) const;
  Link WriteDeparture(const LinkRequest& request, const Link& form);
  void WriteArrival(const LinkRequest& request, const Link& form);
  void WriteGoingOn(const LinkRequest& request);
  void WriteWipe(const PlacedPath& path, const Link& form);
  void WriteMotion(const LinkStep& step, Decimal z_form, Decimal z_here);
  std::vector<Position> WayTo(const LinkRequest& request) const;
  void WriteTravel(const LinkRequest& request, const Link& form, Decimal top, const Link& rise);
  void WriteComments(uint32_t block);
  void Settle(const LinkRequest& request, const Link& form);

  const GcodeFile& file_;
  const LinkDonors& donors_;
  GcodeOut& out_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_LINK_WRITER_H_
