#include "client/gcode/hidden/layer_cover.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "client/gcode/model/visible_walls.h"
#include "engine/base/disjoint_sets.h"
#include "engine/geometry/bounding_box.h"

namespace traverse::gcode {
namespace {

// Four megabytes of bits: a plate of half a metre in cells of a tenth of a millimetre.
constexpr double kMostCells = 1 << 25;

// Of lines whose width no comment states: what slicers print.
constexpr double kLeastWidthMm = 0.1;
constexpr double kMostWidthMm = 2;

bool IsWallOfPart(const Outline& outline) {
  return IsVisibleWall(outline.feature) && outline.points.size() >= 2;
}

// Whether its lines show that what is around them is the part.
bool IsOfPart(const Outline& outline) {
  const Feature feature = outline.feature;
  return !IsVisibleWall(feature) && feature != Feature::kSkirt && feature != Feature::kSupport &&
         feature != Feature::kSupportInterface && feature != Feature::kTower &&
         feature != Feature::kCustom;
}

Point InCells(Point mm) { return {mm.x / kCoverCellMm, mm.y / kCoverCellMm}; }

struct Crossing {
  int row = 0;
  double x = 0;  // in cells

  auto operator<=>(const Crossing&) const = default;
};

// Cells of a row in a row that no wall is near to.
struct FreeRun {
  int row = 0;
  int begin = 0;
  int end = 0;
};

class CoverMaker {
 public:
  explicit CoverMaker(const std::vector<Outline>& outlines) : outlines_(outlines) {}

  LayerCover Make();

 private:
  std::optional<CellBox> Box() const;
  void AddWall(const Outline& wall, CellRows& lines);
  void AddLine(Point a, Point b, double radius, CellRows& cells) const;
  void AddCrossings(Point a, Point b);
  CellRows Odd();
  CellRows PointsOfPart() const;
  void FindRuns();
  CellRows Inside(const CellRows& odd);

