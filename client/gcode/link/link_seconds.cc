// What the links of a layer come to before they are written.

#include <algorithm>
#include <cmath>
#include <limits>

#include "client/gcode/link/composer.h"
#include "client/gcode/link/layer_links.h"
#include "client/gcode/link/link_meter.h"
#include "client/gcode/measure/layer_meter.h"

namespace traverse::gcode {

TravelTotals LayerLinks::EstimateTravel(size_t place, const Placement& from, const Placement& to,
                                        LinkParts& parts, Hiding hiding) const {
  const uint32_t here = layer_.first_block + static_cast<uint32_t>(place);
  LinkForm form = FormOf(from, departures_.End(from), to, here);
  Hide(from, to, hiding, form);
  TravelTotals totals;
  PlannedTravel& travel = form.travel;
  double across_mm = travel.mm;
  totals.seconds = SecondsOf(from, to, form, parts);
  if (form.given && !form.boundary && !form.hidden) {
    const PrintTotals measured = MeasureLink(file_, to.block, walls_);
    travel.mm = static_cast<double>(file_.blocks[to.block].travel_mm);
    travel.crosses = measured.crossings > 0;
    across_mm = measured.longest_open_mm;
  } else {
    // Where the head goes at a boundary it goes in any order: only the travel between the paths
    // counts.
    const bool at_boundary = form.boundary && (file_.blocks[here].link & kLinkRetracts) != 0;
    form.retracts = form.retracts || at_boundary;
    travel.retracts = form.retracts;
    if (form.departure != nullptr) across_mm -= form.departure->mm;
  }
  totals.mm = travel.mm;
  totals.retractions = form.retracts ? 1 : 0;
  totals.crossings = travel.crosses ? 1 : 0;
  totals.open = travel.crosses && !form.retracts ? 1 : 0;
  totals.blocked = room_ != nullptr && (form.hidden || !form.given) && IsBlocked(travel) ? 1 : 0;
  if (totals.open > 0) totals.open_mm = across_mm;
  return totals;
}

PlannedTravel LayerLinks::OpenTravel(const Placement& from, const Placement& to) const {
  PlannedTravel travel;
  const Point end = departures_.End(from);
  const Point leaves = departures_.Open(from);
  travel.from = leaves;
  travel.to = departures_.Begin(to);
  travel.mm = Distance(leaves, travel.to);
  if (!(leaves == end)) travel.mm += departures_.Of(from, /*wipes=*/false)->mm;
  return travel;
}

double LayerLinks::SecondsOf(const Placement& from, const Placement& to, const LinkForm& form,
                             LinkParts& parts) const {
  const std::shared_ptr<const PlacedPath> left = parts.PathOf(from);
  const std::shared_ptr<const PlacedPath> next = parts.PathOf(to);
  MachineState at = StartBehind(file_, left->block()).machine;
  at.at = left->last();
  const NewLink link = LinkComposer(parts, donors_, *left, *next, form, at).Compose();
  const std::shared_ptr<const PathEnds> ends = parts.EndsOf(to);
  const double seconds = LinkSeconds(file_, *parts.EndsOf(from), at, link, *ends);
  if (to.as_given()) return seconds;
  return seconds + ends->seconds() - parts.EndsOf({to.block, 0, to.closed})->seconds();
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
  Point at = travel.from;
  for (const Point& bend : travel.via) {
    if (!room_->IsClear(at, z_mm, bend, z_mm)) return true;
    at = bend;
  }
  return !room_->IsClear(at, z_mm, travel.to, z_mm);
}

}  // namespace traverse::gcode
