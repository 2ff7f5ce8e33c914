// How long islands are left alone between two layers: --min_revisit.
//
// An order that ends a layer with a small island and begins the next one with it prints hot plastic
// on hot plastic. Slicers leave time for cooling by the order they choose; a shorter way must not
// take it back below what the user asks for.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_REVISITS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_REVISITS_H_

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/write/placed_path.h"
#include "engine/geometry/bounding_box.h"

namespace traverse::gcode {

// An order of a layer and the seconds that it takes.
struct TimedOrder {
  const LayerOrder* order = nullptr;
  double seconds = 0;
};

// Islands are the connected regions of paths that touch; one is over another if their boxes
// overlap. Within a layer time goes by with the length printed.
class Revisits {
 public:
  // With `min_seconds` 0 nothing is ever too soon, and nothing is looked at. `file` outlives this.
  Revisits(const GcodeFile& file, double min_seconds, int threads);

  // Whether `next`, an order of layer `layer`, comes back to an island less than the least time
  // after `before`, one of the layer before, has left it, and sooner than the orders of the file
  // do. REQUIRES: layer > 0.
  bool TooSoon(size_t layer, const TimedOrder& before, const TimedOrder& next,
               const TimedOrder& given_before, const TimedOrder& given_next) const;

 private:
  struct LayerIslands {
    std::vector<uint32_t> island;                     // [path of the layer]
    std::vector<double> length;                       // [path of the layer]
    std::vector<BoundingBox> boxes;                   // [island]
    std::vector<std::pair<uint32_t, uint32_t>> over;  // island below, island here
  };

  // When each island of a layer is begun and left, as shares of the layer's time.
  struct Visits {
    std::vector<double> begun;
    std::vector<double> left;
  };

  LayerIslands IslandsOf(size_t layer) const;
  Visits VisitsOf(size_t layer, const LayerOrder& order) const;

  // Seconds from leaving each pair of layers_[layer].over to coming back.
  std::vector<double> Gaps(size_t layer, const TimedOrder& before, const TimedOrder& next) const;

  const GcodeFile& file_;
  const double min_seconds_;
  std::vector<LayerIslands> layers_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_REVISITS_H_
