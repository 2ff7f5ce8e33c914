#include "client/gcode/verify/match/laid_over.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/gcode/verify/match/piece_tree.h"

namespace traverse::gcode {
namespace {

constexpr double kMostShare = 0.75;  // of the usual flow: more fills what is left between lines
constexpr double kWidestMm = 2.5;    // the distance of lines from each other, at most
constexpr double kUsualMm = 0.4;     // where no two lie side by side
constexpr double kTouch = 1.3;       // lines farther apart, in their usual distance, leave a gap
constexpr double kOnItMm = 0.02;

// How far `p` lies beside the piece; a negative number if it lies before its ends, or if the piece
// does not run along `line`.
double DistanceBeside(Point p, const Piece& line, const Piece& piece) {
  constexpr double kAlong = 0.95;  // cosine of the angle between them
  const double dx = piece.b.x - piece.a.x;
  const double dy = piece.b.y - piece.a.y;
  const double length = std::sqrt(dx * dx + dy * dy);
  const double along = dx * (line.b.x - line.a.x) + dy * (line.b.y - line.a.y);
  if (std::abs(along) < kAlong * length * Distance(line.a, line.b) || length <= 0) return -1;
  const double at = (p.x - piece.a.x) * dx + (p.y - piece.a.y) * dy;
  if (at < 0 || at > length * length) return -1;
  return std::abs((p.x - piece.a.x) * dy - (p.y - piece.a.y) * dx) / length;
}

class LaidLayer {
 public:
  explicit LaidLayer(const std::vector<LaidPath>& paths)
      : paths_(paths), tree_(AllOf(paths)), looks_(tree_.most_looks()), spacing_(UsualSpacing()) {}

  // True if most of the path lies over earlier ones.
  bool LiesOver(uint32_t path) {
    constexpr int kPoints = 16;
    const double length = LengthOf(paths_[path].pieces);
    if (length < spacing_ / 2) return false;  // a dot lies on what it continues
    int seen = 0;
    int over = 0;
    double at = 0;
    for (const Piece& piece : paths_[path].pieces) {
      const double own = Distance(piece.a, piece.b);
      for (; own > 0 && seen < kPoints; ++seen) {
        const double along = ((seen + 0.5) / kPoints * length - at) / own;
        if (along > 1) break;
        over += IsOver(Between(piece.a, piece.b, along), piece, path) ? 1 : 0;
      }
      at += own;
    }
    return over * 2 > seen;
  }

 private:
  static std::vector<Piece> AllOf(const std::vector<LaidPath>& paths) {
    std::vector<Piece> pieces;
    for (uint32_t path = 0; path < paths.size(); ++path) {
      for (const Piece& piece : paths[path].pieces) pieces.push_back({piece.a, piece.b, path});
    }
    return pieces;
  }

  // The distance between solid lines that lie side by side: the median, by filament.
  double UsualSpacing() {
    constexpr double kPoints = 400;
    double filament = 0;
    for (const Piece& piece : tree_.pieces()) {
      const LaidPath& path = paths_[piece.path];
      if (path.solid) filament += Distance(piece.a, piece.b) * path.filament_per_mm;
    }
    std::vector<double> distances;
    double seen = 0;
    double next = filament / kPoints / 2;
    for (uint32_t i = 0; i < tree_.pieces().size(); ++i) {
      const Piece& piece = tree_.pieces()[i];
      const LaidPath& path = paths_[piece.path];
      const double own = Distance(piece.a, piece.b) * path.filament_per_mm;
      if (!path.solid || own <= 0) continue;
      for (; next < seen + own; next += filament / kPoints) {
        const Point at = Between(piece.a, piece.b, (next - seen) / own);
        const double found = BesideEarlier(at, piece, i);
        if (found < kWidestMm) distances.push_back(found);
      }
      seen += own;
    }
    if (distances.empty()) return kUsualMm;
    const auto middle = distances.begin() + static_cast<ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    return *middle;
  }

