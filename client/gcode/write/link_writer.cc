#include "client/gcode/write/link_writer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "client/gcode/write/label_lines.h"
#include "client/gcode/write/positions.h"

namespace traverse::gcode {
namespace {

// What is left of a travel move behind a slope is at least this long.
constexpr double kMinSlopeRestMm = 0.5;

bool IsSoft(const Block& block) { return (block.link & (kLinkSplits | kLinkFixed)) == 0; }

// `rise` for travel of `length`: a slope that lasts as long as its travel rises on, up to
// `highest`.
Link Stretched(Link rise, double length, Decimal highest) {
  if (rise.ramp_ends || !(rise.ramp_mm > 0) || length <= rise.ramp_mm) return rise;
  const double steepness = static_cast<double>(rise.lift) / rise.ramp_mm;
  const auto reached = static_cast<double>(std::max(highest, rise.lift));
  rise.ramp_ends = steepness * length > reached;
  rise.ramp_mm = rise.ramp_ends ? reached / steepness : length;
  // As slicers write heights: to micrometres.
  rise.lift = RoundedWord(steepness * rise.ramp_mm * 1e-9);
  return rise;
}

// Puts the end of the slope of `rise` on the first stretch of `travel` from `from`, if that is
// longer; else it rises over all of that stretch.
void Slope(const Position& from, const Link& rise, std::vector<Position>& travel) {
  if (!rise.ramp_ends) return;
  if (LengthXy(from, travel.front()) < rise.ramp_mm + kMinSlopeRestMm) return;
  Position end = Along(from, travel.front(), rise.ramp_mm);
  end.z = travel.front().z;
  travel.insert(travel.begin(), end);
}

bool IsDeparture(const Link& link, size_t i) { return DepartureOf(link) == &link.steps[i]; }

}  // namespace

void LinkWriter::Write(const LinkRequest& request) {
  const uint32_t to = request.to->placement().block;
  const bool follows =
      request.from->placement().block + 1 == to && (!request.boundary || *request.boundary == to);
  if (follows && request.from->as_given() && request.to->as_given() && !request.hidden) {
    return WriteGiven(request);
  }
  if (request.boundary) return WriteBoundary(request);
  WritePlain(request);
}

void LinkWriter::WriteGiven(const LinkRequest& request) {
  const Block& from = request.from->block();
  const Block& to = request.to->block();
  PartStart behind = StartBehind(file_, to);
  behind.state = file_.states[to.state_in];
  behind.machine.at = to.first;
  behind.machine.e = to.e_in;
  // The F word of the path's own first line is not part of the link; that its feed rate is taken
  // for set already changes nothing.
  behind.machine.feed = to.feed_in;
  out_.Copy(from.end, to.begin, StartBehind(file_, from), behind, request.without_progress);
}

Link LinkWriter::TemplateFor(const LinkRequest& request) const {
  const uint32_t to = request.to->placement().block;
  if (donors_.MayFollow(to) && !donors_.LacksLift(to)) {
    Link own = ReadLink(file_, to);
    const bool fits = own.retracts() == request.retract && (own.wipes || !request.wipe);
    if (fits && own.arrival >= 0) return own;
  }
  for (const bool retracts : {request.retract, !request.retract}) {
    // Where no travel of the file is open, this is retracted, and so the path is wiped.
    const bool wipes = file_.WipedBehind(request.from->placement().block);
    // Where there is no way to go, there is none to retract for.
    if (retracts && !request.retract && request.to->first().SameXy(out_.at.machine.at)) return {};
    const std::optional<uint32_t> donor = donors_.Find(to, retracts, retracts && wipes);
    if (!donor) continue;
    Link link = ReadLink(file_, *donor);
    if (link.arrival < 0) continue;
    if (const std::optional<uint32_t> pace = donors_.PaceFor(to, *donor)) {
      const Link own = ReadLink(file_, *pace);
      if (own.arrival >= 0)
        link.steps[static_cast<size_t>(link.arrival)].feed =
            own.steps[static_cast<size_t>(own.arrival)].feed;
    }
    return link;
  }
  return ReadLink(file_, to);
}

// As the file's own open travel; where it has none, as its retracted travel: of both the travel
// alone.
Link LinkWriter::HiddenTemplateFor(const LinkRequest& request) const {
  const Link like = TemplateFor(request);
  Link form;
  form.travel_state = like.travel_state;
  form.z_before = form.z_behind = form.top = request.to->first().z;
  if (like.arrival >= 0) {
    form.steps.push_back(like.steps[static_cast<size_t>(like.arrival)]);
    form.arrival = 0;
  }
  return form;
}

void LinkWriter::WritePlain(const LinkRequest& request) {
  const Link form = request.hidden ? HiddenTemplateFor(request) : TemplateFor(request);
  SetTravelState(*request.to, form);
  const Link left = WriteDeparture(request, form);
  const Link rise =
      Stretched(left.lift > form.lift ? left : form,
                LengthXy(out_.at.machine.at, request.to->first()), donors_.highest_lift());
  WriteTravel(request, form, request.to->first().z + rise.lift, rise);
  WriteArrival(request, form);
  if (IsSoft(request.to->block())) WriteComments(request.to->placement().block);
  Settle(request, form);
}

// New travel has the accelerations and jerks that `form` has, for so does travel in this file. A
// slot that was never set here stays so, for nothing could undo it.
void LinkWriter::SetTravelState(const PlacedPath& to, const Link& form) {
  PrintState state = to.state();
  for (size_t slot = 0; slot < kSlotCount; ++slot) {
    if (state[slot] != 0 && form.travel_state[slot] != 0) state[slot] = form.travel_state[slot];
  }
  out_.Set(state, kDynamicsSlots);
}

// The link that leads away from the path in the file, if what it does there fits here.
std::optional<Link> LinkWriter::OwnDeparture(const LinkRequest& request, const Link& form) const {
  const uint32_t next = request.from->placement().block + 1;
  if (next >= file_.blocks.size()) return std::nullopt;
  Link own = ReadLink(file_, next);
  if (!donors_.MayFollow(next)) {
    // At marks the wipe alone is of the path.
    return request.wipe && form.arrival >= 0 ? WithWipeOf(form, own) : std::nullopt;
  }
  if (own.arrival < 0 || !own.SameRetraction(form)) return std::nullopt;
  return own;
}

// Writes what leads away from the path; returns the link that it follows.
Link LinkWriter::WriteDeparture(const LinkRequest& request, const Link& form) {
  const std::optional<Link> own = request.hidden ? std::nullopt : OwnDeparture(request, form);
  const bool exact = own && request.from->as_given();
  const Link& link = own ? *own : form;
  const Decimal z = out_.at.machine.at.z;
  if (!exact || !link.departs) WriteGoingOn(request);
  if (own ? !exact : form.retracts()) WriteOwnDeparture(request);
  bool wiped = false;
  for (size_t i = 0; link.Leaves(i); ++i) {
    const LinkStep& step = link.steps[i];
    if (IsXyMotion(step.kind)) {
      const bool departs = request.departs && IsDeparture(link, i);
      if (exact && (step.kind == StepKind::kWipe || departs)) {
        out_.MoveLine(step);
      } else if (step.kind == StepKind::kWipe && !wiped) {
        wiped = true;
        WriteWipe(*request.from, link);
      }
    } else if (step.kind == StepKind::kWipeMark ||
               (exact && link.wipes && step.kind == StepKind::kFeed)) {
      out_.LinkLine(step);
    } else if (step.kind != StepKind::kLift || step.to.z >= step.from.z) {
      WriteMotion(step, link.z_before, z);
    }
  }
  return link;
}

// A path that stands last before marks in the file, or here, is left as it is there, and one that
// begins elsewhere as it would be left there.
void LinkWriter::WriteOwnDeparture(const LinkRequest& request) {
  const PlacedPath& from = *request.from;
  const uint32_t next = from.placement().block + 1;
  if (!(from.as_given() || request.turned_departure) || next >= file_.blocks.size()) return;
  if ((from.block().flags & kBlockGoesOn) != 0) return;  // along the path: WriteGoingOn
  const Link own = ReadLink(file_, next);
  const LinkStep* departure = DepartureOf(own);
  if (departure == nullptr) return;
  if (from.as_given()) {
    if (PullsBackBehind(own, *departure)) out_.MoveLine(*departure);
    return;
  }
  Position to = InWords(*request.turned_departure, out_.at.machine.UnitMm());
  to.z = out_.at.machine.at.z;
  out_.Travel(departure->line.Raw(file_.text), to, departure->feed);
}

// A path that the file goes on along without filament is gone on along as far wherever it ends.
void LinkWriter::WriteGoingOn(const LinkRequest& request) {
  const PlacedPath& from = *request.from;
  const std::optional<LinkStep> step = ReadGoingOn(file_, from.placement().block);
  if (!step) return;
  for (const Position& at : from.Retrace(step->travel_mm)) {
    out_.Travel(step->line.Raw(file_.text), {at.x, at.y, out_.at.machine.at.z}, step->feed);
  }
}

void LinkWriter::WriteArrival(const LinkRequest& request, const Link& form) {
  for (size_t i = static_cast<size_t>(form.arrival + 1); i < form.steps.size(); ++i) {
    WriteMotion(form.steps[i], form.z_behind, request.to->first().z);
  }
}

// Pulls back as much as the wipe of `form` does, over what was just printed. A path that is
// shorter than that wipe has less of it pulled while moving; the rest follows at its end.
void LinkWriter::WriteWipe(const PlacedPath& path, const Link& form) {
  const WipeForm wipe = WipeOf(form);
  const Position begin = out_.at.machine.at;
  const std::vector<Position> retraced = path.RetraceFrom(begin, wipe.travel_mm);
  double length = LengthXy(begin, retraced);
  // Rounding makes no wipe shorter.
  constexpr double kAsLong = 0.99;
  const bool shorter = wipe.still_feed > 0 && length < kAsLong * wipe.travel_mm;
  if (shorter) length = wipe.travel_mm;
  Decimal left = wipe.pulled;
  for (size_t i = 0; i < retraced.size(); ++i) {
    const double share = LengthXy(i == 0 ? begin : retraced[i - 1], retraced[i]) / length;
    const bool last = i + 1 == retraced.size() && !shorter;
    // Rounded as slicers write E: to hundredths of a micrometre.
    constexpr Decimal kStep = kDecimalOne / 100'000;
    const Decimal pull =
        last ? left
             : static_cast<Decimal>(static_cast<double>(wipe.pulled) * share) / kStep * kStep;
    left -= pull;
    out_.Segment("G1", retraced[i], wipe.pulled > 0, -pull, wipe.feed, {}, {});
  }
  if (left > 0) out_.Pull(left, shorter ? wipe.still_feed : wipe.feed);
}

// Writes a step that moves filament or Z alone; Z relative to the height of what is printed.
void LinkWriter::WriteMotion(const LinkStep& step, Decimal z_form, Decimal z_here) {
  switch (step.kind) {
    case StepKind::kFilament:
    case StepKind::kSetE:
    case StepKind::kFirmwareRetract:
    case StepKind::kFirmwareUnretract:
    case StepKind::kPlane:
    case StepKind::kDwell:
      return out_.LinkLine(step);
    case StepKind::kLift:
      return out_.LiftLine(step, z_here + (step.to.z - z_form));
    default:
      return;
  }
}

// The bends of the travel to `request.to`, and its end.
std::vector<Position> LinkWriter::TravelTo(const LinkRequest& request) const {
  const MachineState& machine = out_.at.machine;
  std::vector<Position> travel;
  for (const Vertex& bend : request.hidden_bends) {
    travel.push_back(InWords(bend, machine.UnitMm()));
  }
  if (request.detours != nullptr) {
    for (const Vertex bend :
         request.detours->Around(machine.InMm(machine.at), machine.InMm(request.to->first()))) {
      travel.push_back(InWords(bend, machine.UnitMm()));
    }
  }
  travel.push_back(request.to->first());
  return travel;
}

// Goes to `request.to` at the height `top`, or as high as the head is; where `rise` slopes up, up
// to there as `rise` does.
void LinkWriter::WriteTravel(const LinkRequest& request, const Link& form, Decimal top,
                             const Link& rise) {
  const Position& to = request.to->first();
  const Decimal z = out_.at.machine.at.z;
  if (form.arrival < 0) {
    if (!to.SameXy(out_.at.machine.at)) {
      out_.Segment("G1", to, false, 0, out_.at.machine.feed, {}, {});
    }
    return;
  }
  const LinkStep& step = form.steps[static_cast<size_t>(form.arrival)];
  // Behind a line that is not understood the head may be elsewhere.
  if (to.SameXy(out_.at.machine.at) && z == to.z && form.fixed == 0) return;
  top = std::max(top, z);
  std::vector<Position> travel = TravelTo(request);
  for (Position& at : travel) at.z = top;
  if (form.sinks) travel.back().z = to.z;
  // No slope leads to where the head is.
  const bool on_slope = rise.ramp_mm > 0 && !(to.SameXy(out_.at.machine.at) && form.fixed == 0);
  if (top > z && !on_slope) {
    out_.Lift(top, form.lift_feed > 0 ? form.lift_feed : step.feed);
  } else if (top > z) {
    Slope(out_.at.machine.at, rise, travel);
  }
  for (const Position& at : travel) out_.Travel(step.line.Raw(file_.text), at, step.feed);
}

void LinkWriter::WriteComments(uint32_t block) {
  if ((file_.blocks[block].link & kLinkComments) == 0) return;
  for (const LinkStep& step : ReadLink(file_, block).steps) {
    if (step.kind == StepKind::kComment) out_.Raw(step.line.Raw(file_.text));
  }
}

void LinkWriter::Settle(const LinkRequest& request, const Link& form) {
  const PlacedPath& to = *request.to;
  if (out_.at.machine.at.z != to.first().z) {
    const Decimal feed = form.lift_feed > 0  ? form.lift_feed
                         : form.arrival >= 0 ? form.steps[static_cast<size_t>(form.arrival)].feed
                                             : out_.at.machine.feed;
    out_.Lift(to.first().z, feed);
  }
  out_.Set(to.state(), kAllSlots);
  if (!to.states_feed() && out_.at.machine.feed != to.feed()) out_.Feed(to.feed());
}

void LinkWriter::WriteBoundary(const LinkRequest& request) {
  const Link link = ReadLink(file_, *request.boundary);
  const Block& before = file_.blocks[*request.boundary - 1];
  if (link.fixed > 0) {
    out_.Copy(before.end, link.steps[link.fixed - 1].line.next, StartBehind(file_, before),
              link.behind_fixed, false);
  } else if (request.from->block().object == before.object ||
             (file_.blocks[*request.boundary].link & kLinkNewLayer) != 0) {
    // Whatever was printed last: at its marks the fan is as in the file.
    out_.Set(file_.states[before.state_out], kFanSlots & ~SetBeforeMarks(link));
  }
  out_.Set(link.travel_state, kDynamicsSlots);
  const bool given_from =
      request.from->as_given() && request.from->placement().block + 1 == *request.boundary;
  // Pulled back at once, so that it is at the height of what was printed.
  std::optional<Link> form;
  if (request.retract && !link.arrives_retracted && link.arrival >= 0) form = TemplateFor(request);
  // But not before the label of an object, if it comes at the same height.
  const bool behind_label = form && LabelsBeforeTravel(link);
  if (form && !behind_label) {
    WriteDeparture(request, *form);
  } else if (!form && link.fixed == 0 && !(given_from && link.departs)) {
    WriteGoingOn(request);
    if (!given_from && link.retracts()) WriteOwnDeparture(request);
  }
  const ExchangedLabels labels(file_, link, *request.boundary, request.from->placement().block,
                               request.to->placement().block);
  for (size_t i = link.fixed; i < link.steps.size(); ++i) {
    const StepKind kind = link.steps[i].kind;
    if (kind == StepKind::kProgress && request.without_progress) continue;
    if (kind == StepKind::kLabel || kind == StepKind::kStay) {
      out_.Raw(labels.LineOf(i));
    } else if (static_cast<int>(i) != link.arrival) {
      WriteBoundaryStep(request, link, i);
    } else if (form) {
      if (behind_label) WriteDeparture(request, *form);
      WriteTravel(request, link, std::max(link.top, request.to->first().z + form->lift), *form);
      WriteArrival(request, *form);
    } else {
      WriteTravelToBoundary(request, link, given_from);
    }
  }
  const uint32_t to = request.to->placement().block;
  if (to != *request.boundary && IsSoft(file_.blocks[to])) WriteComments(to);
  Settle(request, link);
}

// Most travel to layers rises, but not what led here in the file, perhaps as it was short.
void LinkWriter::WriteTravelToBoundary(const LinkRequest& request, const Link& link,
                                       bool given_from) {
  const Decimal z = request.to->first().z;
  const bool rises = given_from || link.lift > 0 || !link.retracts() || link.top != z;
  const Decimal lift = rises || link.lift_feed == 0 ? 0 : donors_.LiftToLayer(*request.boundary);
  WriteTravel(request, link, link.top + lift, link);
  if (lift > 0) out_.Lift(z, link.lift_feed);
}

void LinkWriter::WriteBoundaryStep(const LinkRequest& request, const Link& link, size_t i) {
  const LinkStep& step = link.steps[i];
  const std::string_view raw = step.line.Raw(file_.text);
  const bool given_from =
      request.from->as_given() && request.from->placement().block + 1 == *request.boundary;
  switch (step.kind) {
    case StepKind::kTravel:
      if (LeadsAside(link, i)) return out_.Travel(raw, step.to, step.feed);
      if (given_from && IsDeparture(link, i)) out_.MoveLine(step);
      return;
    case StepKind::kWipe: {
      if (given_from) return out_.MoveLine(step);
      for (size_t before = 0; before < i; ++before) {
        if (link.steps[before].kind == StepKind::kWipe) return;
      }
      return WriteWipe(*request.from, link);
    }
    case StepKind::kLift:
      // A departure of another link may have lifted the head higher.
      if (link.Leaves(i) && step.to.z >= step.from.z && out_.at.machine.at.z > step.to.z) return;
      return out_.LiftLine(step, step.to.z);
    case StepKind::kSlot:
      // What another path is printed under is set at its beginning, once.
      if ((step.slots & kDynamicsSlots) != 0 &&
          (link.Leaves(i) || request.to->placement().block != *request.boundary)) {
        return;
      }
      return out_.SetBy(raw, step.slots);
    case StepKind::kRelative:  // lifts are written as heights
      return;
    default:
      out_.LinkLine(step);
  }
}

}  // namespace traverse::gcode
