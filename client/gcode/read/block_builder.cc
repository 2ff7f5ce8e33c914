#include "client/gcode/read/block_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "client/gcode/dialects/label.h"
#include "client/gcode/model/arc.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

// A tail wipes the end of a line, or coasts to it; a longer move is travel.
constexpr double kMaxTailMm = 2;

// Lines that may stand inside a path.
bool IsQuiet(StepKind kind) {
  switch (kind) {
    case StepKind::kBlank:
    case StepKind::kComment:
    case StepKind::kSlot:
    case StepKind::kWipeMark:
    case StepKind::kProgress:
    case StepKind::kSays:
    case StepKind::kFeed:
      return true;
    default:
      return false;
  }
}

// KISSlicer's coordinates round to where the head is; the filament of such a move does not.
bool IsSpeck(const Step& step) {
  constexpr Decimal kMostFilament = kDecimalOne / 1000;
  return step.kind == StepKind::kFilament && !step.retracted && step.filament > 0 &&
         step.filament <= kMostFilament && (step.command.Has('X') || step.command.Has('Y'));
}

// A move whose words could not be read, or one like G28, whose end is unknown.
bool IsLostMove(const Step& step, const MachineState& after, std::string_view text) {
  if (step.kind != StepKind::kUnknown) return false;
  if (step.command.kind == LineKind::kCommand) {
    const int number = step.command.number;
    if (step.command.letter != 'G' || number == 4) return false;
    return number > 3 || !after.relative_xyz;
  }
  const std::string_view line = TrimBlanks(step.line.Text(text));
  return line.starts_with("G") || line.starts_with("g") || line.starts_with("N");
}

// Without waiting for it; what waits is not known.
bool Heats(const Step& step) {
  const Command& c = step.command;
  return step.kind == StepKind::kStay && (c.Is('M', 104) || c.Is('M', 140) || c.Is('M', 142));
}

bool ReachesFarBeyond(const BoundingBox& box, const BoundingBox& travel) {
  return travel.low().x < box.low().x - kAsideMm || travel.low().y < box.low().y - kAsideMm ||
         travel.high().x > box.high().x + kAsideMm || travel.high().y > box.high().y + kAsideMm;
}

// What a line that moves nothing does to the link that it stands in.
uint16_t LinkFlagsOf(StepKind kind) {
  switch (kind) {
    case StepKind::kUnknown:
    case StepKind::kModeChange:
      return kLinkFixed;
    case StepKind::kStay:
    case StepKind::kLabel:
      return kLinkSplits;
    case StepKind::kLayerMark:
      return kLinkSplits | kLinkNewLayer;
    case StepKind::kComment:
    case StepKind::kSays:
      return kLinkComments;
    case StepKind::kFirmwareRetract:
      return kLinkRetracts;
    case StepKind::kWipe:
      return kLinkWipes;
    default:
      return 0;
  }
}

}  // namespace

void BlockBuilder::Take(const Step& step, const MachineState& before,
                        const Interpreter& interpreter) {
  const MachineState& after = interpreter.state();
  // Some slicers write E0 on travel: what follows a path at another speed is none of its segments.
  const bool goes_on = where_ != Where::kBody || after.feed == Last().feed_out;
  const bool prints = step.kind == StepKind::kExtrude ||
                      (step.kind == StepKind::kZeroExtrude && !step.retracted && goes_on);
  if (prints) {
    if (where_ != Where::kBody) BeginBlock(step, before, after);
    where_ = Where::kBody;
    return ExtendBlock(step, before, after);
  }
  if (step.kind == StepKind::kSlot) TakeSlot(step);
  if (step.kind == StepKind::kLabel) TakeLabel(step);
  NoteScript(step);
  if (step.kind == StepKind::kProgress) file_.progress.push_back(step.line.begin);
  if (step.fault != nullptr) {
    faults_.push_back({step.line.begin, step.fault, file_.blocks.size()});
  }
  TakeOther(step, before, after);
}

