#include "client/gcode/link/link.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "client/gcode/model/arc.h"

namespace traverse::gcode {
namespace {

void NoteRetraction(const LinkStep& step, Decimal& retracted, Link& link) {
  if (step.kind == StepKind::kFirmwareRetract) link.firmware = true;
  retracted = std::max<Decimal>(retracted - step.filament, 0);
  link.pulled = std::max(link.pulled, retracted);
}

LinkStep StepOf(const Step& step, const MachineState& after) {
  LinkStep taken;
  taken.kind = step.kind;
  taken.line = step.line;
  taken.from = step.from;
  taken.to = after.at;
  taken.filament = step.kind == StepKind::kSetE ? step.command.Value('E') : step.filament;
  taken.e = after.e;
  taken.feed = after.feed;
  taken.slots = step.slots;
  taken.arc = step.arc;
  taken.relative = step.relative;
  if (step.command.kind == LineKind::kCommand) taken.words = step.command.words;
  if (IsXyMotion(step.kind)) {
    taken.travel_mm = step.arc ? ArcLength(step.command, step.from, after.at, 1)
                               : std::hypot(ToDouble(after.at.x - step.from.x),
                                            ToDouble(after.at.y - step.from.y));
  }
  return taken;
}

// How the travel proper comes to its height.
void NoteLift(Link& link) {
  for (const LinkStep& step : link.steps) {
    if (step.kind == StepKind::kLift && step.feed > 0) link.lift_feed = step.feed;
  }
  if (link.arrival < 0) return;
  const LinkStep& arrival = link.steps[static_cast<size_t>(link.arrival)];
  const Decimal top = std::max(arrival.from.z, arrival.to.z);
  link.lift = std::max<Decimal>(0, top - std::max(link.z_before, link.z_behind));
  link.top = std::max(top, link.z_behind);
  link.sinks = link.lift == 0 && arrival.to.z < arrival.from.z && arrival.to.z == link.z_behind;
  for (size_t i = link.fixed; i <= static_cast<size_t>(link.arrival); ++i) {
    const LinkStep& step = link.steps[i];
    if (step.kind == StepKind::kTravel && step.to.z > step.from.z) link.ramp_mm += step.travel_mm;
  }
  link.ramp_ends = link.ramp_mm > 0 && arrival.to.z == arrival.from.z;
}

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
struct Pull {
  std::vector<LinkStep> steps;
  size_t begin = 0;  // the first and the last of them are steps [begin, end) of the link
  size_t end = 0;
  Decimal pulled = 0;
  bool wipes = false;
  bool firmware = false;
  bool behind_marks = false;  // or behind other steps

