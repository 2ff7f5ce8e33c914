#include "client/gcode/link/layer_links.h"

#include <optional>
#include <utility>

#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/model/part_links.h"

namespace traverse::gcode {

LayerLinks::LayerLinks(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
                       const LinkDonors& donors, const Room* room, bool hides,
                       const TravelModel* travel)
    : file_(file),
      layer_(layer),
      donors_(donors),
      habit_(habit),
      room_(room),
      lift_mm_(room != nullptr ? LeastLiftMm() : 0),
      outlines_(OutlinesOf(file, layer)),
      walls_(outlines_),
      rules_(file, layer, habit, outlines_, walls_),
      departures_(file, layer, donors, outlines_, walls_),
      hides_(hides && habit.hidden != nullptr),
      travel_(travel) {}

LinkForm LayerLinks::FormOf(const Placement& from, Point end, const Placement& to,
                            uint32_t place) const {
  LinkForm form;
  if (IsBoundary(file_.blocks[place])) form.boundary = place;
  form.given = from.block + 1 == to.block && from.as_given() && to.as_given() &&
               (!form.boundary || to.block == place);
  DecideTravel(from, end, to, place, form);
  if (form.given) form.retracts = (file_.blocks[to.block].link & kLinkRetracts) != 0;
  return form;
}

// No move at a boundary is hidden, and none beside a path during which the nozzle counts as closed:
// to leave out what closes it does not open it.
void LayerLinks::Hide(const Placement& from, const Placement& to, Hiding hiding,
                      LinkForm& form) const {
  if (!hides_ || hiding == Hiding::kNone || !form.retracts || form.boundary) return;
  if (from.block < layer_.first_block) return;
  if (((file_.blocks[from.block].flags | file_.blocks[to.block].flags) & kBlockRetracted) != 0)
    return;
  if (rules_.Hides(departures_.Open(from), departures_.Begin(to), FeatureOf(to))) {
    return form.Hide(OpenTravel(from, to));
  }
  if (hiding != Hiding::kBent) return;
  std::vector<Point> around = HiddenBends(from, to);
  if (around.empty()) return;
  form.Hide(OpenTravel(from, to));
  form.travel.via = std::move(around);
}

std::vector<Point> LayerLinks::HiddenBends(const Placement& from, const Placement& to) const {
  if (travel_ == nullptr) return {};
  const Point leaves = departures_.Open(from);
  const Point begin = departures_.Begin(to);
  std::vector<Point> bends = rules_.HiddenBends(leaves, begin, FeatureOf(to));
  const auto seconds = [this](Point a, Point b) {
    return StopToStopSeconds(Distance(a, b), travel_->speed_mm_s, travel_->accel_mm_s2);
  };
  double bent = 0;
  Point at = leaves;
  for (const Point& bend : bends) bent += seconds(std::exchange(at, bend), bend);
  bent += seconds(at, begin);
  if (bent >= seconds(leaves, begin) + travel_->retraction_seconds) bends.clear();
  return bends;
}

bool LayerLinks::ChangesGiven() const {
  if (!hides_) return false;
  for (uint32_t b = layer_.first_block + 1; b < layer_.end_block; ++b) {
    if ((file_.blocks[b].link & kLinkRetracts) == 0) continue;
    const Placement from{b - 1, 0, outlines_[b - 1 - layer_.first_block].closed};
    const Placement to{b, 0, outlines_[b - layer_.first_block].closed};
    LinkForm form = FormOf(from, departures_.End(from), to, b);
    Hide(from, to, Hiding::kBent, form);
    if (form.hidden) return true;
  }
  return false;
}

void LayerLinks::DecideTravel(const Placement& from, Point end, const Placement& to, uint32_t place,
                              LinkForm& form) const {
  const Point begin = departures_.Begin(to);
  const Feature feature = FeatureOf(to);
  const std::optional<Point> behind_fixed = departures_.BehindFixed(place);
  PlannedTravel& travel = form.travel;
  travel = rules_.TravelOf(behind_fixed.value_or(end), begin, feature);
  // Paths that the slicer wipes stay wiped, so that all travel moves from them are retracted.
  form.wipes =
      file_.WipedBehind(from.block) && (!habit_.drops_wipes || form.boundary || travel.retracts);
  form.retracts = form.wipes || travel.retracts;
  const Departure* departure = departures_.Of(from);
  form.departs = departure != nullptr;
  if (departure == nullptr) return;
  const Point at = departures_.Behind(from, *departure);
  PlannedTravel behind = rules_.TravelOf(at, begin, feature);
  // What goes on along the path must not put a visible wall between the nozzle and the next one.
  const bool goes_on = !departure->wipes && !departure->departs;
  const bool spares_walls = habit_.retracts && habit_.spares_walls;
  if (goes_on && spares_walls && behind.retracts) form.retracts = true;
  // That stays with the path, and so does what comes before its wipe.
  form.departs = !departure->departs || Departs(from, *departure, travel, behind);
  if (form.departs && !from.as_given()) form.turned_departure = departures_.ShortMove(from);
  const bool left = form.departs && (form.wipes || form.given || !departure->wipes);
  if (!left || behind_fixed) return;
  form.departure = departure;
  behind.mm += departure->departs ? Distance(end, at) : departure->mm;
  if (departure->wipes) behind.mm += Distance(end, departures_.ShortMove(from).value_or(end));
  travel = std::move(behind);
}

bool LayerLinks::Departs(const Placement& from, const Departure& departure,
                         const PlannedTravel& straight, const PlannedTravel& behind) const {
  if (straight.retracts != departure.retracts) return false;
  // Behind a loop as sliced it hides the retraction, whatever it crosses.
  if (straight.retracts && from.as_given()) return true;
  std::vector<Point> bent = {straight.from, behind.from};
  bent.insert(bent.end(), behind.via.begin(), behind.via.end());
  bent.push_back(behind.to);
  return straight.crosses || !(behind.crosses || walls_.CrossedByTravel(bent));
}

}  // namespace traverse::gcode
