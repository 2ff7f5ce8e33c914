// Composes the link from one path to the next, if it is not the one that the file has there.
//
// Nothing is invented: every such link is like one of the file's own.
//
//   M204 S1000 | short move in, pull back, wipe, up | travel | down, prime | M204 S800, ;TYPE:
//   `--------'   `-------------------------------'    `----'   `---------'   `---------------'
//   state of     departure: from what was printed     to the   arrival:      state of the path
//   the travel   before, where its own link has one   path     as it is
//
// It is like the link that leads to the path in the file, if that retracts or not as needed, and
// lifts where others there do; otherwise like the nearest link of that kind (link_donors.h). Its
// lift is a height above what is printed here, in the form that it has: a move of Z before the
// travel, a spiral, or a slope over the first stretch of the travel.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_COMPOSER_H_
#define TRAVERSE_CLIENT_GCODE_LINK_COMPOSER_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "client/gcode/link/link.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/link/link_form.h"
#include "client/gcode/link/link_parts.h"
#include "client/gcode/link/new_link.h"
#include "client/gcode/model/placed_path.h"

namespace traverse::gcode {

// Of one link.
class LinkComposer {
 public:
  // All outlive the composer. The machine is at `at` behind `from`.
  LinkComposer(LinkParts& parts, const LinkDonors& donors, const PlacedPath& from,
               const PlacedPath& to, const LinkForm& form, const MachineState& at)
      : parts_(parts),
        file_(parts.file()),
        donors_(donors),
        from_(from),
        to_(to),
        form_(form),
        link_(at) {}

  // Up to where `to` begins, with its state and feed rate set. Also the lines without meaning here
  // that stand before `to` in the file.
  NewLink Compose() &&;

 private:
  void KeepGiven();
  void ComposePlain();
  void ComposeBoundary();
  void ComposeBoundaryStep(const Link& link, size_t i);
  void TravelToBoundary(const Link& link);
  Decimal HeightBehindTravel(const LinkStep& step, const Link& like) const;

  Link LikeWhat(bool retracts) const;
  Link LikeHidden() const;
  std::optional<Link> OwnDeparture(const Link& like) const;
  PrintState StateOfTravel(const Link& link) const;
  std::shared_ptr<const Link> OwnArrival(const Link& link) const;

  // Whether the link with the marks follows the path before as it is in the file.
  bool LeavesAsGiven() const;

  PrintState TravelStateOf(const Link& like) const;
  Link Depart(const Link& like, const PrintState& travel);
  void DepartAsOwn();
  void GoOn();
  void Wipe(const Link& like);
  std::vector<Position> BendsToNext() const;
  void TravelAs(const Link& like, Decimal top, const Link& rise);
  void Arrive(const Link& like);
  LinkStep Balanced(LinkStep step, const Link& like) const;
  void AddOwn(std::initializer_list<StepKind> kinds);
  void Settle(const Link& like);

  // The line of `step` where the head stands; the latter if it is of no travel, mark or setting.
  void Stay(const LinkStep& step) { link_.Edited(step, file_, link_.at()); }
  void StayIfStill(const LinkStep& step);

  // The line of `step`, to where it leads in the file, at the height of the head.
  void Follow(const LinkStep& step);

  // The line of `step` as a lift to `z`, if the head is not there.
  void LiftAs(const LinkStep& step, Decimal z);

  LinkParts& parts_;
  const GcodeFile& file_;
  const LinkDonors& donors_;
  const PlacedPath& from_;
  const PlacedPath& to_;
  const LinkForm& form_;
  std::shared_ptr<const Link> left_;  // behind `from` in the file
  NewLink link_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_COMPOSER_H_
