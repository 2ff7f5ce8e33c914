// Links with the marks of a boundary.

#include <algorithm>

#include "client/gcode/link/composer.h"
#include "client/gcode/link/label_lines.h"
#include "client/gcode/model/part_links.h"

namespace traverse::gcode {
namespace {

// What a step of an arrival does to Z and filament.
bool Arrives(StepKind kind) {
  return kind == StepKind::kLift || kind == StepKind::kDwell || MovesFilament(kind);
}

}  // namespace

bool LinkComposer::LeavesAsGiven() const {
  return from_.as_given() && from_.placement().block + 1 == *form_.boundary;
}

// The link that leads to the path in the file, or else to another one that begins as low, if the
// path begins otherwise beside its layer's height than the one behind `link`, as scarf seams do,
// and is arrived at in this link as there.
std::shared_ptr<const Link> LinkComposer::OwnArrival(const Link& link) const {
  const uint32_t to = to_.placement().block;
  const Decimal rise = donors_.RiseOf(to);
  if (rise == donors_.RiseOf(*form_.boundary)) return nullptr;
  const bool marks = std::any_of(link.steps.begin() + link.arrival + 1, link.steps.end(), IsMark);
  if (marks) return nullptr;
  for (const auto& like : {std::optional(to), donors_.Find(to, link.retracts())}) {
    if (!like || donors_.RiseOf(*like) != rise) continue;
    std::shared_ptr<const Link> own = parts_.LinkTo(*like);
    const bool alike = own->arrival >= 0 && own->SameRetraction(link) &&
                       own->arrives_retracted == link.arrives_retracted;
    if (alike) return own;
  }
  return nullptr;
}

// As in the file; but what paths state before the travel that leads to them, they state so here,
// unless a script stands before it, or the head is led aside first.
PrintState LinkComposer::StateOfTravel(const Link& link) const {
  PrintState state = link.travel_state;
  const uint32_t to = to_.placement().block;
  if (to == *form_.boundary || link.fixed > 0 || LeadsAside(link)) return state;
  const PrintState& of_given = file_.states[file_.blocks[*form_.boundary].state_in];
  const PrintState own = parts_.LinkTo(to)->travel_state;
  for (size_t slot = 0; slot < kSlotCount; ++slot) {
    const bool of_path = state[slot] == of_given[slot] && own[slot] == to_.state()[slot];
    if (of_path && state[slot] != 0 && own[slot] != 0) state[slot] = own[slot];
  }
  return state;
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
  } else if (!MarksObjectsOnly(link) && (from_.block().object == before.object ||
                                         (file_.blocks[boundary].link & kLinkNewLayer) != 0)) {
    // Whatever was printed last: at its marks the fan is as in the file.
    link_.Set(file_.states[before.state_out], kFanSlots & ~SetBeforeMarks(link));
  }
  const bool as_given = LeavesAsGiven();
  // Pulled back at once, so that it is at the height of what was printed.
  std::optional<Link> like;
  if (form_.retracts && !link.arrives_retracted && link.arrival >= 0) like = LikeWhat(true);
  const PrintState travel = StateOfTravel(link);
  const size_t sets = like ? link.fixed : SetsTravelAt(link);
  if (sets == link.fixed) link_.Set(travel, kDynamicsSlots);
  // But not before the label of an object, if it comes at the same height.
  const bool behind_label = like && LabelsBeforeTravel(link);
  if (like && !behind_label) {
    Depart(*like, travel);
  } else if (!like && link.fixed == 0 && !(as_given && link.departs)) {
    GoOn();
    if (!as_given && link.retracts()) DepartAsOwn();
  }
  const std::shared_ptr<const Link> own = link.arrival >= 0 ? OwnArrival(link) : nullptr;
  const std::vector<std::string_view> labelled =
      LabelledLines(file_, link, boundary, from_.placement().block, to_.placement().block);
  for (size_t i = link.fixed; i < link.steps.size(); ++i) {
    const StepKind kind = link.steps[i].kind;
    if (i == sets && i > link.fixed) link_.Set(travel, kDynamicsSlots);
    if (kind == StepKind::kProgress && form_.without_progress) continue;
    if (kind == StepKind::kLabel || kind == StepKind::kStay || kind == StepKind::kSays) {
      link_.Raw(labelled[i]);
    } else if (static_cast<int>(i) != link.arrival) {
      if (own == nullptr || link.Leaves(i) || !Arrives(kind)) ComposeBoundaryStep(link, i);
    } else if (like) {
      if (behind_label) Depart(*like, travel);
      TravelAs(link, std::max(link.top, to_.first().z + like->lift), *like);
      Arrive(*like);
    } else {
      TravelToBoundary(link);
      if (own != nullptr) Arrive(*own);
    }
  }
  if (to_.placement().block != boundary) {
    AddOwn({StepKind::kSays, StepKind::kStay});
    AddOwn({StepKind::kComment});
  }
  Settle(link);
}

// Most travel to layers rises, but not what led here in the file, perhaps as it was short.
void LinkComposer::TravelToBoundary(const Link& link) {
  const Decimal z = to_.first().z;
  const bool rises = LeavesAsGiven() || link.lift > 0 || !link.retracts() || link.top != z;
  const Decimal lift = rises || link.lift_feed == 0 ? 0 : donors_.LiftToLayer(*form_.boundary);
  TravelAs(link, link.top + lift, link);
  if (lift > 0) link_.Lift(z, link.lift_feed);
}

void LinkComposer::ComposeBoundaryStep(const Link& link, size_t i) {
  const LinkStep& step = link.steps[i];
  const std::string_view raw = step.line.Raw(file_.text);
  const bool as_given = LeavesAsGiven();
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
      if (link.Leaves(i) || to_.placement().block == *form_.boundary)
        return LiftAs(step, step.to.z);
      return LiftAs(step, HeightBehindTravel(step, link));
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
      Stay(Balanced(step, link));
  }
}

}  // namespace traverse::gcode
