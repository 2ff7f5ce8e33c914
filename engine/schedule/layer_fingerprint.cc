#include "engine/schedule/layer_fingerprint.h"

#include <bit>
#include <cmath>
#include <vector>

#include "engine/base/rest.h"
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

LayerFingerprint FingerprintOf(const Plan& plan, const CostSpec& cost, const LayerWalls& walls,
                               Budget* budget) {
  Rest rest(budget);
  Fingerprint shape;
  shape.Add(static_cast<int>(cost.kind));
  for (const double part :
       {cost.speed_mm_s, cost.accel_mm_s2, cost.retraction_seconds, cost.retraction_threshold_mm,
        cost.wall_retraction_threshold_mm, cost.exposed_retraction_threshold_mm, cost.lift_seconds,
        cost.crossing_seconds, cost.wall_slack_mm, cost.wall_clearance_mm}) {
    shape.Add(part);
  }
  Fingerprint exact;
  const Point origin = PlanOrigin(plan);
  const auto add_points = [&](const std::vector<Point>& points) {
    for (const Point& point : points) {
      rest(2);
      shape.Add(Rounded(point.x - origin.x));
      shape.Add(Rounded(point.y - origin.y));
      exact.Add(point.x);
      exact.Add(point.y);
    }
  };
  for (const Path& path : plan.paths) {
    rest();
    shape.Add(static_cast<int>(path.kind) * 2 + (path.one_way ? 1 : 0));
    shape.Add(path.points.size());
    add_points(path.points);
    for (const int vertex : path.allowed) shape.Add(vertex);
  }
  for (const Wall& wall : walls.walls) {
    shape.Add(wall.points.size());
    shape.Add(wall.closed ? 1 : 0);
    add_points(wall.points);
  }
  for (const std::vector<int>* paths : {&walls.exposed, &walls.retracted}) {
    shape.Add(paths->size());
    for (const int path : *paths) shape.Add(path);
  }
  for (const KnownMove& move : walls.known) {
    shape.Add(move.from);
    shape.Add(move.to);
    shape.Add(move.seconds);
    shape.Add((move.crosses ? 1 : 0) + (move.retracts ? 2 : 0));
  }
  for (const PlanNode& node : plan.nodes) {
    rest(node.children.size() + node.before.size() + 1);
    shape.Add(static_cast<int>(node.kind));
    shape.Add(node.path);
    shape.Add(node.children.size());
    for (const int child : node.children) shape.Add(child);
    for (const auto& [first, second] : node.before) {
      shape.Add(first);
      shape.Add(second);
    }
  }
  exact.Add(shape.value());
  return {shape.value(), exact.value()};
}

uint64_t ProblemKey(uint64_t shape, Point origin, Point start, const std::optional<Point>& finish) {
  Fingerprint key;
  key.Add(shape);
  key.Add(Rounded(start.x - origin.x));
  key.Add(Rounded(start.y - origin.y));
  key.Add(finish ? 1 : 0);
  if (finish) {
    key.Add(Rounded(finish->x - origin.x));
    key.Add(Rounded(finish->y - origin.y));
  }
  return key.value();
}

uint64_t ProblemKeyBefore(uint64_t key, Point origin, uint64_t next_shape, Point next_origin,
                          const std::optional<Point>& next_finish) {
  Fingerprint both;
  both.Add(key);
  both.Add(ProblemKey(next_shape, origin, next_origin, next_finish));
  return both.value();
}

}  // namespace traverse
