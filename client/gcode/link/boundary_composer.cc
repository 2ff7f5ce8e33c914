// Links with the marks of a boundary.

#include "client/gcode/link/composer.h"
#include "client/gcode/link/label_lines.h"
#include "client/gcode/model/part_links.h"

namespace traverse::gcode {

bool LinkComposer::LeavesAsGiven(uint32_t boundary) const {
  return from_.as_given() && from_.placement().block + 1 == boundary;
}

void LinkComposer::ComposeBoundary() {
  const uint32_t boundary = *form_.boundary;
  // A wipe is of the path before it, wherever the label stands. But layers that the file leaves
  // without one are left so.
  const bool of_path = left_ && (file_.blocks[boundary].link & kLinkNewLayer) == 0;
  const std::shared_ptr<const Link> read = parts_.LinkTo(boundary);
  const std::optional<Link> changed = of_path ? WithPullOf(*read, *left_) : std::nullopt;
  const Link& link = changed ? *changed : *read;
  const Block& before = file_.blocks[boundary - 1];
  if (link.fixed > 0) {
    link_.Keep({before.end, link.steps[link.fixed - 1].line.next, StartBehind(file_, before),
                link.behind_fixed});
  } else if (from_.block().object == before.object ||
             (file_.blocks[boundary].link & kLinkNewLayer) != 0) {
    // Whatever was printed last: at its marks the fan is as in the file.
    link_.Set(file_.states[before.state_out], kFanSlots & ~SetBeforeMarks(link));
  }
  link_.Set(link.travel_state, kDynamicsSlots);
  const bool as_given = LeavesAsGiven(boundary);
  // Pulled back at once, so that it is at the height of what was printed.
  std::optional<Link> like;
  if (form_.retracts && !link.arrives_retracted && link.arrival >= 0) like = LikeWhat(true);
  // But not before the label of an object, if it comes at the same height.
  const bool behind_label = like && LabelsBeforeTravel(link);
  if (like && !behind_label) {
    Depart(*like);
  } else if (!like && link.fixed == 0 && !(as_given && link.departs)) {
    GoOn();
    if (!as_given && link.retracts()) DepartAsOwn();
  }
  const ExchangedLabels labels(file_, link, boundary, from_.placement().block,
                               to_.placement().block);
  for (size_t i = link.fixed; i < link.steps.size(); ++i) {
    const StepKind kind = link.steps[i].kind;
    if (kind == StepKind::kProgress && form_.without_progress) continue;
    if (kind == StepKind::kLabel || kind == StepKind::kStay || kind == StepKind::kSays) {
      link_.Raw(labels.LineOf(i));
    } else if (static_cast<int>(i) != link.arrival) {
      ComposeBoundaryStep(link, i);
    } else if (like) {
      if (behind_label) Depart(*like);
      TravelAs(link, std::max(link.top, to_.first().z + like->lift), *like);
      Arrive(*like);
    } else {
      TravelToBoundary(link);
    }
  }
  const uint32_t to = to_.placement().block;
  if (to != boundary && !IsBoundary(file_.blocks[to])) {
    AddSaid();
    AddComments();
  }
  Settle(link);
}

// Most travel to layers rises, but not what led here in the file, perhaps as it was short.
void LinkComposer::TravelToBoundary(const Link& link) {
  const Decimal z = to_.first().z;
  const bool rises =
      LeavesAsGiven(*form_.boundary) || link.lift > 0 || !link.retracts() || link.top != z;
  const Decimal lift = rises || link.lift_feed == 0 ? 0 : donors_.LiftToLayer(*form_.boundary);
  TravelAs(link, link.top + lift, link);
  if (lift > 0) link_.Lift(z, link.lift_feed);
}

void LinkComposer::ComposeBoundaryStep(const Link& link, size_t i) {
  const LinkStep& step = link.steps[i];
  const std::string_view raw = step.line.Raw(file_.text);
  const bool as_given = LeavesAsGiven(*form_.boundary);
  switch (step.kind) {
    case StepKind::kTravel:
      if (LeadsAside(link, i)) return link_.Travel(raw, step.to, step.feed);
      if (as_given && DepartureOf(link) == &step) Follow(step);
      return;
    case StepKind::kWipe: {
      // Where the head has come down aside, not along the path.
      if (as_given || PrimesBefore(link, i)) return Follow(step);
      for (size_t before = 0; before < i; ++before) {
        if (link.steps[before].kind == StepKind::kWipe) return;
      }
      return Wipe(link);
    }
    case StepKind::kLift:
      // A departure of another link may have lifted the head higher.
      if (link.Leaves(i) && step.to.z >= step.from.z && link_.at().z > step.to.z) return;
      // Behind the travel, the path of the file may begin lower than this one, as scarf seams do.
      return LiftAs(step, link.Leaves(i) ? step.to.z : to_.first().z + (step.to.z - link.z_behind));
    case StepKind::kSlot:
      // What another path is printed under is set at its beginning, once.
      if ((step.slots & kDynamicsSlots) != 0 &&
          (link.Leaves(i) || to_.placement().block != *form_.boundary)) {
        return;
      }
      return link_.SetBy(raw, step.slots);
    case StepKind::kRelative:  // lifts are written as heights
      return;
    default:
      Stay(step);
  }
}

}  // namespace traverse::gcode
