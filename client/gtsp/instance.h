// An instance of the generalised travelling salesman problem: points in sets, of which a closed
// tour visits one point each.

#ifndef TRAVERSE_CLIENT_GTSP_INSTANCE_H_
#define TRAVERSE_CLIENT_GTSP_INSTANCE_H_

#include <cstdint>
#include <vector>

namespace traverse::gtsp {

// As the file has it. Its numbers of points and of sets count from 1, those here from 0.
struct Instance {
  struct Point {
    double x = 0;
    double y = 0;
  };

  std::vector<Point> points;

  // `sets[s]`: the points of set s, in the order of the file; each point is in one set, no set is
  // empty.
  std::vector<std::vector<uint32_t>> sets;

  // The smallest set, of several the first: a tour begins and ends there, once from each of its
  // points.
  uint32_t first_set = 0;
};

}  // namespace traverse::gtsp

#endif  // TRAVERSE_CLIENT_GTSP_INSTANCE_H_
