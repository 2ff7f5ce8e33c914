#include "engine/cost/wall_cost.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "engine/base/rest.h"

namespace traverse {
namespace {

// Moves remembered for each path, and at most; more of them if a forgotten move means searching for
// a detour again.
constexpr size_t kMovesPerPath = 64;
constexpr size_t kMostMoves = size_t{1} << 15;
constexpr size_t kDetoursPerPath = 512;
constexpr size_t kMostDetours = size_t{1} << 16;

// The cost of a question with an unknown answer, relative to one with a known answer, and the
// additional cost of each test for a detour.
constexpr int64_t kWorkOfCrossing = 5;
constexpr int64_t kWorkOfTest = 6;

// What Rest counts for a point and a move that are put into a table.
constexpr size_t kStepsOfPoint = 8;
constexpr size_t kStepsOfKnownMove = 32;

// A point this many slacks from the middle of a wall still lies on it.
constexpr double kOnWall = 1.2;

bool Less(Point a, Point b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); }

uint64_t Mix(uint64_t state, double value) {
  return (std::rotl(state, 23) ^ std::bit_cast<uint64_t>(value)) * 0x9e3779b97f4a7c15u;
}

std::array<double, 4> KeyOf(Point a, Point b) {
  if (Less(b, a)) std::swap(a, b);
  return {a.x, a.y, b.x, b.y};
}

size_t PlacesFor(size_t paths, bool detours) {
  const size_t wanted = paths * (detours ? kDetoursPerPath : kMovesPerPath);
  return std::bit_ceil(std::clamp<size_t>(wanted, 1024, detours ? kMostDetours : kMostMoves));
}

}  // namespace

double TravelCost::WithWalls(Point from, Point to) const {
  return walls_unit_ * (*walls_)(from, to);
}

WallCost::WallCost(const LayerWalls& walls, const Plan& plan, const CostSpec& spec, Budget* budget)
    : spec_(spec),
      base_(spec),
      grid_(walls.walls, spec.wall_slack_mm, budget),
      detours_(spec.wall_clearance_mm > 0
                   ? std::optional<WallDetours>(std::in_place, grid_, spec.wall_clearance_mm,
                                                kOnWall * spec.wall_slack_mm, budget)
                   : std::nullopt),
      places_(PlacesFor(plan.paths.size(), detours_.has_value())) {
  assert(spec.kind == CostSpec::Kind::kTime && CheckWalls(walls, plan).ok());
  NotePoints(walls, plan, budget);
}

void WallCost::NotePoints(const LayerWalls& walls, const Plan& plan, Budget* budget) {
  Rest rest(budget);
  const auto note = [this](Point point) -> PointFacts& { return points_[{point.x, point.y}]; };
  const auto note_all = [&](const std::vector<int>& paths, bool PointFacts::*fact) {
    for (const int path : paths) {
      const std::vector<Point>& points = plan.paths[static_cast<size_t>(path)].points;
      rest(kStepsOfPoint * points.size() + 1);
      for (const Point& point : points) note(point).*fact = true;
    }
  };
  note_all(walls.exposed, &PointFacts::exposed);
  note_all(walls.retracted, &PointFacts::retracted);
  for (const KnownMove& move : walls.known) {
    rest(kStepsOfKnownMove);
    const Path& from = plan.paths[static_cast<size_t>(move.from)];
    const Point a = from.points[from.kind == Path::Kind::kOpen ? 1 : 0];
    const Point b = plan.paths[static_cast<size_t>(move.to)].points[0];
    note(a).known = true;
    note(b).known = true;
    moves_.emplace(KeyOf(a, b), move);
  }
}

WallCost::WallCost(const WallCost* first, const WallCost* second,
                   const std::vector<std::pair<Point, Point>>& second_points, const CostSpec& spec)
    : spec_(spec),
      base_(spec),
      grid_({}, 0),
      two_layers_(true),
      first_(first),
      second_(second),
      places_(0) {
  assert(first == nullptr || first->spec_ == spec);
  assert(second == nullptr || second->spec_ == spec);
  for (const auto& [asked, meant] : second_points) {
    second_points_.emplace(std::pair(asked.x, asked.y), meant);
  }
}

double WallCost::OfTwoLayers(Point a, Point b) const {
  const auto at_a = second_points_.find({a.x, a.y});
  const auto at_b = second_points_.find({b.x, b.y});
  const bool in_second = at_a != second_points_.end() || at_b != second_points_.end();
  const WallCost* cost = in_second ? second_ : first_;
  if (at_a != second_points_.end()) a = at_a->second;
  if (at_b != second_points_.end()) b = at_b->second;
  return cost != nullptr ? (*cost)(a, b) : base_(a, b);
}

