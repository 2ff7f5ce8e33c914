// Small instances with names, shared by tests.

#ifndef TRAVERSE_TESTS_SUPPORT_PROBLEMS_INSTANCES_H_
#define TRAVERSE_TESTS_SUPPORT_PROBLEMS_INSTANCES_H_

#include <vector>

#include "engine/model/plan.h"

namespace traverse::testing {

// any_order over the paths given; path p is node p + 1.
Plan AnyOrderPlan(std::vector<Path> paths);

// any_order over `paths` contours of one point each, at (0, 0), (1, 0), (2, 0), ...
Plan FlatPlan(int paths);

// any_order over `n` contours of five points each, near each other within 300 x 300 mm: what branch
// and cut takes on.
Plan ClusterPlan(int n);

// columns x rows islands: each a square contour of side 1 mm with its lower left corner at
// (4 column, 4 row), and one raster across its middle. Row by row.
std::vector<IslandPaths> SquareGrid(int columns, int rows);

// One island of 20 x 20 mm: its outline, four square holes, and three rasters.
std::vector<IslandPaths> PlateWithHoles();

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_PROBLEMS_INSTANCES_H_
