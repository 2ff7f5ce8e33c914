// The cost of a route among walls, computed again: by another test for crossings, on another index
// of the walls, so that a fault of engine/cost shows.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/validator.h"
#include "engine/validator_links.h"

namespace traverse {
namespace {

// Closer to touching than this, rounding decides.
constexpr double kTouchMm = 1e-6;

// The part of a move that is tested: at most this much is left out at each end.
constexpr double kMostEnd = 0.2;

struct Line {
  Point a, b;
};

double Length(Point from, Point to) { return std::hypot(to.x - from.x, to.y - from.y); }

enum class Crossing { kNo, kPerhaps, kYes };

// The walls' lines in stripes of equal height.
class Stripes {
 public:
  explicit Stripes(const LayerWalls& walls) {
    for (const Wall& wall : walls.walls) {
      const size_t n = wall.points.size();
      for (size_t i = 0; i < (wall.closed ? n : n - 1); ++i) {
        const Line line{wall.points[i], wall.points[(i + 1) % n]};
        if (!(line.a == line.b)) lines_.push_back(line);
      }
    }
    if (lines_.empty()) return;
    low_ = lines_[0].a.y;
    double high = low_;
    double heights = 0;  // of all lines
    for (const Line& line : lines_) {
      low_ = std::min({low_, line.a.y, line.b.y});
      high = std::max({high, line.a.y, line.b.y});
      heights += std::abs(line.a.y - line.b.y);
    }
    const double lines = static_cast<double>(lines_.size());
    const double count = std::ceil(std::sqrt(lines));
    // Upright lines would be in every stripe: no more of those than that lines are in three.
    height_ = std::max({(high - low_) / count, heights / lines, 1e-3});
    stripes_.resize(static_cast<size_t>((high - low_) / height_) + 1);
    for (const Line& line : lines_) {
      const auto [first, last] = StripesOf(line.a.y, line.b.y);
      for (size_t s = first; s <= last; ++s) stripes_[s].push_back(line);
    }
  }

  // Whether the move from `a` to `b`, without `slack_mm` at each end, crosses a wall.
  Crossing Of(Point a, Point b, double slack_mm) const {
    const double length = Length(a, b);
    if (lines_.empty() || !(length > 0)) return Crossing::kNo;
    const double end = std::min(slack_mm, kMostEnd * length);
    Crossing crossing = Crossing::kNo;
    const auto [first, last] = StripesOf(a.y, b.y);
    for (size_t s = first; s <= last; ++s) {
      for (const Line& line : stripes_[s]) {
        crossing = std::max(crossing, Of(a, b, length, end, line));
        if (crossing == Crossing::kYes) return crossing;
      }
    }
    return crossing;
  }

 private:
  std::pair<size_t, size_t> StripesOf(double y0, double y1) const {
    const auto stripe = [this](double y) {
      const double most = static_cast<double>(stripes_.size() - 1);
      return static_cast<size_t>(std::clamp((y - low_) / height_, 0.0, most));
    };
    return {stripe(std::min(y0, y1) - kTouchMm), stripe(std::max(y0, y1) + kTouchMm)};
  }

  // In the frame of the move: `along` it and `across` it, in mm.
  static Crossing Of(Point a, Point b, double length, double end, const Line& line) {
    const double ux = (b.x - a.x) / length;
    const double uy = (b.y - a.y) / length;
    const auto across = [&](Point p) { return (p.y - a.y) * ux - (p.x - a.x) * uy; };
    const auto along = [&](Point p) { return (p.x - a.x) * ux + (p.y - a.y) * uy; };
    const double c = across(line.a);
    const double d = across(line.b);
    if (std::min(c, d) > kTouchMm || std::max(c, d) < -kTouchMm) return Crossing::kNo;
    const double first = end;
    const double last = length - end;
    const double c_at = along(line.a);
    const double d_at = along(line.b);
    const bool through = std::min(c, d) < -kTouchMm && std::max(c, d) > kTouchMm;
    if (!through) {
      // It begins or ends on the move, or lies along it.
      const bool apart =
          std::min(c_at, d_at) > last + kTouchMm || std::max(c_at, d_at) < first - kTouchMm;
      return apart ? Crossing::kNo : Crossing::kPerhaps;
    }
    const double at = c_at + (d_at - c_at) * (c / (c - d));
    // If the two are nearly parallel, rounding shifts the point along the move.
    const double slack = kTouchMm * (1 + std::abs(d_at - c_at) / std::abs(c - d));
    if (at > first + slack && at < last - slack) return Crossing::kYes;
    return at < first - slack || at > last + slack ? Crossing::kNo : Crossing::kPerhaps;
  }

