#include "client/gcode/model/placed_path.h"

#include <algorithm>

#include "client/gcode/model/outline.h"
#include "client/gcode/model/positions.h"
#include "client/gcode/model/seam_gap.h"

namespace traverse::gcode {
namespace {

// The way back from beside a path is searched for in so many steps, until its length fits as far as
// coordinates tell.
constexpr int kMostSteps = 8;
constexpr double kRoundingMm = 0.002;

// The limits of gaps are in mm; and a segment whose filament was rounded to nothing may be what
// stands beside one.
bool MayMoveGap(const GcodeFile& file, const Block& block) {
  return !file.modes[block.mode].inches && (block.flags & kBlockZero) == 0;
}

}  // namespace

LoopGap LoopGapOf(const GcodeFile& file, uint32_t block) {
  LoopGap gap;
  const Block& loop = file.blocks[block];
  if (!MayMoveGap(file, loop) || loop.first.SameXy(loop.last)) return gap;
  const std::vector<BodySegment> segments = ReadBody(file, loop).segments;
  gap.mm = LengthXy(segments.back().to, segments.front().from);
  gap.moves.resize(segments.size());
  for (uint32_t entry = 1; entry < segments.size(); ++entry) {
    gap.moves[entry] = MovesGap(entry, segments);
  }
  return gap;
}

PlacedPath::PlacedPath(const GcodeFile& file, const Placement& placement)
    : file_(&file), placement_(placement) {
  if (as_given()) {
    PlaceGiven();
    return;
  }
  body_ = ReadBody(file, block());
  if (placement_.closed) {
    PlaceRotated();
  } else {
    PlaceReversed();
  }
  const BodySegment& first = body_.segments.front();
  state_ = &body_.states[first.state];
  feed_ = first.feed;
  // New segments state their feed rate where it changes.
  states_feed_ = true;
}

void PlacedPath::PlaceGiven() {
  first_ = block().first;
  last_ = block().last;
  state_ = &file_->states[block().state_in];
  feed_ = block().feed_in;
  const Line line = LineAt(file_->text, block().begin);
  Command command;
  LexLine(line.Text(file_->text), command);
  states_feed_ = command.Has('F');
}

void PlacedPath::PlaceReversed() {
  std::vector<BodySegment>& segments = body_.segments;
  std::reverse(segments.begin(), segments.end());
  for (BodySegment& segment : segments) segment = Reversed(segment);
  first_ = segments.front().from;
  last_ = segments.back().to;
  if (body_.tail_length == 0) return;
  // As long a tail as the path's own, straight on beyond its new end.
  const BodySegment& end = segments.back();
  const double length = LengthXy(end.from, end.to) + body_.tail_length;
  const Position tail_end = Along(end.from, end.to, length, unit_mm());
  last_.x = tail_end.x;
  last_.y = tail_end.y;
}

void PlacedPath::PlaceRotated() {
  std::vector<BodySegment>& segments = body_.segments;
  if (MayMoveGap(*file_, block())) MoveGap(placement_.entry, segments);
  std::rotate(segments.begin(), segments.begin() + placement_.entry, segments.end());
  first_ = segments.front().from;
  last_ = segments.back().to;
}

PathBody PlacedPath::PrintedBody() const { return as_given() ? ReadBody(*file_, block()) : body_; }

std::vector<Position> PlacedPath::Retrace(double length) const {
  return RetraceOver(PrintedBody().segments, length);
}

std::vector<Position> PlacedPath::RetraceOver(const std::vector<BodySegment>& segments,
                                              double length) const {
  std::vector<Position> travel;
  Position at = last_;
  const auto go_to = [&](const Position& to) {
    const double step = LengthXy(at, to);
    const Position from = at;
    at = step <= length ? to : Along(at, to, length, unit_mm());
    length -= step;
    // What is left of the length may be less than coordinates tell.
    if (!at.SameXy(from)) travel.push_back(at);
  };
  // A loop that ends short of its start is wiped across that gap, and on along its beginning.
  if (placement_.closed) go_to(first_);
  const size_t n = segments.size();
  for (size_t i = 0; i < n && length > 0; ++i) {
    const BodySegment next = placement_.closed ? segments[i] : Reversed(segments[n - 1 - i]);
    for (const Point& bend : BendsOf(next, unit_mm())) {
      if (length > 0) go_to(InWords(bend, unit_mm()));
    }
    if (length > 0) go_to(next.to);
  }
  return travel;
}

std::vector<Position> PlacedPath::RetraceFrom(const Position& begin, double length) const {
  const std::vector<BodySegment> segments = PrintedBody().segments;
  if (begin.SameXy(last_)) return RetraceOver(segments, length);
  // Going back to the path from aside cuts a corner, so the same length leads farther along.
  const double farthest = length + 2 * LengthXy(last_, begin);
  std::vector<Position> travel;
  double along = length;
  for (int step = 0; step < kMostSteps; ++step) {
    travel = RetraceOver(segments, along);
    if (travel.size() > 1 && travel.front().SameXy(first_)) travel.erase(travel.begin());
    const double missing = length - LengthXy(begin, travel);
    if (missing < kRoundingMm / unit_mm() || along >= farthest) break;
    along = std::min(along + missing, farthest);
  }
  return travel;
}

}  // namespace traverse::gcode