  bool any() const { return pulled > 0 || firmware; }
  bool Replaces(const Pull& other) const {
    return any() && other.any() && firmware == other.firmware &&
           std::abs(pulled - other.pulled) <= kRetractionSlack;
  }
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
    } else if (pull.any() || step.kind == StepKind::kTravel) {
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

// The first `steps` of `link` stay, and leave `behind`.
void Keep(size_t steps, const PartStart& behind, Link& link) {
  link.fixed = steps;
  link.behind_fixed = behind;
  link.arrival = -1;
}

}  // namespace

std::optional<Link> WithWipeOf(Link form, const Link& own) {
  assert(form.arrival >= 0);
  const Pull pull = PullOf(own);
  // At marks the wipes of other paths serve as well.
  if (!pull.wipes || (pull.behind_marks && form.wipes) || form.fixed > 0 ||
      pull.firmware != form.firmware || std::abs(pull.pulled - form.pulled) > kRetractionSlack) {
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
  if (given.wipes == pull.wipes || !pull.Replaces(given)) return std::nullopt;
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

Link ReadLink(const GcodeFile& file, size_t index) {
  assert(index < file.blocks.size());
  if (index == 0) return {};
  const Block& before = file.blocks[index - 1];
  const Block& behind = file.blocks[index];
  Link link;
  link.z_before = before.last.z;
  link.z_behind = behind.first.z;
  link.layer_behind = std::max(behind.first.z, behind.last.z);
  link.departs = MayDepart(file, index);
  PartStart start = StartBehind(file, before);
  Interpreter interpreter(std::string_view(file.text).substr(0, behind.begin), before.end,
                          start.machine);
  Decimal retracted = 0;
  PrintState state = start.state;
  bool marked = false;
  const bool aside = (behind.link & kLinkAside) != 0;
  // The steps up to the last travel, and what they leave behind.
  size_t up_to_travel = 0;
  PartStart behind_travel;
  for (Step step; interpreter.Next(step);) {
    LinkStep added = StepOf(step, interpreter.state());
    marked = marked || added.kind == StepKind::kWipeMark;
    // A wipe's pull may round to nothing.
    if (added.kind == StepKind::kZeroExtrude) {
      added.kind = step.retracted || marked ? StepKind::kWipe : StepKind::kTravel;
    }
    if (added.kind != StepKind::kSetE) NoteRetraction(added, retracted, link);
    link.wipes = link.wipes || added.kind == StepKind::kWipe;
    if (added.kind == StepKind::kSlot) {
      ApplySetter(state, file.setters.Find(step.line.Text(file.text)), step.slots);
    }
    const bool travels_on = aside && added.kind == StepKind::kTravel;
    if (travels_on && up_to_travel > link.fixed) {
      Keep(up_to_travel, behind_travel, link);
    }
    // If CuraEngine primes before the last stretch of the travel, the travel proper ends there.
    const bool behind_prime = link.retracts() && !step.retracted;
    if (added.kind == StepKind::kTravel && (link.arrival < 0 || !behind_prime)) {
      link.arrival = static_cast<int>(link.steps.size());
      link.arrives_retracted = step.retracted;
      link.travel_state = state;
    }
    link.steps.push_back(added);
    if (travels_on) {
      up_to_travel = link.steps.size();
      behind_travel = {interpreter.state(), state};
    }
    const bool of_script = step.line.begin < file.script_end;
    if (added.kind == StepKind::kUnknown || added.kind == StepKind::kModeChange || of_script) {
      // Of so many lines that stay nothing matters but where they end.
      if (link.steps.size() >= Interpreter::kMostOfLink) {
        link.steps = {added};
        link.departs = false;
        up_to_travel = 0;
      }
      Keep(link.steps.size(), {interpreter.state(), state}, link);
    }
  }
  NoteLift(link);
  return link;
}

const LinkStep* GoingOnAlong(const Block& block, const Link& link) {
  if ((block.flags & kBlockGoesOn) == 0) return nullptr;
  const auto first = std::find_if(link.steps.begin(), link.steps.end(), [](const LinkStep& step) {
    return step.kind == StepKind::kTravel;
  });
  return first != link.steps.end() ? &*first : nullptr;
}

bool MayDepart(const GcodeFile& file, size_t index) {
  if ((file.blocks[index - 1].flags & kBlockGoesOn) != 0) return true;
  return !file.slicer.combs && (file.blocks[index].link & kLinkDeparts) != 0;
}

const LinkStep* DepartureOf(const Link& link) {
  if (!link.departs) return nullptr;
  const auto first = std::find_if(link.steps.begin(), link.steps.end(),
                                  [](const LinkStep& step) { return IsXyMotion(step.kind); });
  const auto place = static_cast<size_t>(first - link.steps.begin());
  const bool departs = first != link.steps.end() && first->kind == StepKind::kTravel;
  return departs && link.Leaves(place) ? &*first : nullptr;
}

bool PrimesBefore(const Link& link, size_t i) {
  return std::any_of(link.steps.begin(), link.steps.begin() + static_cast<std::ptrdiff_t>(i),
                     Primes);
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
    const bool mark = step.kind == StepKind::kLayerMark || step.kind == StepKind::kLabel ||
                      step.kind == StepKind::kStay;
    if (mark) break;
    slots |= step.slots;
  }
  return slots;
}

}  // namespace traverse::gcode
