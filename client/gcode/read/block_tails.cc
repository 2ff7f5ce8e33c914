// Tails of paths: moves without filament at their ends.

#include "client/gcode/read/block_builder.h"

namespace traverse::gcode {

void BlockBuilder::TakeTail(const Step& step, const MachineState& before,
                            const MachineState& after) {
  if (!has_tail_) {
    before_tail_ = Last();
    has_tail_ = true;
  } else {
    tail_.flags |= link_.flags;
    link_ = tail_;
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

// The tail leads straight on from the path, or back to where that began.
bool BlockBuilder::TailIsOwn() const {
  const Block& path = before_tail_;
  const MachineState& mode = file_.modes[path.mode];
  const Point tail = mode.InMm(Last().last);
  if (Distance(tail, mode.InMm(path.first)) <= kBesideMm) return true;
  const Point end = mode.InMm(path.last);
  const Point before =
      path.end_count > 1 ? file_.ends[path.first_end + path.end_count - 2] : mode.InMm(path.first);
  const double length = Distance(before, end);
  if (!(length > 0)) return false;
  const double reach = Distance(end, tail) / length;
  const Point on{end.x + (end.x - before.x) * reach, end.y + (end.y - before.y) * reach};
  return Distance(on, tail) <= kBesideMm;
}

// A single move as fast as the path, neither straight on nor back to where that began: travel
// leaves the path by it.
bool BlockBuilder::TailLeadsAside() const {
  return tail_.xy_moves == 1 && (Last().flags & kBlockCoast) == 0 && !TailIsOwn();
}

// The next path begins where the tail ended: the tail was the travel to it.
void BlockBuilder::UndoTail() {
  Last() = before_tail_;
  has_tail_ = false;
  tail_.flags |= link_.flags;
  link_ = tail_;
}

}  // namespace traverse::gcode
