// Writes the travel from one path to the next, if it is not the travel that the file has there.
//
// Nothing is invented: every such link follows one of the file's own, its template.
//
//   M204 S1000 | short move in, pull back, wipe, up | travel | down, prime | M204 S800, ;TYPE:
//   `--------'   `-------------------------------'    `----'   `---------'   `---------------'
//   state of     departure: from what was printed     to the   arrival:      state of the path
//   the travel   before, where its own link has one   path     as it is
//
// The template is the link that leads to the path in the file, if it retracts or not as needed, and
// lifts where others there do; otherwise the nearest link of that kind (link_donors.h). Its lift is
// written as a height above what is printed here, in the form that it has: a move of Z before the
// travel, a spiral, or a slope over the first stretch of the travel.

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

  // The travel must retract.
  bool retract = false;

  // The link with the marks of a boundary (a new layer, an object) that is due here; all its lines
  // are written. In the file it stands before block `boundary`.
  std::optional<uint32_t> boundary;

  // Detours around visible walls, if travel makes them; null: travel is straight.
  const Detours* detours = nullptr;

  // Nobody sees the travel: it goes straight, or by these bends, without a retraction, a lift and a
  // wipe.
  bool hidden = false;
  std::vector<Vertex> hidden_bends = {};

  // The file wipes after `from`.
  bool wipe = false;

  // New travel may begin with the short move away from `from` with which the file's does.
  bool departs = true;

  // `from` is begun elsewhere than in the file: where its departure leads now, in mm, if it is
  // made.
  std::optional<Vertex> turned_departure;

  // Leave out lines of progress of what is copied unchanged.
  bool without_progress = false;
};

class LinkWriter {
 public:
  LinkWriter(const GcodeFile& file, const LinkDonors& donors, GcodeOut& out)
      : file_(file), donors_(donors), out_(out) {}

  // Appends the link, up to where `to` begins, with its state and feed rate set. The output ends
  // after `from`. Also appends the lines without meaning here that stand before `to` in the file.
  void Write(const LinkRequest& request);

 private:
  void WriteGiven(const LinkRequest& request);
  void WriteBoundary(const LinkRequest& request);
  void WriteBoundaryStep(const LinkRequest& request, const Link& link, size_t i);
  void WriteTravelToBoundary(const LinkRequest& request, const Link& link, bool given_from);
  void WritePlain(const LinkRequest& request);
  void SetTravelState(const PlacedPath& to, const Link& form);
  Link TemplateFor(const LinkRequest& request) const;
  Link HiddenTemplateFor(const LinkRequest& request) const;
  std::optional<Link> OwnDeparture(const LinkRequest& request, const Link& form) const;
  Link WriteDeparture(const LinkRequest& request, const Link& form);
  void WriteOwnDeparture(const LinkRequest& request);
  void WriteArrival(const LinkRequest& request, const Link& form);
  void WriteGoingOn(const LinkRequest& request);
  void WriteWipe(const PlacedPath& path, const Link& form);
  void WriteMotion(const LinkStep& step, Decimal z_form, Decimal z_here);
  std::vector<Position> TravelTo(const LinkRequest& request) const;
  void WriteTravel(const LinkRequest& request, const Link& form, Decimal top, const Link& rise);
  void WriteComments(uint32_t block);
  void Settle(const LinkRequest& request, const Link& form);

  const GcodeFile& file_;
  const LinkDonors& donors_;
  GcodeOut& out_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_LINK_WRITER_H_
