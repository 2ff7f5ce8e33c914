// What ways between the paths of a layer come to before they are written.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "client/gcode/write/layer_writer.h"

namespace traverse::gcode {

TravelWay LayerWriter::NewWay(const Placement& from, const Placement& to, bool wipes) const {
  const Feature feature = outlines_[to.block - layer_.first_block].feature;
  const Leaving* leaving = LeavingOf(from, wipes);
  if (leaving == nullptr || (leaving->departs && !Departs(from, Begin(to), feature))) {
    return rules_.WayOf(End(from), Begin(to), feature);
  }
  const Vertex at = Behind(from, *leaving);
  TravelWay way = rules_.WayOf(at, Begin(to), feature);
  way.mm += leaving->departs ? Distance(End(from), at) : leaving->mm;
  if (leaving->wipes) {
    const std::optional<Vertex> departs_to = DepartsTo(from);
    if (!departs_to) return way;
    const Vertex end = End(from);
    const Vertex before = {departs_to->x - end.x, departs_to->y - end.y};
    const double before_mm = std::hypot(before.x, before.y);
    // As WaySeconds sees it, which leaves out the wipe between the two.
    way.stands = true;
    way.mm += before_mm;
    way.from = {at.x - before.x, at.y - before.y};
    way.via.insert(way.via.begin(), at);
    return way;
  }
  way.from = End(from);
  way.via.insert(way.via.begin(), at);
  if (leaving->departs) {
    way.retracts = leaving->retracts;
  } else {
    // A retraction would come before it goes on.
    way.retracts = way.retracts || rules_.Retracts(End(from), Begin(to), feature);
  }
  way.stands = way.retracts;
  return way;
}

Vertex LayerWriter::LeavesFrom(const Placement& from) const {
  const Leaving* leaving = LeavingOf(from, /*wipes=*/false);
  return leaving == nullptr || leaving->departs ? End(from) : Behind(from, *leaving);
}

bool LayerWriter::Hides(const Placement& from, const Placement& to, bool boundary) const {
  if (!hides_ || boundary || from.block < layer_.first_block) return false;
  const Feature feature = outlines_[to.block - layer_.first_block].feature;
  return rules_.Hides(LeavesFrom(from), Begin(to), feature);
}

WayJoints LayerWriter::JointsOf(const Placement& from, const Placement& to, bool wipes) const {
  WayJoints joints;
  const Leaving* leaving = LeavingOf(from, wipes);
  if (leaving == nullptr || leaving->departs || leaving->stands || DepartsTo(from)) {
    joints.from = joints_.EndOf(from.block - layer_.first_block, from.entry);
  }
  joints.to = joints_.BeginOf(to.block - layer_.first_block, to.entry);
  return joints;
}

WayTotals LayerWriter::EstimateWay(size_t place, const Placement& from, const Placement& to,
                                   const TravelModel& model) const {
  const Block& here = file_.blocks[layer_.first_block + place];
  const Block& next = file_.blocks[to.block];
  const bool boundary = (here.link & (kLinkSplits | kLinkFixed)) != 0;
  const bool stays = from.block + 1 == to.block && from.as_given() && to.as_given() &&
                     (!boundary || to.block == layer_.first_block + place);
  // Where the head goes at a boundary it goes in any order: only the way between the paths counts.
  const bool as_given = stays && !boundary;
  const Feature feature = outlines_[to.block - layer_.first_block].feature;
  const bool wipes = stays || Wipes(from, Begin(to), feature, boundary);
  const std::optional<Vertex> behind_fixed =
      BehindFixed(layer_.first_block + static_cast<uint32_t>(place));
  TravelWay way;
  if (as_given) {
    way.to = Begin(to);
    way.mm = static_cast<double>(next.travel_mm);
  } else if (behind_fixed) {
    way = rules_.WayOf(*behind_fixed, Begin(to), feature);
  } else {
    way = NewWay(from, to, wipes);
  }
  double across_mm = way.mm;
  if (as_given) {
    const PrintTotals measured = MeasureLink(file_, to.block, walls_);
    way.crosses = measured.crossings > 0;
    across_mm = measured.longest_open_mm;
  } else if (const Leaving* leaving = LeavingOf(from, wipes); leaving && !behind_fixed) {
    across_mm -= leaving->mm;
  }
  way.retracts = stays ? (next.link & kLinkRetracts) != 0
                       : way.retracts || wipes || (boundary && (here.link & kLinkRetracts) != 0) ||
                             GoesOnAcross(from, way.to, feature);
  if (way.retracts && Hides(from, to, boundary)) return HiddenWay(from, to, model);
  const WayJoints joints = JointsOf(from, to, wipes);
  WayTotals totals;
  totals.mm = way.mm;
  totals.seconds = as_given ? WaySeconds(file_, to.block, model, true, &joints)
                            : NewWaySeconds(file_, from.block, way, model, &joints);
  totals.seconds += joints_.RestartSeconds(to.block - layer_.first_block, to.entry);
  if (way.retracts) totals.seconds += RetractionSeconds(from, to, way.mm, stays, wipes, model);
  totals.retractions = way.retracts ? 1 : 0;
  totals.crossings = way.crosses ? 1 : 0;
  totals.open = way.crosses && !way.retracts ? 1 : 0;
  totals.blocked = room_ != nullptr && !stays && IsBlocked(way) ? 1 : 0;
  if (totals.open > 0) totals.open_mm = across_mm;
  return totals;
}

double LayerWriter::LeastLiftMm() const {
  double least = std::numeric_limits<double>::infinity();
  for (uint32_t b = layer_.first_block + 1; b < layer_.end_block; ++b) {
    const Block& block = file_.blocks[b];
    if ((block.link & kLinkRetracts) == 0) continue;
    least = std::min(least, ToDouble(block.lift) * file_.modes[block.mode].UnitMm());
  }
  return std::isfinite(least) ? least : 0;
}

bool LayerWriter::IsBlocked(const TravelWay& way) const {
  const Block& first = file_.blocks[layer_.first_block];
  const double z_mm =
      ToDouble(layer_.z) * file_.modes[first.mode].UnitMm() + (way.retracts ? lift_mm_ : 0);
  Vertex at = way.from;
  for (const Vertex& bend : way.via) {
    if (!room_->IsClear(at, z_mm, bend, z_mm)) return true;
    at = bend;
  }
  return !room_->IsClear(at, z_mm, way.to, z_mm);
}

WayTotals LayerWriter::HiddenWay(const Placement& from, const Placement& to,
                                 const TravelModel& model) const {
  TravelWay way;
  way.from = End(from);
  way.to = Begin(to);
  const Vertex leaves = LeavesFrom(from);
  way.mm = Distance(leaves, way.to);
  if (!(leaves == way.from)) {
    way.mm += LeavingOf(from, /*wipes=*/false)->mm;
    way.via.push_back(leaves);
  }
  const WayJoints joints = JointsOf(from, to, /*wipes=*/false);
  WayTotals totals;
  totals.mm = way.mm;
  totals.blocked = room_ != nullptr && IsBlocked(way) ? 1 : 0;
  totals.seconds = NewWaySeconds(file_, from.block, way, model, &joints) +
                   joints_.RestartSeconds(to.block - layer_.first_block, to.entry);
  return totals;
}

// The path before is left as it is in the file, if it retracts there; else the travel is like that
// to the path behind it, or like another (LinkWriter).
double LayerWriter::RetractionSeconds(const Placement& from, const Placement& to, double mm,
                                      bool stays, bool wipes, const TravelModel& model) const {
  const auto of = [&](uint32_t block) {
    const bool here = layer_.first_block < block && block < layer_.end_block;
    const size_t place = here ? block - layer_.first_block : 0;
    return here && place < model.added_seconds.size() ? model.added_seconds[place] : 0.F;
  };
  if (stays) return of(to.block) > 0 ? of(to.block) : model.retraction_seconds;
  uint32_t form = to.block;
  if (!(of(form) > 0)) form = donors_.Find(to.block, true, wipes).value_or(form);
  const uint32_t left = from.block + 1;
  const uint32_t like = of(left) > 0 ? left : form;
  if (!(of(like) > 0)) return model.retraction_seconds;
  if (!(model.slope > 0)) return of(like);
  // A slope rises as long as the way does, and is not made lower for a shorter way.
  const auto lift_of = [&](uint32_t block) {
    const Block& link = file_.blocks[block];
    return ToDouble(link.lift) * file_.modes[link.mode].UnitMm();
  };
  const double lift = std::max(lift_of(like), lift_of(form));
  const double highest = std::max(ToDouble(donors_.highest_lift()), lift);
  const double rises = std::clamp(model.slope * mm, lift, highest);
  return of(like) + (rises - lift_of(like)) * model.descent_seconds_per_mm;
}

}  // namespace traverse::gcode
