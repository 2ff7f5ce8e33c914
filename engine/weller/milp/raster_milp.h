// Step 4 of the thesis's framework as a mixed integer programme: the route of the rasters.
//
//   move     1          2          3         KR = rasters + 1
//     First ----- p ==== p' ------ q ==== q' ----- Last        ==== a raster (CRS)
//
//   raster[p,q,kr]    move kr goes between p and q, ends of different rasters
//   rank_rst[p,kr]    p is an end of move kr
//   linkbn[p,p',kr]   the raster p-p' lies between moves kr and kr + 1
//
//   min sum dist[p,q] raster[p,q,kr]                                             (4.14)
//   each end of a raster is in one move                                          (4.15)
//   moves kr of p >= rank_rst[p,kr]                                              (4.16)
//   one move at each kr, the first from First, the last to Last                  (4.17-4.21)
//   sum over p of rank_rst[p,kr] <= 2                                            (4.22)
//   sum over kr of rank_rst[p,kr] >= 1, First at 1, Last at KR                   (4.23-4.25)
//   linkbn[p,p',kr] >= rank_rst of p and p' at kr and kr + 1, less 1             (4.26)
//   linkbn[p,p',kr] + linkbn[p,p',kr-1] >= rank_rst[p,kr], likewise for p'       (4.27)
//   sum over kr of linkbn[p,p',kr] <= 1                                          (4.28)
//
// Source: thesis 4.1.3 (p. 77-81); SPEC 3.5. Moves are between rasters of one island or of
// neighboring ones, and as many as an island has rasters, less one, are within it: its rasters are
// then done together (p. 67). A raster that may be done one way only is entered at its first end at
// kr = that of its linkbn. Columns: about 2 ends^2 x rasters at most.

#ifndef TRAVERSE_ENGINE_WELLER_MILP_RASTER_MILP_H_
#define TRAVERSE_ENGINE_WELLER_MILP_RASTER_MILP_H_

#include <vector>

#include "engine/base/budget.h"
#include "engine/base/symmetric_relation.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/weller/milp/contour_milp.h"

namespace traverse {

// Which rasters may follow each other.
struct RasterGroups {
  std::vector<int> group_of;                  // [path] the island
  int start_group = -1;                       // of First; -1: every island is its neighbor
  const SymmetricRelation* linked = nullptr;  // of groups; null: all are neighbors
};

// The best route of `problem`, which has only open paths, that keeps groups together and moves only
// between neighbors. Ignores the plan's tree. Moves of `known`, such a route or empty, count as
// between neighbors: the result is no worse. Last costs the move to the problem's finish, if it has
// one.
MilpRoute SolveRasterMilp(const LayerProblem& problem, const RasterGroups& groups,
                          const Route& known, const MilpOptions& options, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_MILP_RASTER_MILP_H_