  std::vector<Line> lines_;
  std::vector<std::vector<Line>> stripes_;
  double low_ = 0;
  double height_ = 1;
};

// The least and the most that something can be.
struct Range {
  double least = 0;
  double most = 0;

  void Add(double low, double high) {
    least += low;
    most += high;
  }
  bool Holds(double value) const {
    const double slack = kCostTolerance * std::max(1.0, most);
    return value >= least - slack && value <= most + slack;
  }
};

double MotionSeconds(const CostSpec& spec, double length) {
  if (!(spec.accel_mm_s2 > 0)) return length / spec.speed_mm_s;
  const double ramps = spec.speed_mm_s * spec.speed_mm_s / spec.accel_mm_s2;
  if (length < ramps) return 2 * std::sqrt(length / spec.accel_mm_s2);
  return length / spec.speed_mm_s + spec.speed_mm_s / spec.accel_mm_s2;
}

using Position = std::pair<double, double>;

class MoveCheck {
 public:
  MoveCheck(const Plan& plan, const LayerWalls& walls, const CostSpec& spec)
      : spec_(spec), stripes_(walls) {
    for (const int path : walls.exposed) {
      for (const Point& p : plan.paths[static_cast<size_t>(path)].points)
        exposed_.insert({p.x, p.y});
    }
    for (const int path : walls.retracted) {
      for (const Point& p : plan.paths[static_cast<size_t>(path)].points)
        retracted_.insert({p.x, p.y});
    }
    for (const KnownMove& move : walls.known) {
      const Path& from = plan.paths[static_cast<size_t>(move.from)];
      const Point a = from.kind == Path::Kind::kOpen ? from.points[1] : from.points[0];
      const Point b = plan.paths[static_cast<size_t>(move.to)].points[0];
      const Position one(a.x, a.y);
      const Position other(b.x, b.y);
      known_.emplace(std::minmax(one, other), move);
    }
  }

  // Of a straight move or, with `detour`, one over its points. `ends`: what leaving and arriving
  // take besides.
  absl::Status Add(Point from, Point to, const Detour* detour, const LinkSeconds& ends) {
    double length = Length(from, to);
    const Position one(from.x, from.y);
    const Position other(to.x, to.y);
    if (const auto move = known_.find(std::minmax(one, other)); move != known_.end()) {
      if (detour != nullptr) {
        return absl::FailedPreconditionError(
            "it is a known move, so it does not lead around walls");
      }
      AddKnown(move->second, length, ends);
      return absl::OkStatus();
    }
    Crossing crossing = Crossing::kNo;
    double motion = MotionSeconds(spec_, length);
    if (detour == nullptr) {
      crossing = stripes_.Of(from, to, spec_.wall_slack_mm);
    } else {
      length = 0;
      motion = 0;  // with a stop at each bend
      Point at = from;
      for (size_t i = 0; i <= detour->points.size(); ++i) {
        const Point next = i < detour->points.size() ? detour->points[i] : to;
        if (stripes_.Of(at, next, spec_.wall_slack_mm) == Crossing::kYes) {
          return absl::FailedPreconditionError("its way around walls crosses one");
        }
        length += Length(at, next);
        motion += MotionSeconds(spec_, Length(at, next));
        at = next;
      }
    }
    const bool exposed = exposed_.contains(one) || exposed_.contains(other);
    const double pays =
        1 - (retracted_.contains(one) ? 0.5 : 0) - (retracted_.contains(other) ? 0.5 : 0);
    const auto [added_low, low_retracts] = Of(length, exposed, false, pays);
    const auto [added_high, high_retracts] = Of(length, exposed, true, pays);
    const double low = motion + added_low + (low_retracts ? ends.retracted : ends.open);
    const double high = motion + added_high + (high_retracts ? ends.retracted : ends.open);
    const bool surely = crossing == Crossing::kYes;
    const bool perhaps = crossing != Crossing::kNo;
    cost_.Add(surely ? high : low, perhaps ? high : low);
    crossings_.Add(surely ? 1 : 0, perhaps ? 1 : 0);
    const bool pulls = spec_.retraction_seconds > 0;
    retractions_.Add(pulls && (surely ? high_retracts : low_retracts) ? 1 : 0,
                     pulls && (perhaps ? high_retracts : low_retracts) ? 1 : 0);
    return absl::OkStatus();
  }

