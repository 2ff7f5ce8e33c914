// Where layers ended, remembered by what they are made of.

#ifndef TRAVERSE_ENGINE_SCHEDULE_END_HISTORY_H_
#define TRAVERSE_ENGINE_SCHEDULE_END_HISTORY_H_

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "engine/model/cost_spec.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/model/walls.h"

namespace traverse {

// Numbers that equal plans with equal walls and of one cost share, and different ones hardly ever
// do.
struct PlanPrint {
  uint64_t make = 0;  // equal wherever they are; points are taken from the first one on, to 1e-4 mm
  uint64_t place = 0;  // equal and at the very same place
};

// O(points).
PlanPrint PrintOf(const Plan& plan, const CostSpec& cost, const LayerWalls& walls = {});

// Layers of a make that begin, and end if they have to, at the same place of 1e-4 mm as told from
// their origins are of one kind.
uint64_t KindOf(uint64_t make, Point origin, Point start, const std::optional<Point>& finish);

// Layers of one kind before layers of one make that lie, and end if they have to, at the same place
// as told from them.
uint64_t KindBefore(uint64_t kind, Point origin, uint64_t next_make, Point next_origin,
                    const std::optional<Point>& next_finish);

// The first point of the first path, from which the places of a plan are told; 0, 0 if there is
// none.
Point PlanOrigin(const Plan& plan);
inline Point RelativeTo(Point origin, Point p) { return {p.x - origin.x, p.y - origin.y}; }

// Extruded parts repeat their layers, often every second one, and a layer that was seen before will
// most likely end where it ended then, above all if it began at the same place. A guess: nothing
// goes wrong if it is not so. Ends are told from the plan's origin, for layers that were moved.
class EndHistory {
 public:
  // A layer of this make and kind ended here, later than those learned before.
  void Learn(uint64_t make, uint64_t kind, Point end) {
    // A job that never repeats a layer must not grow without bound.
    if (ends_.size() >= kMostEnds) ends_.clear();
    ends_[make] = ends_[kind] = end;
  }

  // Where the last layer of the kind ended, else the last one of the make.
  std::optional<Point> EndOf(uint64_t make, uint64_t kind) const {
    auto found = ends_.find(kind);
    if (found == ends_.end()) found = ends_.find(make);
    return found == ends_.end() ? std::nullopt : std::optional<Point>(found->second);
  }

 private:
  static constexpr size_t kMostEnds = 8192;

  std::unordered_map<uint64_t, Point> ends_;  // by make, and by kind
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_END_HISTORY_H_