  const std::vector<Outline>& outlines_;
  CellBox box_;
  CellRows near_;
  CellRows near_open_;  // nobody knows on which side of an open wall the part is
  std::vector<Crossing> crossings_;
  std::vector<FreeRun> runs_;
  std::vector<size_t> first_of_row_;  // [row of the box] of runs_
};

std::optional<CellBox> CoverMaker::Box() const {
  BoundingBox bounds;
  size_t walls = 0;
  for (const Outline& outline : outlines_) {
    if (!IsWallOfPart(outline)) continue;
    ++walls;
    bounds.Add(BoundingBox(outline.shape()));
  }
  // Where there are more than can be printed in one place, some are left out.
  if (walls == 0 || VisibleWallsOf(outlines_).size() != walls) return std::nullopt;
  // A free cell at least is around all walls.
  const double margin = kMostWidthMm + 3 * kCoverCellMm;
  const Point low = InCells({bounds.low().x - margin, bounds.low().y - margin});
  const Point high = InCells({bounds.high().x + margin, bounds.high().y + margin});
  constexpr double kMost = 1 << 29;
  if (low.x < -kMost || low.y < -kMost || high.x > kMost || high.y > kMost) return std::nullopt;
  if ((high.x - low.x) * (high.y - low.y) > kMostCells) return std::nullopt;
  CellBox box;
  const double word = std::floor(low.x / CellRows::kWordCells);
  box.column = static_cast<int>(word) * CellRows::kWordCells;
  box.row = static_cast<int>(std::floor(low.y));
  box.words = static_cast<int>(std::floor(high.x / CellRows::kWordCells) - word) + 1;
  box.rows = static_cast<int>(std::floor(high.y)) - box.row + 1;
  return box;
}

// Sets the cells whose middle is at most `radius` from the line from `a` to `b`; all in cells.
void CoverMaker::AddLine(Point a, Point b, double radius, CellRows& cells) const {
  const double length = Distance(a, b);
  // The sides of the line, as far as it goes straight.
  const Point aside = length > 0
                          ? Point{-(b.y - a.y) / length * radius, (b.x - a.x) / length * radius}
                          : Point{0, 0};
  const auto first = static_cast<int>(std::ceil(std::min(a.y, b.y) - radius - 0.5));
  const auto last = static_cast<int>(std::floor(std::max(a.y, b.y) + radius - 0.5));
  for (int row = first; row <= last; ++row) {
    const double y = row + 0.5;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    const auto add = [&](double x) {
      low = std::min(low, x);
      high = std::max(high, x);
    };
    for (const Point& end : {a, b}) {
      const double dy = y - end.y;
      if (std::abs(dy) > radius) continue;
      const double dx = std::sqrt(radius * radius - dy * dy);
      add(end.x - dx);
      add(end.x + dx);
    }
    for (const double side : {-1.0, 1.0}) {
      const double from = a.y + side * aside.y;
      const double to = b.y + side * aside.y;
      if (from == to || (y - from) * (y - to) > 0) continue;
      add(a.x + side * aside.x + (b.x - a.x) * (y - from) / (to - from));
    }
    if (low > high) continue;
    cells.Set(row, static_cast<int>(std::ceil(low - 0.5)),
              static_cast<int>(std::floor(high - 0.5)) + 1);
  }
}

// Where the line from `a` to `b` crosses the middles of rows.
void CoverMaker::AddCrossings(Point a, Point b) {
  if (a.y > b.y) std::swap(a, b);
  const auto first = static_cast<int>(std::ceil(a.y - 0.5));
  const auto end = static_cast<int>(std::ceil(b.y - 0.5));
  for (int row = first; row < end; ++row) {
    crossings_.push_back({row, a.x + (b.x - a.x) * (row + 0.5 - a.y) / (b.y - a.y)});
  }
}

void CoverMaker::AddWall(const Outline& wall, CellRows& lines) {
  const double half = std::clamp(wall.width_mm, kLeastWidthMm, kMostWidthMm) / 2 / kCoverCellMm;
  constexpr double kHalfDiagonal = std::numbers::sqrt2 / 2;
  const std::vector<Point>& shape = wall.shape();
  const size_t count = wall.is_loop ? shape.size() : shape.size() - 1;
  for (size_t i = 0; i < count; ++i) {
    const Point a = InCells(shape[i]);
    const Point b = InCells(shape[(i + 1) % shape.size()]);
    AddLine(a, b, half + kHalfDiagonal, near_);
    if (!wall.is_loop) AddLine(a, b, half + kHalfDiagonal, near_open_);
    if (half > kHalfDiagonal) AddLine(a, b, half - kHalfDiagonal, lines);
    if (wall.is_loop) AddCrossings(a, b);
  }
}

// The cells whose middle has an odd number of closed walls around it.
CellRows CoverMaker::Odd() {
  CellRows odd(box_);
  std::sort(crossings_.begin(), crossings_.end());
  for (size_t i = 0; i + 1 < crossings_.size(); i += 2) {
    // A closed line crosses the middle of a row an even number of times.
    odd.Set(crossings_[i].row, static_cast<int>(std::ceil(crossings_[i].x - 0.5)),
            static_cast<int>(std::ceil(crossings_[i + 1].x - 0.5)));
  }
  return odd;
}

CellRows CoverMaker::PointsOfPart() const {
  CellRows points(box_);
  const auto add = [&](double x, double y) {
    const double column = std::floor(x / kCoverCellMm);
    const double row = std::floor(y / kCoverCellMm);
    const double end = box_.column + static_cast<double>(box_.words) * CellRows::kWordCells;
    if (column < box_.column || column >= end || row < box_.row || row >= box_.row + box_.rows) {
      return;
    }
    points.Set(static_cast<int>(row), static_cast<int>(column), static_cast<int>(column) + 1);
  };
  for (const Outline& outline : outlines_) {
    if (!IsOfPart(outline)) continue;
    const std::vector<Point>& shape = outline.shape();
    for (size_t i = 0; i < shape.size(); ++i) {
      add(shape[i].x, shape[i].y);
      // Ends may lie near a wall.
      if (i > 0) add((shape[i - 1].x + shape[i].x) / 2, (shape[i - 1].y + shape[i].y) / 2);
    }
  }
  return points;
}

void CoverMaker::FindRuns() {
  const int behind = box_.column + box_.words * CellRows::kWordCells;
  for (int row = box_.row; row < box_.row + box_.rows; ++row) {
    first_of_row_.push_back(runs_.size());
    const absl::Span<const uint64_t> words = std::as_const(near_).Row(row);
    // Where the row changes from free to near or back.
    bool is_free = false;
    for (int word = 0; word < box_.words; ++word) {
      const uint64_t here = ~words[static_cast<size_t>(word)];
      uint64_t changes = here ^ (here << 1 | (is_free ? 1u : 0u));
      for (; changes != 0; changes &= changes - 1) {
        const int at = box_.column + word * CellRows::kWordCells + std::countr_zero(changes);
        is_free = !is_free;
        if (is_free) {
          runs_.push_back({row, at, behind});
        } else {
          runs_.back().end = at;
        }
      }
    }
  }
  first_of_row_.push_back(runs_.size());
}

CellRows CoverMaker::Inside(const CellRows& odd) {
  FindRuns();
  DisjointSets areas(static_cast<int>(runs_.size()));
  for (size_t row = 1; row + 1 < first_of_row_.size(); ++row) {
    size_t above = first_of_row_[row - 1];
    for (size_t run = first_of_row_[row]; run < first_of_row_[row + 1];) {
      if (above == first_of_row_[row]) break;
      const FreeRun& a = runs_[above];
      const FreeRun& b = runs_[run];
      if (a.begin < b.end && b.begin < a.end) {
        areas.Join(static_cast<int>(run), static_cast<int>(above));
      }
      a.end < b.end ? ++above : ++run;
    }
  }
  const CellRows points = PointsOfPart();
  enum : uint8_t { kPart = 1, kOutside = 2 };
  const std::vector<int> area = areas.Numbered();  // [run]
  std::vector<uint8_t> is(runs_.size());           // [area]
  const int behind = box_.column + box_.words * CellRows::kWordCells;
  for (size_t i = 0; i < runs_.size(); ++i) {
    const FreeRun& run = runs_[i];
    uint8_t& of = is[static_cast<size_t>(area[i])];
    if (points.Any(run.row, run.begin, run.end)) of |= kPart;
    const bool at_edge = run.begin == box_.column || run.end == behind;
    if (at_edge || !odd.All(run.row, run.begin, run.end)) of |= kOutside;
  }
  CellRows inside(box_);
  for (size_t i = 0; i < runs_.size(); ++i) {
    if (is[static_cast<size_t>(area[i])] != kPart) continue;
    inside.Set(runs_[i].row, runs_[i].begin, runs_[i].end);
  }
  return inside;
}

LayerCover CoverMaker::Make() {
  const std::optional<CellBox> box = Box();
  if (!box) return {};
  box_ = *box;
  near_ = CellRows(box_);
  near_open_ = CellRows(box_);
  CellRows lines(box_);
  for (const Outline& outline : outlines_) {
    if (IsWallOfPart(outline)) AddWall(outline, lines);
  }
  const CellRows odd = Odd();
  LayerCover made;
  made.inside = Inside(odd);
  made.cover = made.inside;
  for (int row = box_.row; row < box_.row + box_.rows; ++row) {
    const absl::Span<uint64_t> cover = made.cover.Row(row);
    const auto of = [row](const CellRows& cells) { return cells.Row(row); };
    for (size_t i = 0; i < cover.size(); ++i) {
      cover[i] |= of(near_)[i] & ~of(near_open_)[i] & (of(odd)[i] | of(lines)[i]);
    }
  }
  made.near = std::move(near_);
  return made;
}

}  // namespace

LayerCover CoverOf(const std::vector<Outline>& outlines) { return CoverMaker(outlines).Make(); }

}  // namespace traverse::gcode
