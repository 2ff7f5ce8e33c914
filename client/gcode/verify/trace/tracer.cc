#include "client/gcode/verify/trace/tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/gcode/verify/machine/told_progress.h"
#include "client/gcode/verify/text.h"
#include "client/gcode/verify/trace/clock.h"

namespace traverse::gcode {
namespace {

// Moves this short whose extrusion is written as 0 are segments that rounding left nothing of.
constexpr double kRoundedMm = 0.05;

constexpr uint32_t Bit(char letter) { return 1u << (letter - 'A'); }

// Of inches.
Micro InMm(Micro length) { return std::llround(static_cast<double>(length) * kInchMm); }

MoveKind KindOf(const Motion& motion) {
  const bool sideways = motion.from[0] != motion.to[0] || motion.from[1] != motion.to[1];
  if (motion.number == 10) return MoveKind::kRetraction;
  if (motion.number == 11) return MoveKind::kPriming;
  if (motion.number == 4) return MoveKind::kDwell;
  if (sideways) return motion.filament < 0 ? MoveKind::kWipe : MoveKind::kTravel;
  if (motion.filament < 0) return MoveKind::kRetraction;
  if (motion.filament > 0) return MoveKind::kPriming;
  return motion.to[2] < motion.from[2] ? MoveKind::kDown : MoveKind::kUp;
}

uint64_t IdentityOf(const Motion& motion, uint64_t acceleration, bool wiping) {
  const std::array<Micro, 3>& from = motion.from;
  const std::array<Micro, 3>& to = motion.to;
  uint64_t digest = MixAll(acceleration, motion.was_retracted, from[0], to[0], from[1], to[1],
                           from[2], to[2], motion.filament, motion.feed);
  if (motion.has_center) {
    digest = MixAll(digest, motion.center_x, motion.center_y, motion.turns);
  }
  // G0 and G1 are the same to what prints nothing.
  return MixAll(digest, std::max(motion.number, 1) * 2 + (wiping ? 1 : 0));
}

// To the micrometre: of a spiral lift that begins elsewhere.
uint64_t SpiralOf(const Motion& motion, double unit) {
  if (!motion.has_center || motion.to[2] <= motion.from[2]) return 0;
  const auto um = [unit](Micro from, Micro to) {
    return std::llround(static_cast<double>(to - from) * unit * 1000);
  };
  return MixAll(static_cast<uint64_t>(motion.number), motion.turns,
                um(motion.from[0], motion.center_x), um(motion.from[1], motion.center_y));
}

// Moves what lies in section `end` and behind it from `from` to `to`.
template <typename Event>
void MoveLater(uint32_t end, std::vector<Event>& from, std::vector<Event>& to) {
  const auto later =
      std::ranges::find_if(from, [end](const Event& event) { return event.section >= end; });
  to.assign(later, from.end());
  from.erase(later, from.end());
}

}  // namespace

TraceArc ArcOf(const Motion& motion, double unit) {
  const bool clockwise = motion.number == 2;
  if (motion.has_center) {
    return {PointOf({motion.center_x, motion.center_y, 0}, unit), clockwise};
  }
  const Point from = PointOf(motion.from, unit);
  const Point to = PointOf(motion.to, unit);
  const double half = std::hypot(to.x - from.x, to.y - from.y) / 2;
  const double radius = static_cast<double>(motion.radius) * unit;
  const double off = std::sqrt(std::max(radius * radius - half * half, 0.0));
  const double right = clockwise == (radius > 0) ? 1 : -1;
  const double share = half > 0 ? right * off / (2 * half) : 0;
  const Point center{(from.x + to.x) / 2 + share * (to.y - from.y),
                     (from.y + to.y) / 2 - share * (to.x - from.x)};
  return {center, clockwise};
}

ArcWay::ArcWay(Point from, Point to, const TraceArc& arc)
    : center_(arc.center),
      radius_(std::hypot(from.x - center_.x, from.y - center_.y)),
      begin_(std::atan2(from.y - center_.y, from.x - center_.x)) {
  const double end = std::atan2(to.y - center_.y, to.x - center_.x);
  double angle = arc.clockwise ? begin_ - end : end - begin_;
  while (angle <= 1e-9) angle += 2 * M_PI;
  turn_ = arc.clockwise ? -angle : angle;
}

Point ArcWay::At(int k, int n) const {
  const double angle = begin_ + turn_ * k / n;
  return {center_.x + radius_ * std::cos(angle), center_.y + radius_ * std::sin(angle)};
}

std::string_view MoveKindName(MoveKind kind) {
  constexpr std::string_view kNames[] = {"travel",     "wipe",    "move up", "move down",
                                         "retraction", "priming", "dwell"};
  static_assert(std::size(kNames) == static_cast<size_t>(MoveKind::kCount));
  return kNames[static_cast<size_t>(kind)];
}

double TraceMove::length_mm() const { return std::hypot(to.x - from.x, to.y - from.y); }

bool TraceMove::IsNothing(double least_mm) const {
  return !firmware && !arc && filament == 0 && kind != MoveKind::kDwell &&
         std::abs(z_from_mm - z_to_mm) <= kOneHeightMm && length_mm() < least_mm;
}

void Tracer::Take(const VerifyLine& line, VerifyMachine& machine, uint32_t section) {
  if (line.text.empty()) return;
  const double before_seconds = seconds_;
  if (section != last_section_) BeginSection(line, section, before_seconds);
  seconds_ += SecondsOf(line, machine);
  if (line.role == LineRole::kDeposit) NotePlaces(before_seconds);
  if (line.text[0] == ';') {
    TakeComment(line, section);
  } else if (line.role == LineRole::kDeposit) {
    TakeDeposit(line, machine, section);
    TracePath& path = chunk_.paths.back();
    if (path.size() == 1) path.begun_seconds = before_seconds;
    path.left_seconds = seconds_;
  } else if (line.moves) {
    TakeMove(line, machine, section);
  }
  states_fan_ |= line.sets_fan;
  if (line.role == LineRole::kDeposit || line.role == LineRole::kFence ||
      line.role == LineRole::kFixed) {
    last_held_line_ = line.number;
    held_seconds_ = seconds_;
  }
  if (line.role == LineRole::kProgress) {
    const std::array<double, 4> places{begun_seconds_, left_seconds_, seconds_, seconds_};
    chunk_.progress.push_back(
        {line.digest, line.number, section, PercentTold(line.text), seconds_, places});
    ++without_next_;
  }
  if (line.sets_back) {
    chunk_.line_faults.push_back({section, line.number, LineFaultKind::kSetsBack});
  }
  if (line.command != 0 && line.role != LineRole::kProgress) {
    pending_commands_.push_back({line.command, 0, line.number});
  }
  if (line.role == LineRole::kFixed) {
    link_.scripted = true;
    link_.fixed = static_cast<uint32_t>(pending_.size());
  }
}

// A deposit begins and ends where a line of progress may stand.
void Tracer::NotePlaces(double before_seconds) {
  for (size_t i = chunk_.progress.size(); i > 0 && without_next_ > 0; --without_next_) {
    std::array<double, 4>& places = chunk_.progress[--i].places;
    places[2] = before_seconds;
    places[3] = seconds_;
  }
  without_next_ = 0;
  begun_seconds_ = before_seconds;
  left_seconds_ = seconds_;
}

// A change of height begins a section before its first deposit, but what stands behind the last
// deposit or fence belongs to it as well (sections.h).
void Tracer::BeginSection(const VerifyLine& line, uint32_t section, double before_seconds) {
  const bool at_height = line.role == LineRole::kDeposit;
  for (size_t i = chunk_.progress.size(); at_height && i-- > 0;) {
    if (chunk_.progress[i].line <= last_held_line_) break;
    chunk_.progress[i].section = section;
  }
  chunk_.begins.push_back({section, at_height ? held_seconds_ : before_seconds});
  last_section_ = section;
}

void Tracer::TakeWipeMark(bool begins, uint32_t line, uint32_t section) {
  if (begins == wiping_) {
    const LineFaultKind twice = begins ? LineFaultKind::kBeginsTwice : LineFaultKind::kEndsTwice;
    chunk_.line_faults.push_back({section, line, twice});
  } else if (!begins && !wiped_) {
    chunk_.line_faults.push_back({section, line, LineFaultKind::kEmpty});
  }
  marks_wipes_ = true;
  wiping_ = begins;
  wiped_ = printed_ = false;
}

void Tracer::TakeComment(const VerifyLine& line, uint32_t section) {
  if (line.role == LineRole::kFence) return;
  if (const std::optional<bool> begins = BeginsWipe(line.text)) {
    TakeWipeMark(*begins, line.number, section);
  } else if (const std::optional<PathClass> path_class = ClassOfComment(line.text)) {
    named_ = path_class;
  }
}

// The segment may be all that its path is of; what the path is of is what most of it is of.
PathClass Tracer::ClassNow(const VerifyLine& line) const {
  if (named_) return *named_;
  const size_t comment = line.text.find(';');
  if (comment == std::string_view::npos) return PathClass::kUnnamed;
  return ClassOfMoveComment(line.text.substr(comment)).value_or(PathClass::kUnnamed);
}

// True if all that happened since the last deposit were segments rounded to nothing.
bool Tracer::OnlyRounding() const {
  return std::ranges::all_of(pending_, [](const TraceMove& move) { return move.rounding; });
}

// Far beyond all that was deposited and where the next path begins, as no slicer's own travel
// leads.
bool Tracer::IsAside(Point at, Point begin) const {
  constexpr double kFarMm = 10;
  BoundingBox box = extent_;
  box.Add(begin);
  return at.x < box.low().x - kFarMm || at.x > box.high().x + kFarMm ||
         at.y < box.low().y - kFarMm || at.y > box.high().y + kFarMm;
}

// What leads aside on the way to a layer no lower, or to the first one, and back, is a script like
// unknown lines: up to there it stays as it is.
void Tracer::FixExcursion(Point begin, double z_mm) {
  const bool sinks = !link_.first && z_mm < printed_mm_ - kOneHeightMm;
  if (!link_.new_layer || sinks) return;
  bool arrived = false;
  for (size_t m = pending_.size(); m-- > link_.fixed && pending_[m].in_print;) {
    if (pending_[m].kind != MoveKind::kTravel) continue;
    if (std::exchange(arrived, true) && IsAside(pending_[m].to, begin)) {
      link_.scripted = true;
      link_.fixed = static_cast<uint32_t>(m + 1);
      return;
    }
  }
}

void Tracer::EndLink() {
  link_.first_move = static_cast<uint32_t>(chunk_.moves.size());
  chunk_.moves.insert(chunk_.moves.end(), pending_.begin(), pending_.end());
  link_.end_move = static_cast<uint32_t>(chunk_.moves.size());
  chunk_.links.push_back(link_);
}

void Tracer::BeginPath(const Motion& motion, uint32_t section, double unit) {
  TracePath path;
  path.first_segment = static_cast<uint32_t>(chunk_.segments.size());
  path.start = PointOf(motion.from, unit);
  path.z_mm = static_cast<double>(motion.to[2]) * unit;
  path.joined = in_path_ && pending_.empty();
  FixExcursion(path.start, static_cast<double>(motion.from[2]) * unit);
  extent_.Add(path.start);
  EndLink();
  pending_.clear();
  pending_commands_.clear();
  link_ = TraceLink{};
  const auto index = static_cast<uint32_t>(chunk_.paths.size());
  if (layer_due_) {
    const auto first = static_cast<uint32_t>(chunk_.sections.size());
    chunk_.layers.push_back({layers_++, first, first});
  }
  if (section_due_) {
    chunk_.sections.push_back({section, index, index});
    ++chunk_.layers.back().end_section;
  }
  layer_due_ = section_due_ = false;
  chunk_.paths.push_back(path);
  chunk_.sections.back().end_path = index + 1;
  length_of_.fill(0);
}

void Tracer::TakeDeposit(const VerifyLine& line, VerifyMachine& machine, uint32_t section) {
  const Motion& motion = machine.motion();
  const double unit = machine.inches() ? kInchMm * kMicro : kMicro;
  const bool goes_on = in_path_ && !section_due_ && OnlyRounding();
  if (goes_on) {
    for (TraceCommand command : pending_commands_) {
      command.segment = static_cast<uint32_t>(chunk_.segments.size());
      chunk_.commands.push_back(command);
    }
    pending_commands_.clear();
    pending_.clear();
    link_ = TraceLink{};
  } else {
    BeginPath(motion, section, unit);
    chunk_.paths.back().fan = machine.settings().fan();
    chunk_.paths.back().states_fan = states_fan_;
    chunk_.paths.back().acceleration = machine.settings().PathAccelerationDigest();
  }
  in_path_ = true;
  states_fan_ = false;
  // What is printed between the marks of a wipe is a fault of theirs; one of it is enough.
  if (wiping_ && !printed_) {
    chunk_.line_faults.push_back({section, line.number, LineFaultKind::kDeposit});
  }
  printed_ |= wiping_;
  TraceSegment segment;
  segment.digest = line.digest;
  segment.conditions = line.conditions;
  segment.filament_mm = static_cast<double>(motion.filament) * unit;
  segment.end = PointOf(motion.to, unit);
  printed_mm_ = static_cast<double>(motion.to[2]) * unit;
  extent_.Add(segment.end);
  segment.line = line.number;
  if (motion.has_center || motion.radius != 0) {
    segment.arc = static_cast<int32_t>(chunk_.arcs.size());
    chunk_.arcs.push_back(ArcOf(motion, unit));
  }
  chunk_.segments.push_back(segment);
  const uint64_t acceleration = machine.settings().AccelerationDigest();
  if (chunk_.accelerations.empty() || chunk_.accelerations.back() != acceleration) {
    chunk_.accelerations.push_back(acceleration);
  }
  TracePath& path = chunk_.paths.back();
  path.end_segment = static_cast<uint32_t>(chunk_.segments.size());
  path.z_mm = std::max(path.z_mm, printed_mm_);
  const auto length = static_cast<float>(FlatLength(motion) * unit);
  path.length_mm += length;
  path.filament_mm += static_cast<float>(segment.filament_mm);
  path.feed = motion.feed;
  const PathClass path_class = ClassNow(line);
  path.overhangs |= path_class == PathClass::kOverhang;
  path.outer |= path_class == PathClass::kOuterWall;
  path.inner |= path_class == PathClass::kInnerWall;
  float& of_class = length_of_[static_cast<size_t>(path_class)];
  of_class += length + 1e-6f;
  if (of_class > length_of_[static_cast<size_t>(path.path_class)]) path.path_class = path_class;
}

void Tracer::TakeMove(const VerifyLine& line, VerifyMachine& machine, uint32_t section) {
  const Motion& motion = machine.motion();
  const double unit = machine.inches() ? kInchMm * kMicro : kMicro;
  TraceMove move;
  move.kind = KindOf(motion);
  if (wiping_ && move.kind == MoveKind::kTravel) move.kind = MoveKind::kWipe;
  wiped_ |= wiping_ && move.sideways();
  if (!wiping_ && marks_wipes_ && move.kind == MoveKind::kWipe && motion.number < 10) {
    chunk_.line_faults.push_back({section, line.number, LineFaultKind::kUnmarked});
  }
  move.acceleration = machine.settings().AccelerationDigest();
  move.identity = IdentityOf(motion, move.acceleration, wiping_);
  move.tool = machine.tool();
  move.from = PointOf(motion.from, unit);
  move.to = PointOf(motion.to, unit);
  move.middle = {(move.from.x + move.to.x) / 2, (move.from.y + move.to.y) / 2};
  if (motion.has_center) move.middle = ArcWay(move.from, move.to, ArcOf(motion, unit)).At(1, 2);
  move.spiral = SpiralOf(motion, unit);
  move.z_from_mm = static_cast<double>(motion.from[2]) * unit;
  move.z_to_mm = static_cast<double>(motion.to[2]) * unit;
  move.filament = machine.inches() ? InMm(motion.filament) : motion.filament;
  move.feed = motion.feed;
  move.line = line.number;
  move.section = section;
  move.open = !motion.was_retracted;
  move.firmware = motion.number == 10 || motion.number == 11;
  move.states_z = (motion.words & Bit('Z')) != 0;
  move.arc = motion.number == 2 || motion.number == 3;
  move.in_print = in_print_;
  move.rounding = move.kind == MoveKind::kTravel && (motion.words & Bit('E')) != 0 &&
                  motion.filament == 0 && move.length_mm() <= kRoundedMm && !chunk_.paths.empty() &&
                  motion.feed == chunk_.paths.back().feed;
  const Micro surplus = machine.inches() ? InMm(line.surplus) : line.surplus;
  const bool fresh = motion.pulled <= VerifyMachine::kSlack && !motion.was_retracted;
  if (line.primes && std::abs(surplus) > kPrimeRounding) {
    chunk_.standstills.push_back({section, move.line, move.tool, surplus, fresh, move.to});
  }
  pending_.push_back(move);
}

void Tracer::EndSection(bool layer, bool mark) {
  section_due_ = true;
  layer_due_ |= layer;
  link_.new_layer |= layer;
  if (mark) Mark();
}

void Tracer::Mark() {
  // Lines of the start script say nothing of the travel to the first path.
  if (!in_print_) {
    link_.scripted = false;
    link_.fixed = 0;
    link_.first = true;
    // What the start script deposits is none of the print.
    extent_ = BoundingBox();
  }
  in_print_ = true;
}

TraceChunk Tracer::TakeChunk(uint32_t end_section, bool last_of_file) {
  EndLink();
  chunk_.end_section = end_section;
  chunk_.seconds = seconds_;
  TraceChunk taken = std::exchange(chunk_, TraceChunk{});
  MoveLater(end_section, taken.standstills, chunk_.standstills);
  MoveLater(end_section, taken.line_faults, chunk_.line_faults);
  if (last_of_file) return taken;
  const auto loose = std::ranges::find_if(
      taken.progress, [this](const Progress& line) { return line.line > last_held_line_; });
  chunk_.progress.assign(loose, taken.progress.end());
  taken.progress.erase(loose, taken.progress.end());
  return taken;
}

}  // namespace traverse::gcode
