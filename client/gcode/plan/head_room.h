// What stands in the way of new travel: what was finished before, and is higher than a layer.
//
// Mostly nothing does, as the height only goes up. In prints object by object it comes down again,
// and finished objects stand beside the next one, or within it.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_HEAD_ROOM_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_HEAD_ROOM_H_

#include <cstddef>
#include <memory>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/plan/room_map.h"

namespace traverse::gcode {

// The room for the head in some layers.
struct Room {
  RoomMap tip;   // for the nozzle and its cone
  RoomMap head;  // for what hangs beside it, higher

  bool IsClear(Point a, double z_a_mm, Point b, double z_b_mm) const {
    return tip.IsClear(a, z_a_mm, b, z_b_mm) && head.IsClear(a, z_a_mm, b, z_b_mm);
  }
};

// The room in all layers of a file. The machine's clearance is what the file states, or a cautious
// one. Follows the file once, if the height of its layers goes down at all; time is linear in the
// length of its moves. Memory: below 20 MB, and rooms of layers that would take more, or too long,
// are not known: what new travel there meets is found when it is verified.
class HeadRoom {
 public:
  explicit HeadRoom(const GcodeFile& file);

  // Null if nothing is known to stand in the way.
  const Room* Of(size_t layer) const { return rooms_[layer].get(); }

 private:
  std::vector<std::shared_ptr<const Room>> rooms_;  // [layer]
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_HEAD_ROOM_H_
