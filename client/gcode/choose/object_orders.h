// Orders of a layer in which whole labelled objects have changed places.
//
// Slicers print the objects of a layer in the order of their list, or by where they stand on the
// plate; either may lead the head back and forth. One round trip through all objects serves all
// layers, so that every object rests as long between two layers as it did. Backwards in every other
// layer it is shorter still, but its ends are printed twice running: only Policy::kFree has that.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_OBJECT_ORDERS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_OBJECT_ORDERS_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/choose/layer_column.h"
#include "client/gcode/choose/merged_orders.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/plan/layer_freedom.h"

namespace traverse::gcode {

// An object of a layer: the paths [begin, end) of it, one run under one label.
struct LayerObject {
  uint32_t begin = 0;
  uint32_t end = 0;
  uint32_t object = 0;  // Block::object
  // Of each region of the run that it is of, the object before it.
  std::vector<uint32_t> behind = {};
};

// The objects of a layer that may change places.
struct LayerObjects {
  // [run] objects printed one after the other, two at least, none of them twice.
  std::vector<std::vector<LayerObject>> runs;

  // Why objects of this layer, if there are two, keep their places; empty if none does.
  std::string_view barrier;
};

class ObjectOrders {
 public:
  // Learns the round trips. `file` outlives this.
  explicit ObjectOrders(const GcodeFile& file);

  // False if no objects may change places anywhere: fewer than two, or printed one by one.
  bool any() const { return !trips_.empty(); }

  // What prevents that in a file that has objects.
  std::string_view barrier() const { return barrier_; }

  // `freedom` is that of `layer`.
  LayerObjects ObjectsOf(const Layer& layer, const LayerFreedom& freedom) const;

  // `order` with the objects of each run on each round trip, and with `backwards` on the shortest
  // one backwards too; without those that are `order` itself. Nothing if `order` has the objects in
  // another order than the file. REQUIRES: any().
  std::vector<LayerOrder> Moved(const Layer& layer, const LayerObjects& objects,
                                const LayerOrder& order, bool backwards) const;

  // Adds the file's order and the best of the others of layer `layer`, with objects in other
  // places, improved if `rules` say how. REQUIRES: any(), rules.freedom.
  void AddTo(size_t layer, const MergeRules& rules, const ColumnFiller& filler,
             LayerColumn& column) const;

 private:
  using Ranks = absl::flat_hash_map<uint32_t, uint32_t>;  // [Block::object] its place on a trip

  const GcodeFile& file_;
  std::vector<Ranks> trips_;
  std::string_view barrier_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_OBJECT_ORDERS_H_
