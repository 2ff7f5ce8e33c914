#include "tests/support/problems/walled_problem.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tests/support/problems/brute_force.h"

namespace traverse::testing {
namespace {

Point RandomPoint(Rng& rng) { return {rng.Unit() * 110 - 5, rng.Unit() * 110 - 5}; }

// Where the lines through ab and cd meet, as shares of ab and of cd.
std::optional<std::pair<double, double>> Meet(Point a, Point b, Point c, Point d) {
  const double det = (b.x - a.x) * (d.y - c.y) - (b.y - a.y) * (d.x - c.x);
  if (det == 0) return std::nullopt;
  return std::pair(((c.x - a.x) * (d.y - c.y) - (c.y - a.y) * (d.x - c.x)) / det,
                   ((c.x - a.x) * (b.y - a.y) - (c.y - a.y) * (b.x - a.x)) / det);
}

WalledProblem Own(OwnedProblem owned, LayerWalls walls) {
  WalledProblem walled{std::move(owned), std::move(walls), nullptr};
  walled.cost = std::make_unique<const WallCost>(walled.walls, walled.owned.plan(),
                                                 walled.owned.problem.cost);
  walled.owned.problem.walls = walled.cost.get();
  return walled;
}

}  // namespace

LayerWalls RandomWalls(Rng& rng, const Plan& plan) {
  LayerWalls walls;
  for (int w = rng.Between(1, 6); w > 0; --w) {
    Wall& wall = walls.walls.emplace_back();
    wall.closed = rng.Between(0, 1) == 1;
    const Point center = RandomPoint(rng);
    const double size = 2 + rng.Unit() * 40;
    for (int i = rng.Between(2, 12); i > 0; --i) {
      wall.points.push_back(
          {center.x + (rng.Unit() - 0.5) * size, center.y + (rng.Unit() - 0.5) * size});
    }
  }
  for (size_t p = 0; p < plan.paths.size(); ++p) {
    const Path& path = plan.paths[p];
    if (path.points.size() > 1 && rng.Between(0, 2) == 0) {
      walls.walls.push_back({path.points, path.kind == Path::Kind::kContour, static_cast<int>(p)});
    }
    if (rng.Between(0, 4) == 0) walls.exposed.push_back(static_cast<int>(p));
    if (rng.Between(0, 3) == 0) walls.retracted.push_back(static_cast<int>(p));
    if (p == 0 || rng.Between(0, 2) == 0) continue;
    walls.known.push_back({static_cast<int>(p) - 1, static_cast<int>(p), rng.Unit() * 2,
                           rng.Between(0, 3) == 0, rng.Between(0, 1) == 0});
  }
  return walls;
}

CostSpec RandomWallSpec(Rng& rng) {
  CostSpec spec;
  spec.kind = CostSpec::Kind::kTime;
  spec.speed_mm_s = 20 + rng.Unit() * 200;
  spec.accel_mm_s2 = rng.Between(0, 3) == 0 ? 0 : 500 + rng.Unit() * 4000;
  spec.retraction_seconds = rng.Unit();
  spec.retraction_threshold_mm = rng.Between(0, 1) == 0 ? 1e6 : rng.Unit() * 40;
  spec.wall_retraction_threshold_mm = rng.Between(0, 1) == 0 ? 0 : rng.Unit() * 10;
  spec.exposed_retraction_threshold_mm = rng.Unit() * 10;
  spec.lift_seconds = rng.Between(0, 1) == 0 ? 0 : rng.Unit() * 0.2;
  spec.crossing_seconds = rng.Between(0, 1) == 0 ? 0 : rng.Unit();
  spec.wall_slack_mm = rng.Between(0, 1) == 0 ? 0 : rng.Unit();
  return spec;
}

WalledProblem RandomWalledProblem(uint64_t seed, const RandomPlanOptions& options, bool around) {
  OwnedProblem owned = RandomProblem(seed, options);
  Rng rng(seed + 7);
  owned.problem.cost = RandomWallSpec(rng);
  if (around) owned.problem.cost.wall_clearance_mm = 0.4;
  LayerWalls walls = RandomWalls(rng, owned.plan());
  return Own(std::move(owned), std::move(walls));
}

WalledProblem Turned(const WalledProblem& walled, double angle, Point by) {
  const auto turn = [&](Point& p) {
    p = {p.x * std::cos(angle) - p.y * std::sin(angle) + by.x,
         p.x * std::sin(angle) + p.y * std::cos(angle) + by.y};
  };
  Plan plan = walled.owned.plan();
  for (Path& path : plan.paths) std::for_each(path.points.begin(), path.points.end(), turn);
  OwnedProblem owned(std::move(plan));
  owned.problem.start = walled.problem().start;
  owned.problem.finish = walled.problem().finish;
  owned.problem.cost = walled.problem().cost;
  owned.problem.seed = walled.problem().seed;
  turn(owned.problem.start);
  if (owned.problem.finish) turn(*owned.problem.finish);
  LayerWalls walls = walled.walls;
  for (Wall& wall : walls.walls) std::for_each(wall.points.begin(), wall.points.end(), turn);
  return Own(std::move(owned), std::move(walls));
}

bool CrossesAny(const LayerWalls& walls, double slack_mm, Point from, Point to) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (length == 0) return false;
  const double end = std::min(slack_mm / length, 0.2);
  for (const Wall& wall : walls.walls) {
    for (size_t i = 0; i < wall.points.size() - (wall.closed ? 0 : 1); ++i) {
      const auto shares = Meet(from, to, wall.points[i], wall.points[(i + 1) % wall.points.size()]);
      if (!shares) continue;
      // What only touches the end of a wall's line may be either.
      constexpr double kTouch = 1e-9;
      const auto [along, on_wall] = *shares;
      if (along > end && along < 1 - end && on_wall > kTouch && on_wall < 1 - kTouch) return true;
    }
  }
  return false;
}

