// Links of a file that may serve as templates for travel that the file does not have.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LINK_DONORS_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LINK_DONORS_H_

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

  // A link that may be the template for travel to `block`: without marks, in the modes of `block`,
  // between two paths of the part itself that do not meet (no scripts, no towers), which retracts
  // or not as asked, and wipes if `wipes` and any link does. Of those one to a path that rises as
  // much, as scarf seams do, if there is any; the nearest in the layer of `block`, else the nearest
  // before it, else the nearest after it. If the file lifts in most such links, one that lifts.
  // Unset if there is none.
  std::optional<uint32_t> Find(uint32_t block, bool retracts, bool wipes = false) const;

  // Whether new travel to `block` that retracts or not, and wipes if `wipes`, is like the travel
  // that leads there in the file, and not like another link.
  bool IsOwnExample(uint32_t block, bool retracts, bool wipes) const;

  // A layer's travel may have speeds of its own: the link of the layer of `block` that shows them
  // when `link` is the template. One that retracts as `link` does, if there is any. Unset if `link`
  // is of that layer, or the layer has no travel to learn from.
  std::optional<uint32_t> PaceFor(uint32_t block, uint32_t link) const;

  // Whether link `block` itself may be a template.
  bool MayFollow(uint32_t block) const { return may_follow_[block]; }

  // How much path `block` rises from its begin to its end, as scarf seams do, in the unit of the
  // file.
  Decimal RiseOf(uint32_t block) const;

  // Most links like link `block` in its layer rise above what is printed, but it does
  // not.
  bool LacksLift(uint32_t block) const;

  // How far most links rise that retract and lead to a layer, in the unit of the file; 0 if
  // they do not, or link `block` leads to none.
  Decimal LiftToLayer(uint32_t block) const;

  // The highest lift of all links, in the unit of the file.
  Decimal highest_lift() const { return highest_lift_; }

 private:
  // The kind of a link: its modes, and whether it retracts.
  using Kind = std::pair<uint16_t, bool>;
  using KindInLayer = std::pair<Kind, size_t>;

  // Ascending links by how much the path behind them rises.
  using ByRise = std::map<Decimal, std::vector<uint32_t>>;

  Kind KindOf(uint32_t block) const;
  std::optional<uint32_t> FindAmong(const std::map<Kind, ByRise>& links, const Kind& kind,
                                    uint32_t block) const;

  const GcodeFile& file_;
  std::vector<bool> may_follow_;  // [block] its link is whole, and of the part
  std::map<Kind, ByRise> donors_;
  std::map<Kind, ByRise> lifted_;  // those of them that lift
  std::map<Kind, ByRise> wiping_;  // that wipe
  std::map<KindInLayer, uint32_t> first_;
  std::map<KindInLayer, int64_t> lifts_;  // links that lift, less those that do not
  Decimal highest_lift_ = 0;
  const Decimal lift_to_layers_;  // of most links that lead to one
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LINK_DONORS_H_
