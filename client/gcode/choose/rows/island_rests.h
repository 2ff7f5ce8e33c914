// How long islands rest before they are printed on.
//
// An order that ends a layer with a small island, followed by one that begins with it, prints hot
// plastic on hot plastic. Slicers leave time for cooling: a least layer time, and an order that
// comes back to a place late. An island rests from the end of its last path until the first path of
// an island above it (stacked_islands.h). It must rest as long as in the file, or for the least
// time if that is shorter; and so must what counts as one island (island_tree.h). Where the file
// prints nothing else meanwhile, it does not rest, and need not here. Times are nominal ones
// (nominal_time.h).

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_ISLAND_RESTS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_ISLAND_RESTS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/plan/stacked_islands.h"

namespace traverse::gcode {

// When an order of a layer begins and ends each of its islands, in seconds from its first path.
struct IslandTimes {
  std::vector<double> begun;  // [node]
  std::vector<double> left;   // [node]
  double seconds = 0;         // of all its paths and the travel between them
};

// One layer of a print in some order, with the travel to it.
struct TimedLayer {
  const IslandTimes* islands = nullptr;
  double travel_seconds = 0;  // to it
};

// The shortest rest of an island, where it rests at all.
struct LeastRest {
  double seconds = 0;
  size_t layer = 0;  // that ends it, from 0
};

class IslandRests {
 public:
  // Islands rest for `least_seconds` at least, or as long as in the file; 0: no island must.
  IslandRests(std::vector<LayerIslands> stack, double least_seconds);

  double least_seconds() const { return least_seconds_; }

  // [path] of layer `layer` its island; and first, if some do, what counts as one with that.
  std::vector<std::vector<uint32_t>> IslandsOf(size_t layer) const;

  // Of layer `layer` in `order`; `moments[2 * i]` and `moments[2 * i + 1]` are when its path i
  // begins and ends.
  IslandTimes TimesOf(size_t layer, const LayerOrder& order, uint32_t first_block,
                      const std::vector<double>& moments) const;

  // The file's own print. REQUIRES: all later calls come after this one.
  void SetGiven(const std::vector<TimedLayer>& given);

  // True if an island of layer `layer` that lies on the layer before rests too short, where `next`
  // follows `before`.
  bool TooShort(size_t layer, const IslandTimes& before, const TimedLayer& next) const;

  // The layers of `print` where an island rests too short, and the earlier ones that these lie on;
  // those pairs alone that TooShort does not look at.
  struct Pair {
    size_t below = 0;
    size_t layer = 0;
  };
  std::vector<Pair> TooShortBeyond(const std::vector<TimedLayer>& print) const;

  // The shortest rest in `print` of islands that rest in the file; unset if none does.
  std::optional<LeastRest> LeastOf(const std::vector<TimedLayer>& print) const;

 private:
  using Support = LayerIslands::Support;

  double NeedOf(size_t layer, size_t support) const;

  std::vector<LayerIslands> stack_;
  const double least_seconds_;
  std::vector<std::vector<double>> given_;  // [layer][support] rest in the file; 0: none
};

// Of `file` as it is.
std::optional<LeastRest> LeastRestOf(const GcodeFile& file, int threads);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_ISLAND_RESTS_H_
