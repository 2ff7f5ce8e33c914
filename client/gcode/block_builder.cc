#include "client/gcode/block_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "client/gcode/arc.h"

namespace traverse::gcode {
namespace {

// A tail wipes a line's end or coasts to it; what is longer is travel.
constexpr double kMaxTailMm = 2;

// Slicers move in by about a line width before they leave a loop.
constexpr double kMaxDepartureMm = 1;

// Lines that may stand inside a path.
bool IsQuiet(StepKind kind) {
  switch (kind) {
    case StepKind::kBlank:
    case StepKind::kComment:
    case StepKind::kSlot:
    case StepKind::kWipeMark:
    case StepKind::kProgress:
    case StepKind::kFeed:
      return true;
    default:
      return false;
  }
}

double StepMm(const Step& step, const MachineState& after) {
  const double unit = after.UnitMm();
  if (step.arc) return ArcLength(step.command, step.from, after.at, unit);
  const double dx = ToDouble(after.at.x - step.from.x);
  const double dy = ToDouble(after.at.y - step.from.y);
  return std::sqrt(dx * dx + dy * dy) * unit;
}

// An arc that ends beside its circle is no arc: what a machine makes of it depends on where it
// begins. Rounding is less than this.
constexpr double kMaxOffCircleMm = 0.02;

bool EndsOnItsCircle(const Step& step, const MachineState& after) {
  const Command& c = step.command;
  if (!c.Has('I') && !c.Has('J')) return true;
  const double i = c.Has('I') ? ToDouble(c.Value('I')) : 0;
  const double j = c.Has('J') ? ToDouble(c.Value('J')) : 0;
  const double x = ToDouble(after.at.x - step.from.x) - i;
  const double y = ToDouble(after.at.y - step.from.y) - j;
  const double unit = after.UnitMm();
  return std::abs(std::hypot(i, j) - std::hypot(x, y)) * unit <= kMaxOffCircleMm;
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
      return kLinkComments;
    case StepKind::kLift:
      return kLinkLifts;
    case StepKind::kFirmwareRetract:
      return kLinkRetracts;
    case StepKind::kWipe:
      return kLinkRetracts | kLinkWipes;
    default:
      return 0;
  }
}

}  // namespace

void BlockBuilder::Take(const Step& step, const MachineState& before,
                        const Interpreter& interpreter) {
  const bool prints =
      step.kind == StepKind::kExtrude || (step.kind == StepKind::kZeroExtrude && !step.retracted);
  const MachineState& after = interpreter.state();
  if (prints) return TakePrinting(step, before, after);
  if (step.kind == StepKind::kSlot) TakeSlot(step);
  if (step.kind == StepKind::kLabel) TakeLabel(step);
  if (step.kind == StepKind::kProgress) file_.progress.push_back(step.line.begin);
  TakeOther(step, before, after);
}

void BlockBuilder::TakePrinting(const Step& step, const MachineState& before,
                                const MachineState& after) {
  if (where_ != Where::kBody) BeginBlock(step, before, after);
  where_ = Where::kBody;
  ExtendBlock(step, before, after);
}

void BlockBuilder::TakeOther(const Step& step, const MachineState& before,
                             const MachineState& after) {
  if ((where_ == Where::kBody || where_ == Where::kTail) && IsTail(step, before, after)) {
    TakeTail(step, before, after);
    where_ = Where::kTail;
    return;
  }
  if (where_ == Where::kBody && IsQuiet(step.kind)) {
    if (step.kind == StepKind::kComment) pending_ |= kBlockComments;
    if (step.kind == StepKind::kProgress) pending_ |= kBlockProgress;
  } else if (where_ != Where::kHead) {
    where_ = Where::kLink;
  }
  NoteInLink(step, before, after);
}

void BlockBuilder::NoteInLink(const Step& step, const MachineState& before,
                              const MachineState& after) {
  link_.flags |= LinkFlagsOf(step.kind);
  if (step.kind == StepKind::kFilament && step.filament < 0) link_.flags |= kLinkRetracts;
  if (IsXyMotion(step.kind)) {
    const double mm = StepMm(step, after);
    link_.travel_mm += mm;
    if (link_.xy_moves++ == 0 && step.kind == StepKind::kTravel) link_.first_move_mm = mm;
    if (after.at.z != before.at.z) link_.flags |= kLinkLifts;
  }
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
      pending_ |= first ? kBlockState | kBlockPinned : kBlockState;
      if ((SlotBit(static_cast<Slot>(slot)) & kFanSlots) != 0) pending_ |= kBlockFan;
      if (slot == kSlotType) pending_ |= kBlockType;
    }
  }
}

