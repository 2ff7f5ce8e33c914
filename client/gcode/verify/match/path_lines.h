// Which lines of the two files belong together: those with which the same path begins.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PATH_LINES_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PATH_LINES_H_

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "client/gcode/verify/match/layer_pair.h"

namespace traverse::gcode {

class PathLines {
 public:
  // Layers in the order of the files.
  void Add(const LayerPair& layer) {
    for (const Visit& visit : layer.visits()) {
      lines_.push_back({layer.was().LineOf(visit.path), layer.LineOf(visit)});
    }
  }

  void Append(const PathLines& other) {
    lines_.insert(lines_.end(), other.lines_.begin(), other.lines_.end());
  }

  // Where the path begins in the original that is the next one behind line `optimised` of the other
  // file, or else the last one of all. 0 if there are no paths.
  uint32_t OriginalOf(uint32_t optimised) const {
    if (lines_.empty()) return 0;
    const auto next = std::ranges::lower_bound(lines_, optimised, {}, &Pair::optimised);
    return next == lines_.end() ? lines_.back().original : next->original;
  }

  // The other way round. Takes as long as there are paths.
  uint32_t OptimisedOf(uint32_t original) const {
    if (lines_.empty()) return 0;
    // The first of those behind it, or the last of those before.
    const auto place = [original](const Pair& pair) {
      const bool before = pair.original < original;
      return std::pair(before, before ? ~pair.original : pair.original);
    };
    return std::ranges::min_element(lines_, {}, place)->optimised;
  }

 private:
  struct Pair {
    uint32_t original = 0;
    uint32_t optimised = 0;
  };

  std::vector<Pair> lines_;  // by `optimised`
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PATH_LINES_H_
