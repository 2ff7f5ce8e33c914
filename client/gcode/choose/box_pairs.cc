#include "client/gcode/choose/box_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace traverse::gcode {
namespace {

bool Overlap(const BoundingBox& a, const BoundingBox& b) {
  return a.low().x <= b.high().x && b.low().x <= a.high().x && a.low().y <= b.high().y &&
         b.low().y <= a.high().y;
}

// Cells along one axis.
struct Axis {
  double from = 0;
  double cell = 1;
  size_t count = 1;

  size_t At(double value) const {
    const double place = std::floor((value - from) / cell);
    return static_cast<size_t>(std::clamp(place, 0.0, static_cast<double>(count - 1)));
  }
};

// How many boxes that are `mean` long lie in a row of `length`; at most `most`.
double CountOf(double length, double mean, double most) {
  if (!(length > 0) || !std::isfinite(length)) return 1;
  return mean > 0 ? std::clamp(length / mean, 1.0, most) : most;
}

Axis AxisOf(double from, double length, double count) {
  Axis axis;
  axis.from = from;
  if (count < 1 || !(length > 0)) return axis;
  axis.count = static_cast<size_t>(count);
  axis.cell = length / static_cast<double>(axis.count);
  return axis;
}

class CellGrid {
 public:
  explicit CellGrid(const std::vector<BoundingBox>& boxes) : boxes_(boxes) {
    BoundingBox all;
    double width = 0;
    double height = 0;
    size_t n = 0;
    for (const BoundingBox& box : boxes) {
      if (box.empty()) continue;
      all.Add(box);
      width += box.width();
      height += box.height();
      ++n;
    }
    if (n == 0) return;
    const auto count = static_cast<double>(n);
    const double columns = CountOf(all.width(), width / count, count);
    const double rows = CountOf(all.height(), height / count, count);
    // Not many more cells than boxes.
    const double fewer = std::max(std::sqrt(columns * rows / count), 1.0);
    x_ = AxisOf(all.low().x, all.width(), columns / fewer);
    y_ = AxisOf(all.low().y, all.height(), rows / fewer);
    cells_.resize(x_.count * y_.count);
    for (uint32_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i].empty()) continue;
      ForEachCell(boxes[i],
                  [&](size_t, size_t, std::vector<uint32_t>& cell) { cell.push_back(i); });
    }
  }

  // Calls visit(i) once for each box that overlaps `box`.
  template <typename Visit>
  void ForEachOverlapping(const BoundingBox& box, Visit visit) {
    if (cells_.empty() || box.empty()) return;
    ForEachCell(box, [&](size_t x, size_t y, std::vector<uint32_t>& cell) {
      for (const uint32_t i : cell) {
        // A pair meets in several cells; it counts in the one where the common part begins.
        const bool here = x == x_.At(std::max(box.low().x, boxes_[i].low().x)) &&
                          y == y_.At(std::max(box.low().y, boxes_[i].low().y));
        if (here && Overlap(box, boxes_[i])) visit(i);
      }
    });
  }

 private:
  template <typename Visit>
  void ForEachCell(const BoundingBox& box, Visit visit) {
    const size_t last_x = x_.At(box.high().x);
    const size_t last_y = y_.At(box.high().y);
    for (size_t y = y_.At(box.low().y); y <= last_y; ++y) {
      for (size_t x = x_.At(box.low().x); x <= last_x; ++x) visit(x, y, cells_[y * x_.count + x]);
    }
  }

  const std::vector<BoundingBox>& boxes_;
  Axis x_;
  Axis y_;
  std::vector<std::vector<uint32_t>> cells_;
};

}  // namespace

std::vector<std::pair<uint32_t, uint32_t>> OverlappingBoxes(const std::vector<BoundingBox>& a,
                                                            const std::vector<BoundingBox>& b) {
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  CellGrid grid(b);
  for (uint32_t i = 0; i < a.size(); ++i) {
    grid.ForEachOverlapping(a[i], [&](uint32_t j) { pairs.emplace_back(i, j); });
  }
  return pairs;
}

}  // namespace traverse::gcode
