#include "engine/schedule/end_history.h"

#include <bit>
#include <cmath>

#include "engine/base/rng.h"

namespace traverse {
namespace {

class Fingerprint {
 public:
  void Add(uint64_t value) { state_ = (std::rotl(state_, 23) ^ value) * 0x9e3779b97f4a7c15u; }
  void Add(int value) { Add(static_cast<uint64_t>(static_cast<int64_t>(value))); }
  // 0 and -0 are the same.
  void Add(double value) { Add(std::bit_cast<uint64_t>(value + 0.0)); }

  uint64_t value() {
    uint64_t state = state_;
    return SplitMix64(state);
  }

 private:
  uint64_t state_ = 1;
};

constexpr double kUnitsPerMm = 1e4;

double Rounded(double length_mm) { return std::floor(length_mm * kUnitsPerMm + 0.5); }

}  // namespace

Point PlanOrigin(const Plan& plan) {
  return plan.paths.empty() || plan.paths[0].points.empty() ? Point{} : plan.paths[0].points[0];
}

PlanPrint PrintOf(const Plan& plan, const CostSpec& cost, const LayerWalls& walls) {
  Fingerprint make;
  make.Add(static_cast<int>(cost.kind));
  for (const double part :
       {cost.speed_mm_s, cost.accel_mm_s2, cost.retraction_seconds, cost.retraction_threshold_mm,
        cost.wall_retraction_threshold_mm, cost.exposed_retraction_threshold_mm, cost.lift_seconds,
        cost.crossing_seconds, cost.wall_slack_mm, cost.wall_clearance_mm}) {
    make.Add(part);
  }
  Fingerprint place;
  const Point origin = PlanOrigin(plan);
  for (const Path& path : plan.paths) {
    make.Add(static_cast<int>(path.kind) * 2 + (path.one_way ? 1 : 0));
    make.Add(path.points.size());
    for (const Point& point : path.points) {
      make.Add(Rounded(point.x - origin.x));
      make.Add(Rounded(point.y - origin.y));
      place.Add(point.x);
      place.Add(point.y);
    }
    for (const int vertex : path.allowed) make.Add(vertex);
  }
  for (const Wall& wall : walls.walls) {
    make.Add(wall.points.size());
    make.Add(wall.closed ? 1 : 0);
    for (const Point& point : wall.points) {
      make.Add(Rounded(point.x - origin.x));
      make.Add(Rounded(point.y - origin.y));
      place.Add(point.x);
      place.Add(point.y);
    }
  }
  for (const int path : walls.exposed) make.Add(path);
  for (const PlanNode& node : plan.nodes) {
    make.Add(static_cast<int>(node.kind));
    make.Add(node.path);
    make.Add(node.children.size());
    for (const int child : node.children) make.Add(child);
    for (const auto& [first, second] : node.before) {
      make.Add(first);
      make.Add(second);
    }
  }
  place.Add(make.value());
  return {make.value(), place.value()};
}

uint64_t KindOf(uint64_t make, Point origin, Point start, const std::optional<Point>& finish) {
  Fingerprint kind;
  kind.Add(make);
  kind.Add(Rounded(start.x - origin.x));
  kind.Add(Rounded(start.y - origin.y));
  kind.Add(finish ? 1 : 0);
  if (finish) {
    kind.Add(Rounded(finish->x - origin.x));
    kind.Add(Rounded(finish->y - origin.y));
  }
  return kind.value();
}

uint64_t KindBefore(uint64_t kind, Point origin, uint64_t next_make, Point next_origin,
                    const std::optional<Point>& next_finish) {
  Fingerprint both;
  both.Add(kind);
  both.Add(KindOf(next_make, origin, next_origin, next_finish));
  return both.value();
}

}  // namespace traverse
