// Where layers ended, remembered by what they are made of.

#ifndef TRAVERSE_ENGINE_SCHEDULE_END_HISTORY_H_
#define TRAVERSE_ENGINE_SCHEDULE_END_HISTORY_H_

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "engine/model/point.h"

namespace traverse {

// Extruded parts repeat their layers, often every second one, and a layer that was seen before will
// most likely end where it ended then, above all if it began at the same place. A guess: nothing
// goes wrong if it is not so. Ends are told from the plan's origin, for layers that were moved.
class EndHistory {
 public:
  // A layer of this shape and key ended here, later than those learned before.
  void Learn(uint64_t shape, uint64_t key, Point end) {
    // A job that never repeats a layer must not grow without bound.
    if (ends_.size() >= kMostEnds) ends_.clear();
    ends_[shape] = ends_[key] = end;
  }

  // Where the last layer of the key ended, else the last one of the shape.
  std::optional<Point> EndOf(uint64_t shape, uint64_t key) const {
    auto found = ends_.find(key);
    if (found == ends_.end()) found = ends_.find(shape);
    return found == ends_.end() ? std::nullopt : std::optional<Point>(found->second);
  }

 private:
  static constexpr size_t kMostEnds = 8192;

  std::unordered_map<uint64_t, Point> ends_;  // by shape, and by key
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_END_HISTORY_H_
