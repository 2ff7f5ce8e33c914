// An instance of the generalised travelling salesman problem: points in sets, and a closed tour
// that visits one point of each.

#ifndef TRAVERSE_CLIENT_GTSP_INSTANCE_H_
#define TRAVERSE_CLIENT_GTSP_INSTANCE_H_

#include <cstdint>
#include <vector>

namespace traverse::gtsp {

// As in the file. The file numbers points and sets from 1, this class from 0.
struct Instance {
  struct Point {
    double x = 0;
    double y = 0;
  };

  std::vector<Point> points;

  // `sets[s]`: the points of set s, in the order of the file. Each point is in one set; no set is
  // empty.
  std::vector<std::vector<uint32_t>> sets;

  // The smallest set, the first of several: tours begin and end there, one tour for each of its
  // points.
  uint32_t first_set = 0;
};

}  // namespace traverse::gtsp

#endif  // TRAVERSE_CLIENT_GTSP_INSTANCE_H_