void BlockBuilder::TakeLabel(const Step& step) {
  const std::string_view object = LabelledObject(step.line.Text(file_.text));
  object_ = object.empty() ? 0 : file_.setters.Intern(object, 0);
}

uint32_t BlockBuilder::CurrentState() {
  if (state_dirty_) {
    state_id_ = file_.states.Intern(state_);
    state_dirty_ = false;
  }
  return state_id_;
}

uint16_t BlockBuilder::ModeOf(const MachineState& state) {
  for (size_t i = file_.modes.size(); i-- > 0;) {
    if (file_.modes[i].SameModes(state)) return static_cast<uint16_t>(i);
  }
  // Beyond 65535 different modes (tool numbers) the blocks are pinned anyway, by their T lines.
  if (file_.modes.size() < std::numeric_limits<uint16_t>::max()) file_.modes.push_back(state);
  return static_cast<uint16_t>(file_.modes.size() - 1);
}

void BlockBuilder::BeginBlock(const Step& step, const MachineState& before,
                              const MachineState& after) {
  if (has_tail_ && link_.xy_moves == 0) UndoTail();
  has_tail_ = false;
  Block block;
  block.begin = step.line.begin;
  block.state_in = CurrentState();
  block.feed_in = after.feed;
  block.first = step.from;
  block.e_in = before.e;
  block.object = object_;
  block.first_end = static_cast<uint32_t>(file_.ends.size());
  block.mode = ModeOf(after);
  CloseLink(block);
  block.link = link_.flags;
  block.travel_mm = static_cast<float>(link_.travel_mm);
  file_.blocks.push_back(block);
  pending_ = 0;
}

void BlockBuilder::CloseLink(const Block& block) {
  const bool first = file_.blocks.empty();
  const bool new_layer =
      first || Last().first.z != block.first.z || (link_.flags & kLinkNewLayer) != 0;
  if (first) {
    link_.flags |= kLinkFixed;
  } else {
    const Block& last = Last();
    if (last.mode != block.mode) link_.flags |= kLinkFixed;
    if (last.object != block.object) link_.flags |= kLinkSplits;
    if (link_.xy_moves == 0) link_.flags |= kLinkFixed;
  }
  const bool departs =
      link_.xy_moves > 1 && link_.first_move_mm > 0 && link_.first_move_mm <= kMaxDepartureMm;
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
  if (step.retracted || before.at.z != after.at.z) block.flags |= kBlockPinned;
  if (step.arc && !EndsOnItsCircle(step, after)) block.flags |= kBlockPinned;
  if (step.kind == StepKind::kZeroExtrude) block.flags |= kBlockZero;
  block.length_mm += static_cast<float>(StepMm(step, after));
  file_.ends.push_back(after.InMm(after.at));
  ++block.end_count;
  if (block.segments < std::numeric_limits<uint16_t>::max()) ++block.segments;
}

// CuraEngine ends lines with a short move at print speed, and coasts at a little less. A travel
// move is faster, or follows something else than the path.
bool BlockBuilder::IsTail(const Step& step, const MachineState& before,
                          const MachineState& after) const {
  return step.kind == StepKind::kTravel && !step.arc && before.at.z == after.at.z &&
         after.feed <= Last().feed_out && StepMm(step, after) <= kMaxTailMm;
}

void BlockBuilder::TakeTail(const Step& step, const MachineState& before,
                            const MachineState& after) {
  if (!has_tail_) {
    before_tail_ = Last();
    has_tail_ = true;
  }
  NoteInLink(step, before, after);
  tail_ = link_;
  Block& block = Last();
  block.end = step.line.next;
  block.last = after.at;
  block.feed_out = after.feed;
  block.state_out = CurrentState();
  block.flags |= kBlockTail | pending_;
  if (after.feed < before_tail_.feed_out) block.flags |= kBlockCoast;
  pending_ = 0;
  link_ = OpenLink{};
}

// The next path begins where the tail ended: it was the way there.
void BlockBuilder::UndoTail() {
  Last() = before_tail_;
  tail_.flags |= link_.flags;
  link_ = tail_;
}

void BlockBuilder::Finish() {
  if (file_.blocks.empty()) return;
  file_.layers.back().end_block = static_cast<uint32_t>(file_.blocks.size());
}

}  // namespace traverse::gcode