void BlockBuilder::TakeOther(const Step& step, const MachineState& before,
                             const MachineState& after) {
  if ((where_ == Where::kBody || where_ == Where::kTail) && IsTail(step, before, after)) {
    TakeTail(step, before, after);
    where_ = Where::kTail;
    return;
  }
  // A tail of two moves may state its feed rate between them.
  const bool in_tail = where_ == Where::kTail && step.kind == StepKind::kFeed;
  if (where_ == Where::kBody && (IsQuiet(step.kind) || IsSpeck(step))) {
    if (IsSpeck(step)) pending_ |= kBlockCommand;
    if (step.kind == StepKind::kComment || step.kind == StepKind::kSays) {
      pending_ |= kBlockComments;
    }
    if (step.kind == StepKind::kProgress) pending_ |= kBlockProgress;
  } else if (where_ != Where::kHead && !in_tail) {
    if (where_ == Where::kTail && TailLeadsAside()) UndoTail();
    where_ = Where::kLink;
  }
  NoteInLink(step, before, after);
}

void BlockBuilder::NoteInLink(const Step& step, const MachineState& before,
                              const MachineState& after) {
  const uint16_t flags = LinkFlagsOf(step.kind);
  link_.flags |= flags;
  if (Heats(step)) link_.flags |= kLinkHeats;
  link_.sets_fan |= (step.slots & kFanSlots) != 0;
  if ((flags & kLinkFixed) != 0) link_.travels_behind_fixed = 0;
  NotePlace(step, after);
  if (after.tool != before.tool) link_.changes_tool = true;
  if (link_.changes_tool && step.kind == StepKind::kFilament && step.filament > kRetractionSlack &&
      !step.retracted) {
    link_.primes = true;
  }
  if (step.kind == StepKind::kTravel) NoteTravel(after.InMm(after.at));
  if (step.filament < 0) link_.flags |= kLinkRetracts;
  const bool pulls = step.filament < 0 || step.kind == StepKind::kFirmwareRetract;
  if (pulls && !step.retracted && link_.retracted) link_.flags |= kLinkRetractsAgain;
  if (pulls && link_.open_first_move && link_.xy_moves == 1) link_.pulls_behind_first = true;
  link_.retracted = link_.retracted || step.retracted;
  if (step.relative) link_.relative_rise += after.at.z - before.at.z;
  if (IsXyMotion(step.kind)) {
    const double mm = StepLengthMm(step, after);
    link_.travel_mm += mm;
    if (link_.xy_moves++ == 0 && step.kind == StepKind::kTravel) {
      link_.first_move_mm = mm;
      link_.first_move_to = after.at;
      link_.open_first_move = !step.retracted && !step.arc && after.at.z == before.at.z;
    }
    if (step.kind == StepKind::kTravel) link_.top = std::max(link_.top, after.at.z);
  }
}

// Wherever the head was led to, it is known again behind moves that state all axes.
void BlockBuilder::NotePlace(const Step& step, const MachineState& after) {
  constexpr uint32_t kAxes = Command::Bit('X') | Command::Bit('Y') | Command::Bit('Z');
  if (IsLostMove(step, after, file_.text)) {
    link_.lost = true;
    link_.found = 0;
  } else if (link_.lost && !after.relative_xyz &&
             (step.command.Is('G', 0) || step.command.Is('G', 1))) {
    link_.found |= step.command.words & kAxes;
    link_.lost = link_.found != kAxes;
  }
}

void BlockBuilder::NoteTravel(Point to) {
  ++link_.travels_behind_fixed;
  if (link_.travel_to) link_.travelled.Add(*link_.travel_to);
  link_.travel_to = to;
}

// And back: farther than to a path that begins at `begin`.
bool BlockBuilder::LeadsAside(Point begin) const {
  BoundingBox around = printed_;
  around.Add(begin);
  return !link_.travelled.empty() && ReachesFarBeyond(around, link_.travelled);
}