double WalledMoveCost(const WalledProblem& walled, Point from, Point to) {
  const CostSpec& spec = walled.problem().cost;
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const bool crosses = CrossesAny(walled.walls, spec.wall_slack_mm, from, to);
  const auto& paths = walled.owned.plan().paths;
  const auto point_of = [&paths](int path, bool last) {
    const Path& of = paths[static_cast<size_t>(path)];
    return of.points[last && of.kind == Path::Kind::kOpen ? 1 : 0];
  };
  for (const KnownMove& move : walled.walls.known) {
    const Point a = point_of(move.from, true);
    const Point b = point_of(move.to, false);
    if (!((a == from && b == to) || (a == to && b == from))) continue;
    CostSpec bare = spec;
    bare.crossing_seconds = 0;
    const double least = MoveCost(bare, from, to);
    return std::max(least, move.seconds) + (move.crosses ? spec.crossing_seconds : 0);
  }
  double pays = 1;
  for (const Point end : {from, to}) {
    bool retracted = false;
    for (const int path : walled.walls.retracted) {
      for (const Point& p : paths[static_cast<size_t>(path)].points) retracted |= p == end;
    }
    if (retracted) pays -= 0.5;
  }
  bool exposed = false;
  for (const int path : walled.walls.exposed) {
    for (const Point& p : walled.owned.plan().paths[static_cast<size_t>(path)].points) {
      exposed = exposed || p == from || p == to;
    }
  }
  CostSpec without = spec;
  without.retraction_seconds = 0;
  double seconds = MoveCost(without, from, to);
  const bool retracts = length > spec.retraction_threshold_mm ||
                        (crosses && length > spec.wall_retraction_threshold_mm) ||
                        (exposed && length > spec.exposed_retraction_threshold_mm);
  if (length > spec.retraction_threshold_mm) pays = 1;
  if (retracts) seconds += spec.retraction_seconds * pays;
  if (crosses) seconds += spec.crossing_seconds + (retracts ? spec.lift_seconds : 0);
  return seconds;
}

}  // namespace traverse::testing