  // The distance from `p`, which lies on `line`, to the nearest solid piece before it in the tree
  // that runs beside it; kWidestMm if there is none.
  double BesideEarlier(Point p, const Piece& line, uint32_t index) {
    double least = kWidestMm;
    tree_.ForEachNear(p, p, kWidestMm, [&](uint32_t i) {
      const Piece& other = tree_.pieces()[i];
      if (looks_ == 0) return false;
      --looks_;
      if (i >= index || !paths_[other.path].solid) return true;
      const double distance = DistanceBeside(p, line, other);
      if (distance > kOnItMm) least = std::min(least, distance);
      return true;
    });
    return least;
  }

  // The nearest earlier lines on opposite sides of a point.
  struct Sides {
    double left;
    double right;
    double ahead;
    double behind;

    double Gap() const { return std::min(left + right, ahead + behind); }
  };

  // True if `p`, which lies on `line` of `path`, lies between two earlier lines without a gap, or
  // on one.
  bool IsOver(Point p, const Piece& line, uint32_t path) {
    const double reach = kTouch * spacing_;
    const double length = Distance(line.a, line.b);
    const Point along{(line.b.x - line.a.x) / length, (line.b.y - line.a.y) / length};
    Sides sides{reach, reach, reach, reach};
    tree_.ForEachNear(p, p, reach, [&](uint32_t i) {
      const Piece& other = tree_.pieces()[i];
      if (looks_ == 0) return false;
      --looks_;
      if (other.path < path) Include(other, p, along, sides);
      return sides.Gap() > reach;
    });
    return sides.Gap() <= reach || looks_ == 0;
  }

  static void Include(const Piece& other, Point p, Point along, Sides& sides) {
    const Point nearest = NearestTo(p, other.a, other.b);
    const double distance = Distance(p, nearest);
    if (distance <= kOnItMm) {
      sides = {0, 0, 0, 0};
      return;
    }
    constexpr double kOblique = 0.3;  // sine of the angle from which on it lies on a side, too
    const Point to{(nearest.x - p.x) / distance, (nearest.y - p.y) / distance};
    const double aside = along.x * to.y - along.y * to.x;
    const double ahead = along.x * to.x + along.y * to.y;
    const auto include = [distance](double where, double& one, double& opposite) {
      if (std::abs(where) < kOblique) return;
      double& side = where > 0 ? one : opposite;
      side = std::min(side, distance);
    };
    include(aside, sides.left, sides.right);
    // A line that it goes on from is not one that it crosses.
    const double turn = along.x * (other.b.y - other.a.y) - along.y * (other.b.x - other.a.x);
    if (std::abs(turn) < kOblique * Distance(other.a, other.b)) return;
    include(ahead, sides.ahead, sides.behind);
  }

  const std::vector<LaidPath>& paths_;
  const PieceTree tree_;
  size_t looks_;  // left; where none is, nothing may pass anything
  const double spacing_;
};

// The filament per mm with which half of that of solid paths is laid, or less.
double UsualFlow(const std::vector<LaidPath>& paths) {
  std::vector<std::pair<double, double>> flows;  // filament per mm, filament
  double left = 0;
  for (const LaidPath& path : paths) {
    if (!path.solid) continue;
    flows.emplace_back(path.filament_per_mm, path.filament_per_mm * LengthOf(path.pieces));
    left += flows.back().second;
  }
  std::ranges::sort(flows);
  for (const auto& [flow, filament] : flows) {
    left -= 2 * filament;
    if (left <= 0) return flow;
  }
  return 0;
}

}  // namespace

std::vector<bool> LaidOver(const std::vector<LaidPath>& paths, const WorkLimit& limit) {
  std::vector<bool> over(paths.size(), false);
  const double most = kMostShare * UsualFlow(paths);
  const auto asks = [most](const LaidPath& path) {
    return path.asked && path.filament_per_mm < most;
  };
  if (std::ranges::none_of(paths, asks)) return over;
  LaidLayer layer(paths);
  for (uint32_t path = 0; path < paths.size() && !limit.Ended(); ++path) {
    over[path] = asks(paths[path]) && layer.LiesOver(path);
  }
  return over;
}

}  // namespace traverse::gcode
