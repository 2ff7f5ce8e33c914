// Links of a file that may serve as templates for ways that the file does not have.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_LINK_DONORS_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_LINK_DONORS_H_

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

class LinkDonors {
 public:
  explicit LinkDonors(const GcodeFile& file);

  // A link that may be followed on the way to `block`: without marks, between two paths in the
  // modes of `block` that do not meet and are printed for the part itself (no scripts, no towers),
  // which retracts or not, and wipes if `wipes` and any does. Of those, the nearest in the layer of
  // `block`, else the nearest before it, else the nearest behind it. Where the file lifts in most
  // such links, one that lifts. Nothing if there is none.
  std::optional<uint32_t> Find(uint32_t block, bool retracts, bool wipes = false) const;

  // How fast the ways of a layer are may be its own: the link of the layer of `block` that tells it
  // where `link` is followed. One that retracts as `link` does, if there is any. Nothing if `link`
  // is of that layer, or the layer has no way to learn from.
  std::optional<uint32_t> PaceFor(uint32_t block, uint32_t link) const;

  // Link `block` itself may be followed.
  bool MayFollow(uint32_t block) const;

  // Most ways of the kind of link `block`, in its layer, are higher than what is printed, and it is
  // not.
  bool LacksLift(uint32_t block) const;

  // The highest lift of any of them, in the unit of the file.
  Decimal highest_lift() const { return highest_lift_; }

 private:
  // Of what kind a link is: its modes, and whether it retracts.
  using Kind = std::pair<uint16_t, bool>;

  bool Travels(uint32_t block) const;
  Kind KindOf(uint32_t block) const;
  std::optional<uint32_t> FindAmong(const std::vector<uint32_t>& links, uint32_t block) const;
  void CountLifts(uint32_t link);

  const GcodeFile& file_;
  std::vector<uint32_t> layer_of_;                       // [block]
  std::map<Kind, std::vector<uint32_t>> donors_;         // ascending
  std::map<Kind, std::vector<uint32_t>> lifted_;         // those of them that lift
  std::map<Kind, std::vector<uint32_t>> wiping_;         // that wipe
  std::map<std::pair<Kind, uint32_t>, uint32_t> first_;  // by kind and layer
  // By kind and layer: links that lift, less those that do not.
  std::map<std::pair<Kind, uint32_t>, int64_t> lifts_;
  Decimal highest_lift_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_LINK_DONORS_H_
