// How long islands rest between two layers: --min_revisit.
//
// An order that ends a layer with a small island and begins the next layer with it prints hot
// plastic on hot plastic. The order that slicers choose leaves time for cooling; shorter travel
// must not reduce that below what the user asks for.

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

// An order of a layer, and the seconds that it takes.
struct TimedOrder {
  const LayerOrder* order = nullptr;
  double seconds = 0;
};

// Islands are the connected regions of touching paths; one is above another if their boxes overlap.
// Within a layer, time is proportional to the printed length.
class Revisits {
 public:
  // With `min_seconds` 0 nothing is too soon or even examined. `file` must outlive this.
  Revisits(const GcodeFile& file, double min_seconds, int threads);

  // Whether `next`, an order of layer `layer`, returns to an island less than the least time after
  // `before`, an order of the layer before, has left it, and sooner than the file's own orders do.
  // REQUIRES: layer > 0.
  bool TooSoon(size_t layer, const TimedOrder& before, const TimedOrder& next,
               const TimedOrder& given_before, const TimedOrder& given_next) const;

 private:
  struct LayerIslands {
    std::vector<uint32_t> island;                     // [path of the layer]
    std::vector<double> length;                       // [path of the layer]
    std::vector<BoundingBox> boxes;                   // [island]
    std::vector<std::pair<uint32_t, uint32_t>> over;  // island below, island of this layer
  };

  // When each island of a layer begins and ends, as shares of the layer's time.
  struct Visits {
    std::vector<double> begun;
    std::vector<double> left;
  };

  LayerIslands IslandsOf(size_t layer) const;
  Visits VisitsOf(size_t layer, const LayerOrder& order) const;

  // For each pair of layers_[layer].over, the seconds from leaving the lower to reaching the upper.
  std::vector<double> Gaps(size_t layer, const TimedOrder& before, const TimedOrder& next) const;

  const GcodeFile& file_;
  const double min_seconds_;
  std::vector<LayerIslands> layers_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_REVISITS_H_