void BlockBuilder::TakeSlot(const Step& step) {
  const std::string_view line = step.line.Text(file_.text);
  const uint32_t setter = file_.setters.Intern(line, step.slots);
  for (size_t slot = 0; slot < kSlotCount; ++slot) {
    if (((step.slots >> slot) & 1u) == 0 || state_[slot] == setter) continue;
    // Nothing written could bring back that a slot was never set.
    const bool first = state_[slot] == 0;
    if (first) link_.flags |= kLinkSplits;
    state_[slot] = setter;
    state_dirty_ = true;
    if (where_ == Where::kBody) {
      if (first) pending_ |= kBlockPinned;
      if ((SlotBit(static_cast<Slot>(slot)) & kFanSlots) != 0) pending_ |= kBlockFan;
      if (slot == kSlotType) pending_ |= kBlockType;
      if (line[0] != ';') pending_ |= kBlockCommand;
    }
  }
}

void BlockBuilder::TakeLabel(const Step& step) {
  const std::string_view line = TrimBlanks(step.line.Text(file_.text));
  const LabelKind kind = LabelOf(line).kind;
  if (kind == LabelKind::kSays) return;
  object_ = kind == LabelKind::kBegins ? file_.setters.Intern(line, 0) : 0;
}

// The start script ends at the first mark of a layer; in files without such marks at the last line
// near the beginning that switches modes or waits for heat.
void BlockBuilder::NoteScript(const Step& step) {
  constexpr size_t kMostPurges = 12;
  if (layers_marked_ || step.kind == StepKind::kRelative) return;
  const Command& c = step.command;
  const bool starts = step.kind == StepKind::kModeChange || c.Is('G', 21) || c.Is('G', 90) ||
                      c.Is('M', 82) || c.Is('M', 83) || c.Is('M', 109) || c.Is('M', 190);
  if (step.kind == StepKind::kLayerMark) {
    layers_marked_ = true;
    // A purge line at the edge of the bed is none of the print; scripts lead there, too.
    printed_ = BoundingBox();
  } else if (!starts || file_.blocks.size() > kMostPurges) {
    return;
  }
  scripted_ = file_.blocks.size();
  link_.travelled = BoundingBox();
  link_.travel_to.reset();
  file_.script_end = step.line.next;
}

uint32_t BlockBuilder::CurrentState() {
  if (state_dirty_) {
    state_id_ = file_.states.Intern(state_);
    state_dirty_ = false;
  }
  return state_id_;
}

uint16_t BlockBuilder::ModeOf(const MachineState& state) {
  const std::array<int, 5> modes = {state.relative_xyz, state.relative_e, state.inches,
                                    state.plane_xy, state.tool};
  // Beyond 65535 different modes (tool numbers) the blocks are pinned anyway, by their T lines.
  constexpr size_t kMostModes = std::numeric_limits<uint16_t>::max();
  const size_t next = std::min(file_.modes.size(), kMostModes - 1);
  const auto [id, is_new] = mode_ids_.try_emplace(modes, static_cast<uint16_t>(next));
  if (is_new && file_.modes.size() < kMostModes) file_.modes.push_back(state);
  return id->second;
}

void BlockBuilder::BeginBlock(const Step& step, const MachineState& before,
                              const MachineState& after) {
  const bool to_tail = has_tail_ && link_.xy_moves == 0;
  if (to_tail && !TailIsOwn()) UndoTail();
  // Such a path needs no more travel than its tail.
  meets_tail_ = to_tail && link_.xy_moves == 0;
  has_tail_ = false;
  EndBlock();
  Block block;
  block.begin = step.line.begin;
  block.state_in = CurrentState();
  block.feed_in = after.feed;
  block.first = step.from;
  block.e_in = before.e;
  block.object = object_;
  block.first_end = static_cast<uint32_t>(file_.ends.size());
  block.mode = ModeOf(after);
  CloseLink(block, after.at.z, step.retracted);
  block.link = link_.flags;
  if (link_.sets_fan) block.flags |= kBlockOwnFan;
  block.travel_mm = static_cast<float>(link_.travel_mm);
  if (link_.xy_moves > 0 && !file_.blocks.empty()) {
    block.lift = std::max<Decimal>(0, link_.top - std::max(Last().last.z, block.first.z));
  }
  file_.blocks.push_back(block);
  printed_.Add(file_.modes[block.mode].InMm(block.first));
  pending_ = 0;
}

