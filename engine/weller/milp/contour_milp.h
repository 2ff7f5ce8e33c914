// Step 2 of the thesis's framework as a mixed integer programme: the preliminary sequence of the
// contours.
//
//   position   0      1      2      3            rank[i,k]     contour i has position k
//              Or --- c1 --- c3 --- c2           pt_rank[p,k]  point p of a contour is active at k
//   link          0      1      2                link[p,q,k]   p and q follow each other at k, k +
//   1
//
//   min sum dist[p,q] link[p,q,k]                                                        (4.1)
//   one contour a position, one position a contour                                       (4.2, 4.3)
//   sum over p of i of pt_rank[p,k] = rank[i,k]                                          (4.4)
//   link[p,q,k] >= pt_rank[p,k] + pt_rank[q,k] + pt_rank[p,k+1] + pt_rank[q,k+1] - 1     (4.5)
//   links of p at k <= pt_rank[p,k] + pt_rank[p,k+1]                                     (4.6)
//
// Source: thesis 4.1.1 (p. 73-75); SPEC 3.5. The origin is a contour of one point at position 0.
// Contours that are not linked may not follow each other: their part of 4.5, without links on the
// left, is summed up over their points. Columns: about points^2 x contours / 2.

#ifndef TRAVERSE_ENGINE_WELLER_MILP_CONTOUR_MILP_H_
#define TRAVERSE_ENGINE_WELLER_MILP_CONTOUR_MILP_H_

#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/base/symmetric_relation.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/proof/programs/mixed_program.h"

namespace traverse {

struct MilpOptions {
  double gap = 0.15;  // relative, at which a model counts as solved: thesis table 4.1

  // Adds one row per position, which no route breaks: sum over p, q of link[p,q,k] = 1. The thesis
  // has it in step 3 (4.12) and step 4 (4.21), but not in step 2.
  bool strengthened = false;

  // Beyond this many columns and rows no model is built, and so there is no route.
  double most_columns_and_rows = 200000;
};

struct MilpRoute {
  Route route;                  // empty if none was found
  std::optional<double> start;  // value of the route from which it started; unset: it started cold
  double value = 0;             // of the route in the model
  std::optional<double> bound;  // of the model's routes, by Cbc's word
  bool complete = false;        // the gap was reached, or there is no route
  int columns = 0;
  int rows = 0;
  int nodes = 0;
  double seconds = 0;  // for the programme
  std::vector<MixedProgram::Incumbent> incumbents;
};

// Solves `program` from `known`, the values of the route from which it starts, or cold if they are
// empty. Describes the result, except its route.
MilpRoute SolveAndDescribe(const MixedProgram& program, const std::vector<double>& known,
                           const MilpOptions& options, Budget& budget, std::vector<double>& values);

// The best sequence of `problem`, any_order over contours, with moves only between neighbors: node
// i of `linked` is path i, the last node the start. Moves of `known`, a route or empty, count as
// linked: the result is no worse.
MilpRoute SolveContourMilp(const LayerProblem& problem, const SymmetricRelation& linked,
                           const Route& known, const MilpOptions& options, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_MILP_CONTOUR_MILP_H_
