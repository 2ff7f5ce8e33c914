#include "client/gcode/link/composer.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "client/gcode/model/part_links.h"
#include "client/gcode/model/positions.h"

namespace traverse::gcode {
namespace {

// What is left of a travel move behind a slope is at least this long.
constexpr double kMinSlopeRestMm = 0.5;

// `rise` for travel of `length`, in words of `unit_mm`: a slope that lasts as long as its travel
// rises on, up to `highest`.
Link Stretched(Link rise, double length, Decimal highest, double unit_mm) {
  if (rise.ramp_ends || !(rise.ramp_mm > 0) || length <= rise.ramp_mm) return rise;
  const double steepness = static_cast<double>(rise.lift) / rise.ramp_mm;
  const auto reached = static_cast<double>(std::max(highest, rise.lift));
  rise.ramp_ends = steepness * length > reached;
  rise.ramp_mm = rise.ramp_ends ? reached / steepness : length;
  // As slicers write heights: to micrometres.
  rise.lift = RoundedWord(steepness * rise.ramp_mm * 1e-9, unit_mm);
  return rise;
}

// Puts the end of the slope of `rise` on the first stretch of `travel` from `from`, if that is
// longer; else it rises over all of that stretch. Lengths are in words of `unit_mm`.
void Slope(const Position& from, const Link& rise, double unit_mm, std::vector<Position>& travel) {
  if (!rise.ramp_ends) return;
  if (LengthXy(from, travel.front()) < rise.ramp_mm + kMinSlopeRestMm / unit_mm) return;
  Position end = Along(from, travel.front(), rise.ramp_mm, unit_mm);
  end.z = travel.front().z;
  travel.insert(travel.begin(), end);
}

}  // namespace

NewLink LinkComposer::Compose() && {
  if (form_.given && !form_.hidden) {
    KeepGiven();
    return std::move(link_);
  }
  const uint32_t next = from_.placement().block + 1;
  if (next < file_.blocks.size()) left_ = parts_.LinkTo(next);
  if (form_.boundary) {
    ComposeBoundary();
  } else {
    ComposePlain();
  }
  return std::move(link_);
}

void LinkComposer::KeepGiven() {
  const Block& from = from_.block();
  const Block& to = to_.block();
  PartStart behind = StartBehind(file_, to);
  behind.state = file_.states[to.state_in];
  behind.machine.at = to.first;
  behind.machine.e = to.e_in;
  // The F word of the path's own first line is not part of the link; that its feed rate is taken
  // for set already changes nothing.
  behind.machine.feed = to.feed_in;
  link_.Keep({from.end, to.begin, StartBehind(file_, from), behind, form_.without_progress});
}

Link LinkComposer::LikeWhat(bool retracts) const {
  const uint32_t to = to_.placement().block;
  if (donors_.IsOwnExample(to, retracts, form_.wipes)) {
    const std::shared_ptr<const Link> own = parts_.ModelOf(to);
    if (own->arrival >= 0) return *own;
  }
  for (const bool pulls : {retracts, !retracts}) {
    // Where no travel of the file is open, this is retracted, and so the path is wiped.
    const bool wipes = file_.WipedBehind(from_.placement().block);
    // Where there is no way to go, there is none to retract for.
    if (pulls && !retracts && to_.first().SameXy(link_.at())) return {};
    const std::optional<uint32_t> donor = donors_.Find(to, pulls, pulls && wipes);
    if (!donor) continue;
    Link like = *parts_.ModelOf(*donor);
    if (like.arrival < 0) continue;
    if (const std::optional<uint32_t> pace = donors_.PaceFor(to, *donor)) {
      const std::shared_ptr<const Link> own = parts_.ModelOf(*pace);
      if (own->arrival >= 0) like.arriving().feed = own->arriving().feed;
    }
    return like;
  }
  return *parts_.ModelOf(to);
}

// What it would be like if it were seen: of that the travel alone.
Link LinkComposer::LikeHidden() const {
  const Link like = LikeWhat(true);
  Link form;
  form.travel_state = like.travel_state;
  form.z_before = form.z_behind = form.layer_behind = form.top = to_.first().z;
  if (like.arrival >= 0) {
    form.steps.push_back(like.arriving());
    form.arrival = 0;
  }
  return form;
}

void LinkComposer::ComposePlain() {
  const Link like = form_.hidden ? LikeHidden() : LikeWhat(form_.retracts);
  const Link left = Depart(like, TravelStateOf(like));
  const Link rise =
      Stretched(left.lift > like.lift ? left : like, LengthXy(link_.at(), to_.first()),
                donors_.highest_lift(), link_.machine().UnitMm());
  // A scarf seam begins lower than its layer.
  const Decimal height = std::max(to_.first().z, to_.last().z);
  AddOwn({StepKind::kSays, StepKind::kStay});
  TravelAs(like, height + rise.lift, rise);
  Arrive(like);
  AddOwn({StepKind::kComment});
  Settle(like);
}

// New travel has the accelerations and jerks that `like` has, for so does travel in this file. A
// slot that was never set here stays so, for nothing could undo it.
PrintState LinkComposer::TravelStateOf(const Link& like) const {
  PrintState state = to_.state();
  for (size_t slot = 0; slot < kSlotCount; ++slot) {
    if (state[slot] != 0 && like.travel_state[slot] != 0) state[slot] = like.travel_state[slot];
  }
  return state;
}

// The link that leads away from the path in the file, if what it does there fits here.
std::optional<Link> LinkComposer::OwnDeparture(const Link& like) const {
  if (!left_) return std::nullopt;
  if (!donors_.MayFollow(from_.placement().block + 1)) {
    // At marks the wipe alone is of the path.
    return form_.wipes && like.arrival >= 0 ? WithWipeOf(like, *left_) : std::nullopt;
  }
  if (left_->arrival < 0 || !left_->SameRetraction(like)) return std::nullopt;
  return *left_;
}

// What leads away from the path, up to where `travel` is set; returns the link that it is like.
Link LinkComposer::Depart(const Link& like, const PrintState& travel) {
  const std::optional<Link> own = form_.hidden ? std::nullopt : OwnDeparture(like);
  const bool exact = own && from_.as_given();
  const Link& link = own ? *own : like;
  const Decimal z = link_.at().z;
  const size_t sets = SetsTravelAt(link);
  if (sets == link.fixed) link_.Set(travel, kDynamicsSlots);
  if (!exact || !link.departs) GoOn();
  if (own ? !exact : like.retracts()) DepartAsOwn();
  bool wiped = false;
  for (size_t i = 0; link.Leaves(i); ++i) {
    const LinkStep& step = link.steps[i];
    if (i == sets && i > link.fixed) link_.Set(travel, kDynamicsSlots);
    if (IsXyMotion(step.kind)) {
      const bool departs = form_.departs && DepartureOf(link) == &step;
      if (exact && (step.kind == StepKind::kWipe || departs)) {
        Follow(step);
      } else if (step.kind == StepKind::kWipe && !wiped) {
        wiped = true;
        Wipe(link);
      }
    } else if (step.kind == StepKind::kWipeMark ||
               (exact && link.wipes && step.kind == StepKind::kFeed)) {
      Stay(step);
    } else if (step.kind != StepKind::kLift) {
      StayIfStill(step);
    } else if (step.to.z >= step.from.z) {
      LiftAs(step, z + (step.to.z - link.z_before));
    }
  }
  return link;
}

// A path that stands last before marks in the file, or here, is left as it is there, and one that
// begins elsewhere as it would be left there.
void LinkComposer::DepartAsOwn() {
  if (!left_ || !(from_.as_given() || form_.turned_departure)) return;
  if ((from_.block().flags & kBlockGoesOn) != 0) return;  // along the path: GoOn
  const LinkStep* departure = DepartureOf(*left_);
  if (departure == nullptr) return;
  if (from_.as_given()) {
    if (PullsBackBehind(*left_, *departure)) Follow(*departure);
    return;
  }
  Position to = InWords(*form_.turned_departure, link_.machine().UnitMm());
  to.z = link_.at().z;
  link_.Travel(departure->line.Raw(file_.text), to, departure->feed);
}

// A path that the file goes on along without filament is gone on along as far wherever it ends.
void LinkComposer::GoOn() {
  const LinkStep* step = left_ ? GoingOnAlong(from_.block(), *left_) : nullptr;
  if (step == nullptr) return;
  for (const Position& at : from_.Retrace(step->travel_mm)) {
    link_.Travel(step->line.Raw(file_.text), {at.x, at.y, link_.at().z}, step->feed);
  }
}

// Pulls back as much as the wipe of `like` does, over what was just printed. A path that is
// shorter than that wipe has less of it pulled while moving; the rest follows at its end.
void LinkComposer::Wipe(const Link& like) {
  const WipeForm wipe = WipeOf(like);
  const Position begin = link_.at();
  const std::vector<Position> retraced = from_.RetraceFrom(begin, wipe.travel_mm);
  double length = LengthXy(begin, retraced);
  // Rounding makes no wipe shorter.
  constexpr double kAsLong = 0.99;
  const bool shorter = wipe.still_feed > 0 && length < kAsLong * wipe.travel_mm;
  if (shorter) length = wipe.travel_mm;
  Decimal left = wipe.pulled;
  for (size_t i = 0; i < retraced.size(); ++i) {
    const double share = LengthXy(i == 0 ? begin : retraced[i - 1], retraced[i]) / length;
    const bool last = i + 1 == retraced.size() && !shorter;
    const Decimal pull = last ? left
                              : static_cast<Decimal>(static_cast<double>(wipe.pulled) * share) /
                                    kFilamentStep * kFilamentStep;
    left -= pull;
    link_.Segment(retraced[i], wipe.pulled > 0, -pull, wipe.feed);
  }
  if (left > 0) link_.Pull(left, shorter ? wipe.still_feed : wipe.feed);
}

void LinkComposer::StayIfStill(const LinkStep& step) {
  const bool still = MovesFilament(step.kind) || step.kind == StepKind::kSetE ||
                     step.kind == StepKind::kPlane || step.kind == StepKind::kDwell;
  if (still) Stay(step);
}

void LinkComposer::Follow(const LinkStep& step) {
  link_.Edited(step, file_, {step.to.x, step.to.y, link_.at().z});
}

void LinkComposer::LiftAs(const LinkStep& step, Decimal z) {
  if (z != link_.at().z) link_.Edited(step, file_, {link_.at().x, link_.at().y, z});
}

// The bends of the travel to the next path, and its end.
std::vector<Position> LinkComposer::BendsToNext() const {
  std::vector<Position> travel;
  for (const Point& bend : form_.travel.via) {
    travel.push_back(InWords(bend, link_.machine().UnitMm()));
  }
  travel.push_back(to_.first());
  return travel;
}

// Goes to the next path at the height `top`, or as high as the head is; where `rise` slopes up, up
// to there as `rise` does.
void LinkComposer::TravelAs(const Link& like, Decimal top, const Link& rise) {
  const Position& to = to_.first();
  const Decimal z = link_.at().z;
  if (like.arrival < 0) {
    if (!to.SameXy(link_.at())) link_.Segment(to, false, 0, link_.machine().feed);
    return;
  }
  const LinkStep& step = like.arriving();
  // Behind a line that is not understood the head may be elsewhere.
  const bool stays = to.SameXy(link_.at()) && like.fixed == 0;
  if (stays && z == to.z) return;
  top = std::max(top, z);
  std::vector<Position> travel = BendsToNext();
  for (Position& at : travel) at.z = top;
  if (like.sinks) travel.back().z = to.z;
  // No slope leads to where the head is.
  const bool on_slope = rise.ramp_mm > 0 && !stays;
  if (top > z && !on_slope) {
    link_.Lift(top, like.lift_feed > 0 ? like.lift_feed : step.feed);
  } else if (top > z) {
    Slope(link_.at(), rise, link_.machine().UnitMm(), travel);
  }
  for (const Position& at : travel) link_.Travel(step.line.Raw(file_.text), at, step.feed);
}

void LinkComposer::Arrive(const Link& like) {
  for (size_t i = static_cast<size_t>(like.arrival + 1); i < like.steps.size(); ++i) {
    const LinkStep& step = like.steps[i];
    if (step.kind == StepKind::kLift) {
      LiftAs(step, HeightBehindTravel(step, like));
    } else {
      StayIfStill(Balanced(step, like));
    }
  }
}

// Of a step of the arrival of `like`: where this path begins, if that behind `like` begins there;
// else as high above the layer as in the file.
Decimal LinkComposer::HeightBehindTravel(const LinkStep& step, const Link& like) const {
  const Decimal begin = to_.first().z;
  if (step.to.z == like.z_behind) return begin;
  return std::max(begin, std::max(begin, to_.last().z) + step.to.z - like.layer_behind);
}

// Step of `like`; a prime pushes as much more, or less, than was pulled back as in the file. Where
// E words are positions, each amount is off by what these are rounded by.
LinkStep LinkComposer::Balanced(LinkStep step, const Link& like) const {
  const Decimal off = link_.pulled() - like.pulled;
  const bool primes = step.kind == StepKind::kFilament && step.filament > 0;
  if (primes && !link_.machine().RelativeE() && std::abs(off) <= kRetractionSlack) {
    step.filament += off;
  }
  return step;
}

// The lines of these kinds that stand before the path in the file, unless marks do: together, and
// messages where the nozzle is not yet where it would leave a blob, as a beep may take a while.
// What tells a heater the same again (a message) is known by what stands before the link alone.
void LinkComposer::AddOwn(std::initializer_list<StepKind> kinds) {
  const Block& to = to_.block();
  if (IsBoundary(to) || (to.link & kLinkComments) == 0) return;
  for (const LinkStep& step : parts_.LinkTo(to_.placement().block)->steps) {
    const bool is_one = std::find(kinds.begin(), kinds.end(), step.kind) != kinds.end();
    if (is_one) link_.Raw(step.line.Raw(file_.text));
  }
}

void LinkComposer::Settle(const Link& like) {
  if (link_.at().z != to_.first().z) {
    const Decimal feed = like.lift_feed > 0  ? like.lift_feed
                         : like.arrival >= 0 ? like.arriving().feed
                                             : link_.machine().feed;
    link_.Lift(to_.first().z, feed);
  }
  link_.Set(to_.state(), kAllSlots);
  if (!to_.states_feed() && link_.machine().feed != to_.feed()) link_.Feed(to_.feed());
}

}  // namespace traverse::gcode
