// What the links of a layer come to before they are written.

#include <algorithm>
#include <cmath>
#include <limits>

#include "client/gcode/link/layer_links.h"
#include "client/gcode/measure/layer_meter.h"

namespace traverse::gcode {

TravelTotals LayerLinks::EstimateTravel(size_t place, const Placement& from, const Placement& to,
                                        const TravelModel& model) const {
  const uint32_t here = layer_.first_block + static_cast<uint32_t>(place);
  LinkForm form = FormOf(from, departures_.End(from), to, here);
  Hide(from, to, /*bends=*/false, form);
  const TravelJoints joints = JointsOf(from, to, form.wipes || (form.given && !form.hidden));
  TravelTotals totals;
  PlannedTravel& travel = form.travel;
  double across_mm = travel.mm;
  if (form.given && !form.boundary && !form.hidden) {
    const PrintTotals measured = MeasureLink(file_, to.block, walls_);
    travel.mm = static_cast<double>(file_.blocks[to.block].travel_mm);
    travel.crosses = measured.crossings > 0;
    across_mm = measured.longest_open_mm;
    totals.seconds = TravelSeconds(file_, to.block, model, true, &joints);
  } else {
    // Where the head goes at a boundary it goes in any order: only the travel between the paths
    // counts.
    const bool at_boundary = form.boundary && (file_.blocks[here].link & kLinkRetracts) != 0;
    form.retracts = form.retracts || at_boundary;
    travel.retracts = form.retracts;
    if (form.departure != nullptr) across_mm -= form.departure->mm;
    totals.seconds = NewTravelSeconds(file_, from.block, travel, model, &joints);
  }
  totals.mm = travel.mm;
  totals.seconds += joints_.RestartSeconds(to.block - layer_.first_block, to.entry);
  if (form.retracts) totals.seconds += RetractionSeconds(from, to, travel.mm, form, model);
  totals.retractions = form.retracts ? 1 : 0;
  totals.crossings = travel.crosses ? 1 : 0;
  totals.open = travel.crosses && !form.retracts ? 1 : 0;
  totals.blocked = room_ != nullptr && (form.hidden || !form.given) && IsBlocked(travel) ? 1 : 0;
  if (totals.open > 0) totals.open_mm = across_mm;
  return totals;
}

PlannedTravel LayerLinks::OpenTravel(const Placement& from, const Placement& to) const {
  PlannedTravel travel;
  const Vertex end = departures_.End(from);
  const Vertex leaves = departures_.Open(from);
  travel.from = leaves;
  travel.to = departures_.Begin(to);
  travel.mm = Distance(leaves, travel.to);
  if (!(leaves == end)) {
    travel.mm += departures_.Of(from, /*wipes=*/false)->mm;
    travel.ahead = {leaves.x - end.x, leaves.y - end.y};
  }
  return travel;
}

TravelJoints LayerLinks::JointsOf(const Placement& from, const Placement& to, bool wipes) const {
  TravelJoints joints;
  const Departure* departure = departures_.Of(from, wipes);
  if (departure == nullptr || departure->departs || departure->stands ||
      departures_.ShortMove(from)) {
    joints.from = joints_.EndOf(from.block - layer_.first_block, from.entry);
  }
  joints.to = joints_.BeginOf(to.block - layer_.first_block, to.entry);
  return joints;
}

double LayerLinks::LeastLiftMm() const {
  double least = std::numeric_limits<double>::infinity();
  for (uint32_t b = layer_.first_block + 1; b < layer_.end_block; ++b) {
    const Block& block = file_.blocks[b];
    if ((block.link & kLinkRetracts) == 0) continue;
    least = std::min(least, ToDouble(block.lift) * file_.modes[block.mode].UnitMm());
  }
  return std::isfinite(least) ? least : 0;
}

bool LayerLinks::IsBlocked(const PlannedTravel& travel) const {
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

// The path before is left as it is in the file, if it retracts there, and the next one is reached
// as the travel does that this is like (LinkComposer).
double LayerLinks::RetractionSeconds(const Placement& from, const Placement& to, double mm,
                                     const LinkForm& form, const TravelModel& model) const {
  const auto of = [&](uint32_t block) {
    const bool here = layer_.first_block < block && block < layer_.end_block;
    const size_t place = here ? block - layer_.first_block : 0;
    return here && place < model.added.size() ? model.added[place] : AddedSeconds();
  };
  uint32_t like = to.block;
  if (!form.given && !donors_.IsOwnExample(like, true, form.wipes)) {
    like = donors_.Find(like, true, file_.WipedBehind(from.block)).value_or(like);
  }
  const uint32_t left = form.given ? like : from.block + 1;
  const AddedSeconds leaving = of(left).sum() > 0 ? of(left) : of(like);
  const AddedSeconds arriving = of(like).sum() > 0 ? of(like) : leaving;
  if (!(arriving.sum() > 0)) return model.retraction_seconds;
  const double seconds = leaving.leaving + arriving.arriving;
  if (form.given || !(model.slope > 0)) return seconds;
  // A slope rises as long as the travel does, and is not made lower for a shorter one.
  const auto lift_of = [&](uint32_t block) {
    const Block& link = file_.blocks[block];
    return ToDouble(link.lift) * file_.modes[link.mode].UnitMm();
  };
  const double lift = std::max(lift_of(of(left).sum() > 0 ? left : like), lift_of(like));
  const double highest = std::max(ToDouble(donors_.highest_lift()), lift);
  const double rises = std::clamp(model.slope * mm, lift, highest);
  const uint32_t lowered = of(like).sum() > 0 ? like : left;
  return seconds + (rises - lift_of(lowered)) * model.descent_seconds_per_mm;
}

}  // namespace traverse::gcode
