// Which travel moves nobody can see, even if filament oozes on their way.
//
//   layer above   ~~~~~~~~~~~~~~~~~~~    covers all of the travel
//   this layer    |w| ----------> |w|    the travel lies inside, half a width from visible walls
//   layer below   ===================    supports all of the travel
//
// It is inside whatever the order of the layer: what oozes where something is yet to be printed
// is printed over. Certain in cells of a tenth of a millimetre; what is not certain is not hidden.

#ifndef TRAVERSE_CLIENT_GCODE_HIDDEN_HIDDEN_MOVES_H_
#define TRAVERSE_CLIENT_GCODE_HIDDEN_HIDDEN_MOVES_H_

#include <cstddef>
#include <vector>

#include "client/gcode/hidden/cell_tiles.h"
#include "client/gcode/model/gcode_file.h"
#include "engine/model/point.h"

namespace traverse::gcode {

class HiddenMoves {
 public:
  // No move longer than `longest_mm` is hidden. In a layer without one below or above at the usual
  // distance, or with several tools, none is. O(length of all walls + cells / 64).
  HiddenMoves(const GcodeFile& file, double longest_mm, int threads = 1);

  // The same of some layers alone; in the others nothing is hidden.
  HiddenMoves(const GcodeFile& file, double longest_mm, const std::vector<size_t>& layers);

  // Whether the straight move from `a` to `b` in layer `layer` is hidden. `leaves_wall`: a visible
  // wall ends at `a`; then the move may begin there, else it keeps away from all of them.
  bool Hides(size_t layer, Point a, Point b, bool leaves_wall) const;

  double longest_mm() const { return longest_mm_; }

 private:
  struct LayerTiles {
    CellTiles hidden;
    CellTiles leaving;  // near a visible wall; hidden where that is left
  };

  void Fill(const GcodeFile& file, size_t first, size_t end);

  const double longest_mm_;
  std::vector<LayerTiles> layers_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_HIDDEN_HIDDEN_MOVES_H_