WallCost::PointFacts WallCost::FactsOf(Point point) const {
  const auto found = points_.find({point.x, point.y});
  return found != points_.end() ? found->second : PointFacts();
}

const KnownMove* WallCost::FindKnown(Point a, Point b, const EndFacts& ends) const {
  if (!ends.a.known || !ends.b.known) return nullptr;
  const auto found = moves_.find(KeyOf(a, b));
  return found != moves_.end() ? &found->second : nullptr;
}

WallMove WallCost::Done(const KnownMove& known, Point a, Point b) const {
  WallMove move;
  move.crosses = known.crosses;
  move.retracts = known.retracts;
  move.length_mm = Distance(a, b);
  move.cost = std::max(known.seconds, base_.OfLength(move.length_mm));
  if (known.crosses) move.cost += spec_.crossing_seconds;
  return move;
}

WallMove WallCost::Straight(Point a, Point b, const EndFacts& ends, bool crosses) const {
  WallMove move;
  move.crosses = crosses;
  move.length_mm = Distance(a, b);
  move.cost = base_.OfLength(move.length_mm);
  move.retracts = move.length_mm > spec_.retraction_threshold_mm;
  if (!move.retracts &&
      ((crosses && move.length_mm > spec_.wall_retraction_threshold_mm) ||
       (move.length_mm > spec_.exposed_retraction_threshold_mm && ends.exposed()))) {
    move.retracts = true;
    move.cost += spec_.retraction_seconds * ends.share_of_retraction();
  }
  if (crosses) move.cost += spec_.crossing_seconds + (move.retracts ? spec_.lift_seconds : 0);
  return move;
}

WallMove WallCost::MoveOf(Point a, Point b) const {
  const EndFacts ends = FactsOf(a, b);
  if (const KnownMove* known = FindKnown(a, b, ends)) return Done(*known, a, b);
  WallMove straight = Straight(a, b, ends, grid_.Crosses(a, b));
  if (!straight.crosses || !detours_) return straight;
  const bool swapped = Less(b, a);
  if (swapped) std::swap(a, b);
  int64_t tests = 0;
  std::vector<Point> via = detours_->Around(a, b, &tests);
  work_ += tests * kWorkOfTest;
  if (via.empty()) return straight;
  WallMove around;
  Point at = a;
  for (const Point& bend : via) {
    around.length_mm += Distance(at, bend);
    around.cost += base_.Motion(Distance(at, bend));
    at = bend;
  }
  around.length_mm += Distance(at, b);
  around.cost += base_.Motion(Distance(at, b));
  around.retracts = around.length_mm > spec_.retraction_threshold_mm;
  if (around.retracts) {
    around.cost += spec_.retraction_seconds;
  } else if (around.length_mm > spec_.exposed_retraction_threshold_mm && ends.exposed()) {
    around.retracts = true;
    around.cost += spec_.retraction_seconds * ends.share_of_retraction();
  }
  if (around.cost >= straight.cost) return straight;
  if (swapped) std::reverse(via.begin(), via.end());
  around.via = std::move(via);
  return around;
}

double WallCost::PriceOf(Point a, Point b) const {
  if (two_layers_ || detours_) return 0;
  const KnownMove* const known = FindKnown(a, b, FactsOf(a, b));
  const bool crosses = known != nullptr ? known->crosses : grid_.Crosses(a, b);
  return crosses ? spec_.crossing_seconds : 0;
}

int64_t WallCost::work() const {
  if (!two_layers_) return work_;
  return (first_ != nullptr ? first_->work() : 0) + (second_ != nullptr ? second_->work() : 0);
}

WallCost::Priced WallCost::Compute(Point a, Point b) const {
  work_ += kWorkOfCrossing;
  const auto priced = [](const WallMove& move) { return Priced{move.cost, move.retracts}; };
  if (detours_) return priced(MoveOf(a, b));
  const EndFacts ends = FactsOf(a, b);
  if (const KnownMove* known = FindKnown(a, b, ends)) return priced(Done(*known, a, b));
  return priced(Straight(a, b, ends, grid_.Crosses(a, b)));
}

WallCost::Priced WallCost::Price(Point a, Point b) const {
  assert(!two_layers_);
  if (known_.empty()) known_.resize(places_);
  ++work_;
  if (Less(b, a)) std::swap(a, b);
  const uint64_t hash = Mix(Mix(Mix(Mix(1, a.x), a.y), b.x), b.y);
  Known& known = known_[(hash >> 40) & (places_ - 1)];
  const bool is_known = known.move.cost >= 0 && known.a == a && known.b == b;
  if (!is_known) known = {a, b, Compute(a, b)};
  return known.move;
}

}  // namespace traverse
