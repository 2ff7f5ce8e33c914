#include "client/view/scene/printed_route.h"

#include <cmath>
#include <optional>
#include <utility>

#include "client/gcode/link/link.h"

namespace traverse::view {
namespace {

constexpr double kSameMm = 1e-3;
constexpr double kSameLengthMm = 5e-3;  // blocks keep their lengths as float

// A loop that begins elsewhere than sliced may end before its start, by the gap that it had.
constexpr double kLongestGapMm = 0.25;

bool Same(const DrawnPoint& a, const DrawnPoint& b) {
  return std::abs(a.x - b.x) < kSameMm && std::abs(a.y - b.y) < kSameMm;
}

// The blocks of one layer of a file, one after the other.
class BlockWalk {
 public:
  BlockWalk(const GcodeFile& file, size_t layer, const std::vector<gcode::LinkLook>& looks)
      : file_(file),
        looks_(looks),
        first_(file.layers[layer].first_block),
        next_(file.layers[layer].first_block),
        end_(file.layers[layer].end_block),
        unit_(file.modes[file.blocks[next_].mode].UnitMm()) {}

  bool AtEnd() const { return next_ == end_; }
  DrawnPoint First() const { return PointOf(file_.blocks[next_].first); }

  // Where the head is before the layer. The start script's approach to the very first path is not
  // drawn.
  DrawnPoint Start() const { return next_ > 0 ? PointOf(file_.blocks[next_ - 1].last) : First(); }

  // The points that the head passes from the last block to this one, including the ends of both.
  std::vector<DrawnPoint> Corners() const {
    if (next_ == 0) return {};
    std::vector<DrawnPoint> corners = {PointOf(file_.blocks[next_ - 1].last)};
    for (const gcode::LinkStep& step : gcode::ReadLink(file_, next_).steps) {
      if (gcode::IsXyMotion(step.kind)) corners.push_back(PointOf(step.to));
    }
    return corners;
  }

  // Of the travel to the block.
  DrawnForm Form() const {
    const gcode::LinkLook& look = looks_[next_ - first_];
    if (look.retracts) return DrawnForm::kRetracted;
    return look.hidden ? DrawnForm::kHidden : DrawnForm::kOpen;
  }

  // The length that the block extrudes; moves on to the next block.
  double Take() { return static_cast<double>(file_.blocks[next_++].length_mm); }

 private:
  DrawnPoint PointOf(const gcode::Position& at) const {
    return {gcode::ToDouble(at.x) * unit_, gcode::ToDouble(at.y) * unit_};
  }

  const GcodeFile& file_;
  const std::vector<gcode::LinkLook>& looks_;
  const size_t first_;
  size_t next_;
  size_t end_;
  double unit_;
};

// `corners` without those that are the ends of the move itself.
std::vector<DrawnPoint> Between(std::vector<DrawnPoint> corners, const DrawnPoint& from,
                                const DrawnPoint& to) {
  if (!corners.empty() && Same(corners.back(), to)) corners.pop_back();
  if (!corners.empty() &&
      std::hypot(corners.front().x - from.x, corners.front().y - from.y) < kLongestGapMm) {
    corners.erase(corners.begin());
  }
  return corners;
}

// `order` with the corners of `printed`; nothing if its blocks have another order.
std::optional<std::vector<DrawnVisit>> WithCorners(const GcodeFile& printed, size_t layer,
                                                   const SlicedPaths& sliced,
                                                   std::vector<DrawnVisit> order,
                                                   const std::vector<gcode::LinkLook>& looks) {
  BlockWalk walk(printed, layer, looks);
  DrawnPoint at = walk.Start();
  double ahead = 0;  // how much more the blocks so far extrude than the paths so far
  for (DrawnVisit& visit : order) {
    const DrawnPath& path = sliced.paths[visit.path];
    const DrawnPoint entry = EntryOf(path, visit);
    if (ahead < kSameLengthMm) {
      if (walk.AtEnd() || !Same(walk.First(), entry)) return std::nullopt;
      visit.via = Between(walk.Corners(), at, entry);
      visit.form = walk.Form();
      ahead = walk.Take();
    }
    ahead -= sliced.lengths_mm[visit.path];
    while (ahead < -kSameLengthMm && !walk.AtEnd()) ahead += walk.Take();
    if (ahead < -kSameLengthMm) return std::nullopt;
    at = ExitOf(path, visit);
  }
  if (!walk.AtEnd() || ahead > kSameLengthMm) return std::nullopt;
  return order;
}

}  // namespace

std::vector<DrawnVisit> InOrder(size_t paths) {
  std::vector<DrawnVisit> visits(paths);
  for (size_t i = 0; i < paths; ++i) visits[i].path = i;
  return visits;
}

DrawnRoute PrintedRoute(const GcodeFile& printed, size_t layer, const SlicedPaths& sliced,
                        const std::vector<DrawnVisit>& order,
                        const std::vector<gcode::LinkLook>& looks) {
  DrawnRoute route;
  route.start = BlockWalk(printed, layer, looks).Start();
  route.visits = WithCorners(printed, layer, sliced, order, looks).value_or(order);
  return route;
}

}  // namespace traverse::view
