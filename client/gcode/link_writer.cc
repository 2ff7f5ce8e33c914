#include "client/gcode/link_writer.h"

#include <cmath>
#include <vector>

namespace traverse::gcode {
namespace {

constexpr SlotMask kAllSlots = (SlotMask{1} << kSlotCount) - 1;

double LengthXy(const Position& from, const Position& to) {
  return std::hypot(ToDouble(to.x - from.x), ToDouble(to.y - from.y));
}

bool IsSoft(const Block& block) { return (block.link & (kLinkSplits | kLinkFixed)) == 0; }

// What a wipe of the file does.
struct WipeForm {
  double way_mm = 0;
  Decimal pulled = 0;
  Decimal feed = 0;
};

WipeForm FormOf(const Link& link) {
  WipeForm form;
  for (const LinkStep& step : link.steps) {
    if (step.kind != StepKind::kWipe) continue;
    form.way_mm += LengthXy(step.from, step.to);
    form.pulled -= step.filament;
    form.feed = step.feed;
  }
  return form;
}

// The step of the short move with which the link begins.
bool IsDeparture(const Link& link, size_t i) {
  if (!link.departs || link.steps[i].kind != StepKind::kTravel) return false;
  for (size_t before = 0; before < i; ++before) {
    if (IsXyMotion(link.steps[before].kind)) return false;
  }
  return link.Leaves(i);
}

}  // namespace

void LinkWriter::Write(const LinkRequest& request) {
  const uint32_t to = request.to->placement().block;
  const bool follows =
      request.from->placement().block + 1 == to && (!request.boundary || *request.boundary == to);
  if (follows && request.from->as_given() && request.to->as_given()) return WriteGiven(request);
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
  if (IsSoft(file_.blocks[to])) {
    Link own = ReadLink(file_, to);
    if (own.retracts() == request.retract && own.arrival >= 0) return own;
  }
  for (const bool retracts : {request.retract, !request.retract}) {
    const std::optional<uint32_t> donor = donors_.Find(to, retracts);
    if (!donor) continue;
    Link link = ReadLink(file_, *donor);
    if (link.arrival >= 0) return link;
  }
  return ReadLink(file_, to);
}

void LinkWriter::WritePlain(const LinkRequest& request) {
  const Link form = TemplateFor(request);
  out_.Set(form.travel_state, kDynamicsSlots);
  WriteDeparture(request, form);
  WriteTravel(request, form);
  WriteArrival(request, form);
  if (IsSoft(request.to->block())) WriteComments(request.to->placement().block);
  Settle(request, form);
}

// The link that leads away from the path in the file, if what it does there fits here.
std::optional<Link> LinkWriter::OwnDeparture(const LinkRequest& request, const Link& form) const {
  const uint32_t next = request.from->placement().block + 1;
  if (!request.from->as_given() || next >= file_.blocks.size() || !IsSoft(file_.blocks[next])) {
    return std::nullopt;
  }
  Link own = ReadLink(file_, next);
  if (own.arrival < 0 || !own.SameRetraction(form)) return std::nullopt;
  return own;
}

void LinkWriter::WriteDeparture(const LinkRequest& request, const Link& form) {
  const std::optional<Link> own = OwnDeparture(request, form);
  const Link& link = own ? *own : form;
  const Decimal z = out_.at.machine.at.z;
  bool wiped = false;
  for (size_t i = 0; link.Leaves(i); ++i) {
    const LinkStep& step = link.steps[i];
    if (IsXyMotion(step.kind)) {
      if (own && (step.kind == StepKind::kWipe || IsDeparture(link, i))) {
        out_.MoveLine(step);
      } else if (step.kind == StepKind::kWipe && !wiped) {
        wiped = true;
        WriteWipe(*request.from, link);
      }
    } else if (step.kind == StepKind::kWipeMark ||
               (own && link.wipes && step.kind == StepKind::kFeed)) {
      out_.LinkLine(step);
    } else {
      WriteMotion(step, link.z_before, z);
    }
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
  const WipeForm wipe = FormOf(form);
  const std::vector<Position> way = path.WayBack(wipe.way_mm);
  double length = 0;
  for (size_t i = 0; i < way.size(); ++i) {
    length += LengthXy(i == 0 ? path.last() : way[i - 1], way[i]);
  }
  Decimal left = wipe.pulled;
  for (size_t i = 0; i < way.size(); ++i) {
    const double share = LengthXy(i == 0 ? path.last() : way[i - 1], way[i]) / length;
    const bool last = i + 1 == way.size();
    // Rounded as slicers write E: to hundredths of a micrometre.
    constexpr Decimal kStep = kDecimalOne / 100'000;
    const Decimal pull =
        last ? left
             : static_cast<Decimal>(static_cast<double>(wipe.pulled) * share) / kStep * kStep;
    left -= pull;
    out_.Segment("G1", way[i], true, -pull, wipe.feed, {}, {});
  }
  if (left > 0) out_.Pull(left, wipe.feed);
}

// Writes a step that moves filament or Z alone; Z relative to the height of what is printed.
void LinkWriter::WriteMotion(const LinkStep& step, Decimal z_form, Decimal z_here) {
  switch (step.kind) {
    case StepKind::kFilament:
    case StepKind::kSetE:
    case StepKind::kFirmwareRetract:
    case StepKind::kFirmwareUnretract:
      return out_.LinkLine(step);
    case StepKind::kLift:
      return out_.LiftLine(step, z_here + (step.to.z - z_form));
    default:
      return;
  }
}

void LinkWriter::WriteTravel(const LinkRequest& request, const Link& form) {
  Position to = request.to->first();
  if (form.arrival < 0) return;
  const LinkStep& step = form.steps[static_cast<size_t>(form.arrival)];
  const Decimal z = to.z;
  to.z = step.to.z != step.from.z ? z + (step.to.z - form.z_behind) : out_.at.machine.at.z;
  if (to == out_.at.machine.at) return;
  if (request.detours != nullptr) WriteDetour(request, step);
  out_.Travel(step.line.Raw(file_.text), to, step.feed);
}

// The bends of the way to `request.to`, at the height where the head is.
void LinkWriter::WriteDetour(const LinkRequest& request, const LinkStep& step) {
  const MachineState& machine = out_.at.machine;
  // As slicers write coordinates: to micrometres.
  const auto word = [unit = machine.UnitMm()](double mm) {
    return static_cast<Decimal>(std::llround(mm / unit * 1000)) * (kDecimalOne / 1000);
  };
  for (const Vertex bend :
       request.detours->Around(machine.InMm(machine.at), machine.InMm(request.to->first()))) {
    const Position via{word(bend.x), word(bend.y), machine.at.z};
    out_.Travel(step.line.Raw(file_.text), via, step.feed);
  }
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
    const Decimal feed = form.arrival >= 0 ? form.steps[static_cast<size_t>(form.arrival)].feed
                                           : out_.at.machine.feed;
    out_.Lift(to.first().z, feed);
  }
  out_.Set(to.state(), kAllSlots);
  if (!to.states_feed() && out_.at.machine.feed != to.feed()) out_.Feed(to.feed());
}

void LinkWriter::WriteBoundary(const LinkRequest& request) {
  const Link link = ReadLink(file_, *request.boundary);
  // Whatever was printed last: at its marks the fan is as in the file.
  out_.Set(file_.states[file_.blocks[*request.boundary - 1].state_out], kFanSlots);
  out_.Set(link.travel_state, kDynamicsSlots);
  for (size_t i = 0; i < link.steps.size(); ++i) WriteBoundaryStep(request, link, i);
  const uint32_t to = request.to->placement().block;
  if (to != *request.boundary && IsSoft(file_.blocks[to])) WriteComments(to);
  Settle(request, link);
}

void LinkWriter::WriteBoundaryStep(const LinkRequest& request, const Link& link, size_t i) {
  const LinkStep& step = link.steps[i];
  const std::string_view raw = step.line.Raw(file_.text);
  const bool given_from =
      request.from->as_given() && request.from->placement().block + 1 == *request.boundary;
  switch (step.kind) {
    case StepKind::kTravel:
      if (static_cast<int>(i) == link.arrival) {
        const bool lacks = request.retract && !link.retracts();
        LinkRequest plain = request;
        const Link form = lacks ? TemplateFor(plain) : Link{};
        if (lacks) WriteDeparture(plain, form);
        WriteTravel(request, link);
        if (lacks) WriteArrival(plain, form);
      } else if (given_from && IsDeparture(link, i)) {
        out_.MoveLine(step);
      } else if (step.to.z != step.from.z) {
        // Of a move that also rises, the rise.
        out_.Lift(step.to.z, step.feed);
      }
      return;
    case StepKind::kWipe: {
      if (given_from) return out_.MoveLine(step);
      for (size_t before = 0; before < i; ++before) {
        if (link.steps[before].kind == StepKind::kWipe) return;
      }
      return WriteWipe(*request.from, link);
    }
    case StepKind::kLift:
      return out_.LiftLine(step, step.to.z);
    case StepKind::kSlot:
      if (link.Leaves(i) && (step.slots & kDynamicsSlots) != 0) return;
      out_.Raw(raw);
      ApplySetter(out_.at.state, file_.setters.Find(step.line.Text(file_.text)), step.slots);
      return;
    default:
      out_.LinkLine(step);
  }
}

}  // namespace traverse::gcode