// The first move of the link leads along the beginning of the path before it, a closed one, and
// not to the next path.
bool BlockBuilder::GoesOn() const {
  const Block& block = Last();
  if (!link_.open_first_move || link_.xy_moves < 2 || block.end_count < 3 ||
      link_.first_move_mm > kMaxTailMm || !(link_.first_move_mm > 2 * kBesideMm)) {
    return false;
  }
  const MachineState& mode = file_.modes[block.mode];
  Point at = mode.InMm(block.first);
  if (Distance(at, mode.InMm(block.last)) > kBesideMm) return false;
  double left = link_.first_move_mm;
  for (uint32_t i = 0; i < block.end_count && left > 0; ++i) {
    const Point to = file_.ends[block.first_end + i];
    const double length = Distance(at, to);
    const double share = length > left ? left / length : 1;
    at = {at.x + (to.x - at.x) * share, at.y + (to.y - at.y) * share};
    left -= length;
  }
  return Distance(at, mode.InMm(link_.first_move_to)) <= kBesideMm;
}

// A scarf seam rises to the height of its layer from below it.
bool BlockBuilder::BeginsLayer(const Block& block, Decimal first_end_z) const {
  if (file_.blocks.empty() || (link_.flags & kLinkNewLayer) != 0) return true;
  const Decimal z = file_.layers.back().z;
  const bool rises_to_it = block.first.z < first_end_z && first_end_z <= z;
  return block.first.z != z && !rises_to_it;
}

void BlockBuilder::CloseLink(const Block& block, Decimal first_end_z, bool retracted) {
  const bool first = file_.blocks.empty();
  const bool new_layer = BeginsLayer(block, first_end_z);
  if (first) {
    link_.flags |= kLinkFixed;
  } else {
    if (GoesOn()) Last().flags |= kBlockGoesOn;
    const Block& last = Last();
    if (last.mode != block.mode) link_.flags |= kLinkFixed;
    if (last.object != block.object) link_.flags |= kLinkSplits;
    // Such a push fills the nozzle: it stays where it is.
    if (link_.primes) link_.flags |= kLinkFixed;
    if ((link_.flags & kLinkFixed) != 0 && !link_.lost && !link_.primes &&
        link_.travels_behind_fixed > 0) {
      link_.flags &= static_cast<uint16_t>(~kLinkFixed);
      link_.flags |= kLinkFixedFrom | kLinkSplits;
    }
    // To the next object, which begins lower, slicers lead the head aside themselves.
    const bool behind_script = layers_marked_ && scripted_ == file_.blocks.size();
    if (new_layer && (behind_script || block.first.z >= last.last.z) &&
        LeadsAside(file_.modes[block.mode].InMm(block.first))) {
      link_.flags |= kLinkAside;
      if ((link_.flags & kLinkFixed) == 0) link_.flags |= kLinkFixedFrom | kLinkSplits;
    }
    // It alone opens, or closes, the nozzle for what follows.
    const bool closed = (last.flags & kBlockRetracted) != 0;
    if (closed != retracted) link_.flags |= kLinkFixed;
    if (link_.xy_moves == 0 && !meets_tail_) link_.flags |= kLinkFixed;
    // Such moves lead to another layer, or are a script's. Those to a scarf seam lead below the
    // height of its layer.
    if (link_.relative_rise != 0 && new_layer) link_.flags |= kLinkFixed;
  }
  // Where travel is led around walls, it may begin with a short move to anywhere.
  const bool departs = link_.xy_moves > 1 && link_.first_move_mm > 0 &&
                       link_.first_move_mm <= kMaxDepartureMm &&
                       (!file_.slicer.combs || link_.pulls_behind_first);
  if (departs) link_.flags |= kLinkDeparts;
  if (new_layer) {
    link_.flags |= kLinkNewLayer | kLinkSplits;
    BeginLayer(block);
  }
}

void BlockBuilder::BeginLayer(const Block& block) {
  const auto begin = static_cast<uint32_t>(file_.blocks.size());
  if (!file_.layers.empty()) file_.layers.back().end_block = begin;
  file_.layers.push_back(Layer{begin, begin, block.first.z});
}

