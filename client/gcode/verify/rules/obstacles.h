// What stands in the way of the head: a finished object in a print object by object, a tower.
//
// No new move leads below the top of anything printed before, nor so near to it that the nozzle's
// cone or, above that, the head's other parts would touch it. Where the original's own moves and
// paths lead, since the height of what is printed last went down, the head may be in any case; and
// as near as they lead to each place that stands.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_RULES_OBSTACLES_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_RULES_OBSTACLES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "client/gcode/verify/findings.h"
#include "client/gcode/verify/match/height_grid.h"
#include "client/gcode/verify/match/layer_pair.h"

namespace traverse::gcode {

// Is told of all layers in their order.
class Obstacles {
 public:
  // `settings` are those that the original states.
  Obstacles(const SlicerSettings& settings, const WorkLimit& limit);

  // Layer `layer` of both chunks, with the travel to it. REQUIRES: the same is printed in it.
  void CheckLayer(const TraceChunk& was, const TraceChunk& is, size_t layer,
                  std::vector<Finding>& breaks);

  // What follows the last path of both files.
  void CheckEnd(const TraceChunk& was, const TraceChunk& is, std::vector<Finding>& breaks);

 private:
  void Print(const TraceChunk& was, uint32_t first_path, uint32_t end_path);
  void Visit(const TraceChunk& was, uint32_t link);
  void CheckLink(const TraceChunk& is, uint32_t link, int64_t layer, std::vector<Finding>& breaks);
  bool AnyAbove(const TraceChunk& chunk, uint32_t first_link, uint32_t end_link) const;

  const WorkLimit limit_;
  HeightGrid tip_;                                        // the nozzle and its cone
  HeightGrid head_;                                       // what hangs beside it, higher
  double z_mm_ = 0;                                       // of the layer before
  absl::flat_hash_set<std::array<double, 6>> moves_was_;  // of the original in this layer
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_RULES_OBSTACLES_H_
