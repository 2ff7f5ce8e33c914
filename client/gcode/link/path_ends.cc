#include "client/gcode/link/path_ends.h"

#include <algorithm>

#include "client/gcode/model/positions.h"

namespace traverse::gcode {
namespace {

// Shorter moves than it takes to get going have corners between them, at which it is not got going.
constexpr ptrdiff_t kMostMoves = 48;

// All moves of `path`, as they are printed (path_writer.h); `body` is its body as it is placed.
std::vector<BodySegment> MovesOf(const PlacedPath& path, const PathBody& body) {
  std::vector<BodySegment> moves;
  moves.reserve(body.segments.size() + 2);
  Position at = path.first();
  const auto travel = [&moves, &at, &body](const Position& to) {
    if (to.SameXy(at)) return;
    BodySegment& move = moves.emplace_back(moves.empty() ? body.segments.front() : moves.back());
    move.command = 1;
    move.filament = 0;
    move.from = at;
    move.to = at = {to.x, to.y, at.z};
  };
  for (const BodySegment& segment : body.segments) {
    travel(segment.from);
    moves.push_back(segment);
    at = segment.to;
  }
  travel(path.last());
  return moves;
}

}  // namespace

PathEnds::PathEnds(const GcodeFile& file, const PlacedPath& path)
    : file_(&file), modes_(file.modes[path.block().mode]) {
  const PathBody body = path.PrintedBody();
  for (const PrintState& state : body.states) {
    dynamics_.push_back(DynamicsOf(file.profile, state, file.setters));
  }
  state_behind_ = path.as_given() ? file.states[path.block().state_out]
                                  : body.states[body.segments.back().state];
  PrintedMoves all;
  all.moves = MovesOf(path, body);
  seconds_ = SecondsOf(all);
  const std::vector<BodySegment>& moves = all.moves;
  const auto behind_enough = [this](auto begin, auto end) {
    double mm = 0;
    auto at = begin;
    for (; at != end && at - begin < kMostMoves && !IsEnough(mm, *at); ++at) {
      mm += LengthXy(at->from, at->to) * modes_.UnitMm();
    }
    return at;
  };
  first_.moves.assign(moves.begin(), behind_enough(moves.begin(), moves.end()));
  last_.moves.assign(behind_enough(moves.rbegin(), moves.rend()).base(), moves.end());
  first_.seconds = SecondsOf(first_);
  last_.seconds = SecondsOf(last_);
}

bool PathEnds::IsEnough(double mm, const BodySegment& move) const {
  const Dynamics& dynamics = dynamics_[move.state];
  const double speed = std::min(ToDouble(move.feed) / 60 * modes_.UnitMm(), dynamics.max_speed());
  const double accel = dynamics.print_accel() * (1 - dynamics.cruise_ratio());
  return mm > 0 && mm * accel >= speed * speed;
}

double PathEnds::SecondsOf(const PrintedMoves& printed) const {
  PrintMeter meter = Meter();
  Follow(printed, meter);
  return meter.Finish().seconds;
}

void PathEnds::Follow(const PrintedMoves& printed, PrintMeter& meter) const {
  MachineState machine = modes_;
  Step step;
  const BodySegment* before = nullptr;
  for (const BodySegment& move : printed.moves) {
    if (before == nullptr || before->state != move.state) meter.Set(dynamics_[move.state]);
    before = &move;
    step.kind = move.filament > 0 ? StepKind::kExtrude : StepKind::kTravel;
    step.from = move.from;
    step.filament = move.filament;
    step.arc = move.command >= 2;
    if (step.arc) step.command = ArcCommand(move);
    machine.at = move.to;
    machine.feed = move.feed;
    meter.Follow(step, machine);
  }
}

}  // namespace traverse::gcode
