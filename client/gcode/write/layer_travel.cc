// What travel moves between the paths of a layer come to before they are written.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/write/layer_writer.h"

namespace traverse::gcode {

PlannedTravel LayerWriter::NewTravel(const Placement& from, const Placement& to, bool wipes) const {
  const Feature feature = outlines_[to.block - layer_.first_block].feature;
  const Leaving* leaving = LeavingOf(from, wipes);
  if (leaving == nullptr || (leaving->departs && !Departs(from, Begin(to), feature))) {
    return rules_.TravelOf(End(from), Begin(to), feature);
  }
  const Vertex at = Behind(from, *leaving);
  PlannedTravel travel = rules_.TravelOf(at, Begin(to), feature);
  travel.mm += leaving->departs ? Distance(End(from), at) : leaving->mm;
  if (leaving->wipes) {
    const std::optional<Vertex> departs_to = DepartsTo(from);
    if (!departs_to) return travel;
    const Vertex end = End(from);
    const Vertex before = {departs_to->x - end.x, departs_to->y - end.y};
    const double before_mm = std::hypot(before.x, before.y);
    // As TravelSeconds sees it, which leaves out the wipe between the two.
    travel.stands = true;
    travel.mm += before_mm;
    travel.from = {at.x - before.x, at.y - before.y};
    travel.via.insert(travel.via.begin(), at);
    return travel;
  }
  travel.from = End(from);
  travel.via.insert(travel.via.begin(), at);
  if (leaving->departs) {
    travel.retracts = leaving->retracts;
  } else {
    // A retraction would come before it goes on.
    travel.retracts = travel.retracts || rules_.Retracts(End(from), Begin(to), feature);
  }
  travel.stands = travel.retracts;
  return travel;
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

std::optional<std::vector<Vertex>> LayerWriter::HiddenBends(const Placement& from,
                                                            const Placement& to,
                                                            bool boundary) const {
  if (!hides_ || boundary || from.block < layer_.first_block) return std::nullopt;
  const Feature feature = outlines_[to.block - layer_.first_block].feature;
  const Vertex leaves = LeavesFrom(from);
  const Vertex begin = Begin(to);
  if (rules_.Hides(leaves, begin, feature)) return std::vector<Vertex>();
  if (travel_ == nullptr) return std::nullopt;
  std::vector<Vertex> bends = rules_.HiddenBends(leaves, begin, feature);
  if (bends.empty()) return std::nullopt;
  const auto seconds = [this](Vertex a, Vertex b) {
    return StopToStopSeconds(Distance(a, b), travel_->speed_mm_s, travel_->accel_mm_s2);
  };
  double bent = 0;
  Vertex at = leaves;
  for (const Vertex& bend : bends) bent += seconds(std::exchange(at, bend), bend);
  bent += seconds(at, begin);
  if (bent >= seconds(leaves, begin) + travel_->retraction_seconds) return std::nullopt;
  return bends;
}

TravelJoints LayerWriter::JointsOf(const Placement& from, const Placement& to, bool wipes) const {
  TravelJoints joints;
  const Leaving* leaving = LeavingOf(from, wipes);
  if (leaving == nullptr || leaving->departs || leaving->stands || DepartsTo(from)) {
    joints.from = joints_.EndOf(from.block - layer_.first_block, from.entry);
  }
  joints.to = joints_.BeginOf(to.block - layer_.first_block, to.entry);
  return joints;
}

TravelTotals LayerWriter::EstimateTravel(size_t place, const Placement& from, const Placement& to,
                                         const TravelModel& model) const {
  const Block& here = file_.blocks[layer_.first_block + place];
  const Block& next = file_.blocks[to.block];
  const bool boundary = (here.link & (kLinkSplits | kLinkFixed)) != 0;
  const bool stays = from.block + 1 == to.block && from.as_given() && to.as_given() &&
                     (!boundary || to.block == layer_.first_block + place);
  // Where the head goes at a boundary it goes in any order: only the travel between the paths
  // counts.
  const bool as_given = stays && !boundary;
  const Feature feature = outlines_[to.block - layer_.first_block].feature;
  const bool wipes = stays || Wipes(from, Begin(to), feature, boundary);
  const std::optional<Vertex> behind_fixed =
      BehindFixed(layer_.first_block + static_cast<uint32_t>(place));
  PlannedTravel travel;
  if (as_given) {
    travel.to = Begin(to);
    travel.mm = static_cast<double>(next.travel_mm);
  } else if (behind_fixed) {
    travel = rules_.TravelOf(*behind_fixed, Begin(to), feature);
  } else {
    travel = NewTravel(from, to, wipes);
  }
  double across_mm = travel.mm;
  if (as_given) {
    const PrintTotals measured = MeasureLink(file_, to.block, walls_);
    travel.crosses = measured.crossings > 0;
    across_mm = measured.longest_open_mm;
  } else if (const Leaving* leaving = LeavingOf(from, wipes); leaving && !behind_fixed) {
    across_mm -= leaving->mm;
  }
  travel.retracts = stays ? (next.link & kLinkRetracts) != 0
                          : travel.retracts || wipes ||
                                (boundary && (here.link & kLinkRetracts) != 0) ||
                                GoesOnAcross(from, travel.to, feature);
  if (travel.retracts && Hides(from, to, boundary)) return HiddenTravel(from, to, model);
  const TravelJoints joints = JointsOf(from, to, wipes);
  TravelTotals totals;
  totals.mm = travel.mm;
  totals.seconds = as_given ? TravelSeconds(file_, to.block, model, true, &joints)
                            : NewTravelSeconds(file_, from.block, travel, model, &joints);
  totals.seconds += joints_.RestartSeconds(to.block - layer_.first_block, to.entry);
  if (travel.retracts)
    totals.seconds += RetractionSeconds(from, to, travel.mm, stays, wipes, model);
  totals.retractions = travel.retracts ? 1 : 0;
  totals.crossings = travel.crosses ? 1 : 0;
  totals.open = travel.crosses && !travel.retracts ? 1 : 0;
  totals.blocked = room_ != nullptr && !stays && IsBlocked(travel) ? 1 : 0;
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

bool LayerWriter::IsBlocked(const PlannedTravel& travel) const {
  const Block& first = file_.blocks[layer_.first_block];
  const double z_mm =
      ToDouble(layer_.z) * file_.modes[first.mode].UnitMm() + (travel.retracts ? lift_mm_ : 0);
  Vertex at = travel.from;
  for (const Vertex& bend : travel.via) {
    if (!room_->IsClear(at, z_mm, bend, z_mm)) return true;
    at = bend;
  }
  return !room_->IsClear(at, z_mm, travel.to, z_mm);
}

TravelTotals LayerWriter::HiddenTravel(const Placement& from, const Placement& to,
                                       const TravelModel& model) const {
  PlannedTravel travel;
  travel.from = End(from);
  travel.to = Begin(to);
  const Vertex leaves = LeavesFrom(from);
  travel.mm = Distance(leaves, travel.to);
  if (!(leaves == travel.from)) {
    travel.mm += LeavingOf(from, /*wipes=*/false)->mm;
    travel.via.push_back(leaves);
  }
  const TravelJoints joints = JointsOf(from, to, /*wipes=*/false);
  TravelTotals totals;
  totals.mm = travel.mm;
  totals.blocked = room_ != nullptr && IsBlocked(travel) ? 1 : 0;
  totals.seconds = NewTravelSeconds(file_, from.block, travel, model, &joints) +
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
  // A slope rises as long as the travel does, and is not made lower for a shorter one.
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
