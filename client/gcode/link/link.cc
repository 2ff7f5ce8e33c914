#include "client/gcode/link/link.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <iterator>
#include <utility>

namespace traverse::gcode {
namespace {

bool IsOfPull(const LinkStep& step) {
  return (step.kind == StepKind::kFilament && step.filament < 0) ||
         step.kind == StepKind::kFirmwareRetract || step.kind == StepKind::kDwell ||
         step.kind == StepKind::kWipe || step.kind == StepKind::kWipeMark ||
         step.kind == StepKind::kFeed;
}

bool Primes(const LinkStep& step) {
  return step.filament > 0 || step.kind == StepKind::kFirmwareUnretract;
}

bool SaysNothing(const LinkStep& step) {
  return step.kind == StepKind::kBlank || step.kind == StepKind::kComment ||
         step.kind == StepKind::kSlot || step.kind == StepKind::kProgress ||
         step.kind == StepKind::kSays;
}

// How a link first pulls filament back, before any travel and whatever mark stands before that.
struct Pull : Retraction {
  std::vector<LinkStep> steps;
  size_t begin = 0;  // the first and the last of them are steps [begin, end) of the link
  size_t end = 0;
  bool behind_marks = false;  // or behind other steps
};

Pull PullOf(const Link& link) {
  Pull pull;
  for (size_t i = link.fixed; i < link.steps.size(); ++i) {
    const LinkStep& step = link.steps[i];
    if (SaysNothing(step)) continue;
    if (IsOfPull(step)) {
      if (pull.steps.empty()) pull.begin = i;
      pull.end = i + 1;
      pull.steps.push_back(step);
      pull.pulled -= step.filament;
      pull.wipes = pull.wipes || step.kind == StepKind::kWipe;
      pull.firmware = pull.firmware || step.kind == StepKind::kFirmwareRetract;
    } else if (pull.retracts() || step.kind == StepKind::kTravel) {
      break;
    } else {
      pull = {};
      pull.behind_marks = true;
    }
  }
  return pull;
}

bool StaysWithTravel(const LinkStep& step) {
  return step.kind == StepKind::kLift || step.kind == StepKind::kPlane ||
         step.kind == StepKind::kSetE;
}

}  // namespace

std::optional<Link> WithWipeOf(Link form, const Link& own) {
  assert(form.arrival >= 0);
  const Pull pull = PullOf(own);
  // At marks the wipes of other paths serve as well.
  if (!pull.wipes || (pull.behind_marks && form.wipes) || form.fixed > 0 ||
      !pull.SameRetraction(form)) {
    return std::nullopt;
  }
  std::vector<LinkStep> steps = pull.steps;
  const auto arrival = form.steps.begin() + form.arrival;
  std::copy_if(form.steps.begin(), arrival, std::back_inserter(steps), StaysWithTravel);
  form.arrival = static_cast<int>(steps.size());
  steps.insert(steps.end(), arrival, form.steps.end());
  form.steps = std::move(steps);
  form.wipes = true;
  form.departs = false;
  return form;
}

std::optional<Link> WithPullOf(const Link& link, const Link& own) {
  const Pull given = PullOf(link);
  const Pull pull = PullOf(own);
  const bool replaces = given.retracts() && pull.retracts() && pull.SameRetraction(given);
  if (given.wipes == pull.wipes || !replaces) return std::nullopt;
  Link out = link;
  out.steps.assign(link.steps.begin(),
                   link.steps.begin() + static_cast<std::ptrdiff_t>(given.begin));
  out.steps.insert(out.steps.end(), pull.steps.begin(), pull.steps.end());
  for (size_t i = given.begin; i < link.steps.size(); ++i) {
    if (static_cast<int>(i) == link.arrival) out.arrival = static_cast<int>(out.steps.size());
    if (i >= given.end || SaysNothing(link.steps[i])) out.steps.push_back(link.steps[i]);
  }
  out.wipes = pull.wipes;
  return out;
}

const LinkStep* GoingOnAlong(const Block& block, const Link& link) {
  if ((block.flags & kBlockGoesOn) == 0) return nullptr;
  const auto first = std::ranges::find(link.steps, StepKind::kTravel, &LinkStep::kind);
  return first != link.steps.end() ? &*first : nullptr;
}

bool MayDepart(const GcodeFile& file, size_t index) {
  return (file.blocks[index - 1].flags & kBlockGoesOn) != 0 ||
         (file.blocks[index].link & kLinkDeparts) != 0;
}

const LinkStep* DepartureOf(const Link& link) {
  if (!link.departs) return nullptr;
  const auto first = std::ranges::find_if(link.steps, IsXyMotion, &LinkStep::kind);
  const auto place = static_cast<size_t>(first - link.steps.begin());
  const bool departs = first != link.steps.end() && first->kind == StepKind::kTravel;
  return departs && link.Leaves(place) ? &*first : nullptr;
}

bool PrimesBefore(const Link& link, size_t i) {
  return std::any_of(link.steps.begin(), link.steps.begin() + static_cast<std::ptrdiff_t>(i),
                     Primes);
}

size_t SetsTravelAt(const Link& link) {
  bool wipes = false;
  for (size_t i = link.fixed; link.Leaves(i); ++i) {
    const LinkStep& step = link.steps[i];
    if (step.kind == StepKind::kSlot && (step.slots & kDynamicsSlots) != 0) {
      return wipes ? i : link.fixed;
    }
    wipes = wipes || step.kind == StepKind::kWipe;
  }
  return link.fixed;
}

WipeForm WipeOf(const Link& link) {
  WipeForm form;
  for (const LinkStep& step : link.steps) {
    if (Primes(step)) break;
    if (step.kind == StepKind::kFilament && step.filament < 0) form.still_feed = step.feed;
    if (step.kind != StepKind::kWipe) continue;
    form.travel_mm += step.travel_mm;
    form.pulled -= step.filament;
    form.feed = step.feed;
  }
  return form;
}

bool PullsBackBehind(const Link& link, const LinkStep& departure) {
  if (link.fixed > 0) return false;
  const auto behind = link.steps.begin() + (&departure - link.steps.data()) + 1;
  const auto next = std::find_if(behind, link.steps.end(), [](const LinkStep& step) {
    return IsXyMotion(step.kind) || step.filament != 0 || step.kind == StepKind::kFirmwareRetract;
  });
  return next != link.steps.end() && next->kind != StepKind::kTravel;
}

bool LabelsBeforeTravel(const Link& link) {
  bool labels = false;
  for (size_t i = link.fixed; link.Leaves(i); ++i) {
    const StepKind kind = link.steps[i].kind;
    if (kind == StepKind::kLift || kind == StepKind::kLayerMark) return false;
    labels = labels || kind == StepKind::kLabel;
  }
  return labels;
}

bool LeadsAside(const Link& link, size_t i) {
  for (size_t j = i + 1; j < link.steps.size() && static_cast<int>(j) < link.arrival; ++j) {
    if (link.steps[j].kind == StepKind::kTravel) return false;
    if (link.steps[j].kind == StepKind::kLift && link.steps[j].to.z < link.z_before) return true;
  }
  return false;
}

bool LeadsAside(const Link& link) {
  for (size_t i = 0; i < link.steps.size(); ++i) {
    if (link.steps[i].kind == StepKind::kTravel && LeadsAside(link, i)) return true;
  }
  return false;
}

bool IsMark(const LinkStep& step) {
  return step.kind == StepKind::kLayerMark || step.kind == StepKind::kLabel ||
         step.kind == StepKind::kStay;
}

bool MarksObjectsOnly(const Link& link) {
  bool labels = false;
  for (const LinkStep& step : link.steps) {
    if (step.kind == StepKind::kLayerMark || step.kind == StepKind::kStay) return false;
    labels = labels || step.kind == StepKind::kLabel;
  }
  return labels;
}

SlotMask SetBeforeMarks(const Link& link) {
  SlotMask slots = 0;
  for (const LinkStep& step : link.steps) {
    if (IsMark(step)) break;
    slots |= step.slots;
  }
  return slots;
}

}  // namespace traverse::gcode