void BlockBuilder::ExtendBlock(const Step& step, const MachineState& before,
                               const MachineState& after) {
  Block& block = Last();
  block.end = step.line.next;
  block.last = after.at;
  block.e_out = after.e;
  block.feed_out = after.feed;
  block.state_out = CurrentState();
  block.flags |= pending_;
  pending_ = 0;
  link_ = OpenLink{};
  // A layer that begins with a scarf seam is as high as that ends.
  Layer& layer = file_.layers.back();
  const bool begins_layer = layer.first_block + 1 == file_.blocks.size();
  ends_rising_ = after.at.z > before.at.z;
  if (begins_layer && ends_rising_) layer.z = std::max(layer.z, after.at.z);
  if (step.retracted) block.flags |= kBlockRetracted;
  if (step.retracted || after.at.z < before.at.z || (ends_rising_ && !IsScarf(block, layer))) {
    block.flags |= kBlockPinned;
  }
  if (step.arc)
    block.flags |= EndsOnItsCircle(step.command, step.from, after.at, after.UnitMm())
                       ? kBlockArcs
                       : kBlockPinned;
  if (step.kind == StepKind::kZeroExtrude) block.flags |= kBlockZero;
  block.length_mm += static_cast<float>(StepLengthMm(step, after));
  const Point end = after.InMm(after.at);
  file_.ends.push_back(end);
  printed_.Add(end);
  ++block.end_count;
}

// It begins no lower than what lies below, and rises no higher than its layer. The layer before may
// be higher: then it is of another object, in a print object by object.
bool BlockBuilder::IsScarf(const Block& block, const Layer& layer) const {
  const size_t count = file_.layers.size();
  const Decimal before = count > 1 ? file_.layers[count - 2].z : 0;
  const Decimal below = before < layer.z ? before : 0;
  return block.first.z >= below && block.last.z <= layer.z;
}

// What rises up to its end is no scarf seam, but a spiral vase, or a path in the air.
void BlockBuilder::EndBlock() {
  if (ends_rising_) Last().flags |= kBlockPinned;
  ends_rising_ = false;
}

// CuraEngine ends lines with a short move at print speed, and coasts a little slower. A travel move
// is faster, or follows something else than the path.
bool BlockBuilder::IsTail(const Step& step, const MachineState& before,
                          const MachineState& after) const {
  return step.kind == StepKind::kTravel && !step.arc && before.at.z == after.at.z &&
         after.feed <= Last().feed_out && StepLengthMm(step, after) <= kMaxTailMm;
}

// After such a line it is unknown where the head is, and what was printed before.
void BlockBuilder::KeepLayersWithFaults() {
  const auto keep = [this](const LineFault& fault, size_t block) {
    Layer& layer = file_.layers[file_.LayerOf(block)];
    if (layer.fault != nullptr) return;
    layer.fault = fault.what;
    layer.fault_at = fault.at;
    for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
      file_.blocks[b].flags |= kBlockPinned;
    }
  };
  for (const LineFault& fault : faults_) {
    if (fault.block > 0) keep(fault, fault.block - 1);
    if (fault.block < file_.blocks.size()) keep(fault, fault.block);
  }
}

// The first layer of an object is as high as it lies.
void BlockBuilder::NoteHeights() {
  constexpr double kLeastMm = 0.02;
  const Layer* before = nullptr;
  for (Layer& layer : file_.layers) {
    const bool again = before != nullptr && before->z == layer.z;
    const Decimal below = before != nullptr && before->z < layer.z ? before->z : 0;
    const double mm =
        ToDouble(layer.z - below) * file_.modes[file_.blocks[layer.first_block].mode].UnitMm();
    if (again) {
      layer.height_mm = before->height_mm;
    } else if (mm > kLeastMm) {
      layer.height_mm = mm;
    }
    before = &layer;
  }
}

void BlockBuilder::Finish() {
  if (file_.blocks.empty()) return;
  EndBlock();
  file_.layers.back().end_block = static_cast<uint32_t>(file_.blocks.size());
  KeepLayersWithFaults();
  NoteHeights();
  // A first mark that most of the print stands before is none.
  if (scripted_ * 2 > file_.blocks.size()) {
    file_.script_end = 0;
    return;
  }
  for (size_t i = 0; i < scripted_; ++i) file_.blocks[i].flags |= kBlockScript | kBlockPinned;
}

}  // namespace traverse::gcode
