// Where layers ended, remembered by what they are made of.

#ifndef TRAVERSE_ENGINE_SCHEDULE_END_HISTORY_H_
#define TRAVERSE_ENGINE_SCHEDULE_END_HISTORY_H_

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "engine/model/plan.h"
#include "engine/model/point.h"

namespace traverse {

// A number that equal plans share, wherever they are, and different plans hardly ever do. Points
// are taken from the first one on, to 1e-4 mm. O(points).
uint64_t PlanFingerprint(const Plan& plan);

// The first point of the first path, from which the places of a plan are told; 0, 0 if there is
// none.
Point PlanOrigin(const Plan& plan);
inline Point RelativeTo(Point origin, Point p) { return {p.x - origin.x, p.y - origin.y}; }

// Extruded parts repeat their layers, often every second one, and a layer that was seen before will
// most likely end where it ended then. A guess: nothing goes wrong if it is not so. Ends are told
// from the plan's origin, for layers that were moved.
class EndHistory {
 public:
  // The layer with this fingerprint ended here, later than those learned before.
  void Learn(uint64_t fingerprint, Point end) {
    // One entry a distinct layer: a job that never repeats one must not grow without bound.
    if (ends_.size() >= kMostLayers && ends_.count(fingerprint) == 0) ends_.clear();
    ends_[fingerprint] = end;
  }

  std::optional<Point> EndOf(uint64_t fingerprint) const {
    const auto found = ends_.find(fingerprint);
    return found == ends_.end() ? std::nullopt : std::optional<Point>(found->second);
  }

 private:
  static constexpr size_t kMostLayers = 4096;

  std::unordered_map<uint64_t, Point> ends_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_END_HISTORY_H_
