#include "client/gcode/verify/match/touched_walls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "absl/container/flat_hash_map.h"

namespace traverse::gcode {
namespace {

// Lines are wider than twice this. Chords of arcs and rounded coordinates are not that far off.
constexpr double kTouchMm = 0.08;
constexpr double kNearerMm = 0.05;
constexpr double kFarMm = kTouchMm + kNearerMm;
constexpr double kAwayMm = 0.5;

// The walls beside one end of some travel, and where it leaves each of them.
class WallsAtEnd {
 public:
  // `moves` begin at the end.
  WallsAtEnd(const PieceTree& walls, std::vector<Piece> moves)
      : walls_(walls), moves_(std::move(moves)) {
    ForEachNear(moves_.front().a, [&](uint32_t path, double mm) {
      WallHere& wall = here_[path];
      wall.end_mm = std::min(wall.end_mm, mm);
    });
  }

  // True if the end is farther from `wall` than move `move`, which comes as near as `mm`, or if the
  // travel is away from the wall before it comes near this piece of it on that move.
  bool IsAway(const Piece& wall, size_t move, double mm) {
    const auto here = here_.find(wall.path);
    if (here == here_.end() || mm + kNearerMm < std::min(here->second.end_mm, kFarMm)) return true;
    if (!followed_) Follow();
    const WallHere& found = here->second;
    if (found.left_on > move) return false;
    if (found.left_on < move) return true;
    return DistanceOfPieces(moves_[move].a, found.left_at, wall.a, wall.b) >= kAwayMm;
  }

 private:
  struct WallHere {
    double end_mm = kAwayMm;    // from the end
    size_t beside_until = 0;    // the last point that is near it
    size_t left_on = SIZE_MAX;  // the move; SIZE_MAX: not left
    Point left_at;
  };

  // Calls visit(path, mm) for pieces of walls nearer to `point` than kAwayMm.
  template <typename Visit>
  void ForEachNear(Point point, Visit visit) const {
    walls_.ForEachNear(point, point, kAwayMm, [&](uint32_t p) {
      const Piece& wall = walls_.pieces()[p];
      const double mm = DistanceToPiece(point, wall.a, wall.b);
      if (mm < kAwayMm) visit(wall.path, mm);
      return true;
    });
  }

  // From point to point until all walls are left: those beside one point that were beside each
  // before it.
  void Follow() {
    constexpr double kStepMm = 0.2;
    constexpr double kMostSteps = 10'000;  // farther than any printer moves
    followed_ = true;
    std::vector<WallHere*> beside;
    beside.reserve(here_.size());
    for (auto& [path, wall] : here_) beside.push_back(&wall);
    size_t points = 0;
    for (size_t move = 0; move < moves_.size(); ++move) {
      const auto& [a, b, path] = moves_[move];
      const double steps = std::min(std::ceil(Distance(a, b) / kStepMm), kMostSteps);
      for (double step = 0; step <= steps && !beside.empty(); ++step) {
        const Point at = Between(a, b, steps > 0 ? step / steps : 0);
        ++points;
        ForEachNear(at, [&](uint32_t near, double) {
          const auto wall = here_.find(near);
          if (wall != here_.end()) wall->second.beside_until = points;
        });
        std::erase_if(beside, [&](WallHere* wall) {
          if (wall->beside_until == points) return false;
          wall->left_on = move;
          wall->left_at = at;
          return true;
        });
      }
    }
  }

  const PieceTree& walls_;
  const std::vector<Piece> moves_;
  absl::flat_hash_map<uint32_t, WallHere> here_;  // by path
  bool followed_ = false;
};

std::vector<Piece> Backwards(std::vector<Piece> moves) {
  std::ranges::reverse(moves);
  for (Piece& move : moves) std::swap(move.a, move.b);
  return moves;
}

}  // namespace

bool TouchesWall(const PieceTree& walls, const std::vector<Piece>& moves) {
  if (moves.empty()) return false;
  WallsAtEnd begin(walls, moves);
  WallsAtEnd end(walls, Backwards(moves));
  for (size_t m = 0; m < moves.size(); ++m) {
    const Piece& move = moves[m];
    const bool touches = walls.AnyNear(move.a, move.b, kTouchMm, [&](const Piece& wall) {
      const double mm = DistanceOfPieces(move.a, move.b, wall.a, wall.b);
      return mm < kTouchMm && begin.IsAway(wall, m, mm) &&
             end.IsAway(wall, moves.size() - 1 - m, mm);
    });
    if (touches) return true;
  }
  return false;
}

}  // namespace traverse::gcode