  absl::Status Compare(const MoveClaims& claims) const {
    const auto differ = [](const char* what, double claimed, const Range& range) {
      return absl::FailedPreconditionError(
          absl::StrCat(what, " ", claimed, ", computed anew ", range.least, " to ", range.most));
    };
    if (!cost_.Holds(claims.cost)) return differ("cost", claims.cost, cost_);
    const auto crossings = static_cast<double>(claims.counts.crossings);
    if (!crossings_.Holds(crossings)) return differ("crossings", crossings, crossings_);
    const auto retractions = static_cast<double>(claims.counts.retractions);
    if (!retractions_.Holds(retractions)) return differ("retractions", retractions, retractions_);
    return absl::OkStatus();
  }

 private:
  void AddKnown(const KnownMove& move, double length, const LinkSeconds& ends) {
    double least = MotionSeconds(spec_, length);
    if (length > spec_.retraction_threshold_mm) least += spec_.retraction_seconds;
    const double seconds = std::max(least, move.seconds) +
                           (move.crosses ? spec_.crossing_seconds : 0) +
                           (move.retracts ? ends.retracted : ends.open);
    const double retractions = move.retracts && spec_.retraction_seconds > 0 ? 1 : 0;
    cost_.Add(seconds, seconds);
    crossings_.Add(move.crosses ? 1 : 0, move.crosses ? 1 : 0);
    retractions_.Add(retractions, retractions);
  }

  // Time in addition to the motion, and whether it retracts. `pays`: the share of a retraction for
  // walls.
  std::pair<double, bool> Of(double length, bool exposed, bool crosses, double pays) const {
    const bool far = length > spec_.retraction_threshold_mm;
    const bool retracts = far || (crosses && length > spec_.wall_retraction_threshold_mm) ||
                          (exposed && length > spec_.exposed_retraction_threshold_mm);
    double seconds = 0;
    if (retracts) seconds += spec_.retraction_seconds * (far ? 1 : pays);
    if (crosses && retracts) seconds += spec_.lift_seconds;
    if (crosses) seconds += spec_.crossing_seconds;
    return {seconds, retracts};
  }

  const CostSpec& spec_;
  const Stripes stripes_;
  absl::flat_hash_set<Position> exposed_;
  absl::flat_hash_set<Position> retracted_;
  absl::flat_hash_map<std::pair<Position, Position>, KnownMove> known_;  // by their ends in order
  Range cost_;
  Range crossings_;
  Range retractions_;
};

}  // namespace

absl::Status ValidateMoves(const Plan& plan, const LayerWalls& walls, const CostSpec& spec,
                           Point start, const Route& route, const MoveClaims& claims,
                           Budget* budget, const LayerLinks* links, const LinkSeconds& before) {
  assert(spec.kind == CostSpec::Kind::kTime && CheckWalls(walls, plan).ok());
  assert(ValidateRoute(plan, route).ok());
  MoveCheck check(plan, walls, spec);
  size_t next = 0;
  Point at = start;
  LinkSeconds leaving = before;
  for (size_t i = 0; i < route.size(); ++i) {
    if (budget != nullptr && budget->Exhausted() && budget->cancelled()) return absl::OkStatus();
    const Path& path = plan.paths[static_cast<size_t>(route[i].path)];
    const bool leads_around = next < claims.detours.size() && claims.detours[next].visit == i;
    const Detour* detour = leads_around ? &claims.detours[next++] : nullptr;
    const Point to = path.points[static_cast<size_t>(route[i].entry)];
    LinkSeconds ends = leaving;
    const LinkSeconds arriving = ArrivingAt(links, route[i].path, route[i].entry);
    ends.open += arriving.open;
    ends.retracted += arriving.retracted;
    if (const absl::Status fault = check.Add(at, to, detour, ends); !fault.ok()) {
      return absl::Status(fault.code(), absl::StrCat("route[", i, "]: ", fault.message()));
    }
    const int exit = path.kind == Path::Kind::kOpen ? 1 - route[i].entry : route[i].entry;
    const Departure departure = LeavingAt(links, route[i].path, exit);
    at = departure.from.value_or(path.points[static_cast<size_t>(exit)]);
    leaving = departure.seconds;
  }
  if (next != claims.detours.size()) {
    return absl::FailedPreconditionError(absl::StrCat("detours[", next, "]: belongs to no move"));
  }
  return check.Compare(claims);
}

}  // namespace traverse
