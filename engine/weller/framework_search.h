// The thesis's framework: a layer in sequential deposition, in four steps.
//
// Source: thesis 3.2 (p. 58-67), 4.1 and 4.2 (p. 72-84); SPEC 3.5.

#ifndef TRAVERSE_ENGINE_WELLER_FRAMEWORK_SEARCH_H_
#define TRAVERSE_ENGINE_WELLER_FRAMEWORK_SEARCH_H_

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/weller/steps/contour_route.h"
#include "engine/weller/steps/island_layout.h"
#include "engine/weller/steps/neighborhood.h"
#include "engine/weller/steps/point_reduction.h"
#include "engine/weller/tabu/tabu_search.h"

namespace traverse {

// "sp", "nrp" or "bbcp", the names used in options.
Representation RepresentationNamed(const std::string& name);

struct FrameworkOptions {
  Representation representation = Representation::kBoxCenter;
  double spacing_mm = 2.5;  // Dp
  NeighborhoodOptions neighborhood;
  double neighbor_penalty_mm = 100;
  TabuOptions tabu;
  int relinked = 5;  // sequences of a relinked path that step 3 considers
  VisibleIn visible_in = VisibleIn::kEitherPolygon;

  // Paths of RelinkPoints with which step 3 chooses the contours' points, as the thesis's tabu
  // search does. 0: the optimal choice, which the thesis's programme (4.8-4.13) looks for.
  int point_relinkings = 0;

  bool trace = false;  // fills FrameworkResult::trace
};

// The results of the steps, for drawing, in sequential deposition. Indices into Plan::paths; the
// number of paths stands for the origin.
struct FrameworkTrace {
  std::vector<std::pair<int, int>> neighbors;
  std::vector<int> sequence;                 // the preliminary one
  std::vector<std::pair<int, int>> visible;  // path, vertex: along the route of step 3
};

// How many contour points each reduction leaves: thesis tables 5.1 and 5.4.
struct ReductionCounts {
  int entries = 0;          // of all contours
  int island_analysis = 0;  // of the contours that step 2 arranges
  int spaced = 0;           // SP of all contours
  int near_raster = 0;      // NRP of the contours that step 2 arranges
  int box_center = 0;       // BBCP of these contours
  int visible = 0;          // in visibility polygons of the route
};

struct FrameworkResult {
  Route route;  // every path of the layer, contours first
  ReductionCounts points;
  int penalized_contour_links = 0;  // of the preliminary sequence, against the neighborhood
  int penalized_raster_links = 0;   // of the raster route

  // Only for tabu search.
  int diversifications = 0;  // in the step that did fewer of them
  int64_t evaluations = 0;   // of swaps, in both steps

  FrameworkTrace trace;
  double step_seconds[3] = {};  // of steps 2, 3 and 4: thesis tables 5.6 to 5.8
};

// How steps 2 and 4 find a sequence: tabu search, or mixed integer programmes.
class SequenceMethod {
 public:
  virtual ~SequenceMethod() = default;

  // The best sequences found, best first, at least one: routes of `problem`, whose moves should
  // keep to `rules`. Contours: any_order over contours of their representing points. Rasters:
  // any_order over islands of any_order over their rasters. The search starts from `start`.
  virtual std::vector<TabuElite> ArrangeContours(const LayerProblem& problem,
                                                 const LinkRules& rules, const Route& start,
                                                 Budget& budget) = 0;
  virtual std::vector<TabuElite> ArrangeRasters(const LayerProblem& problem, const LinkRules& rules,
                                                const Route& start, Budget& budget) = 0;
};

// Steps 1 to 4 on `layer`, which is AsClassicalLayer of the problem's plan. The searches for the
// contours and for the rasters start from the order in `start`. Always returns a valid route;
// deterministic by problem.seed unless the budget ends it. Ignores `options.tabu`.
FrameworkResult SearchFramework(const LayerProblem& problem, const ClassicalLayer& layer,
                                const Route& start, const FrameworkOptions& options,
                                SequenceMethod& method, Budget& budget);

// The same with tabu search.
FrameworkResult SearchFramework(const LayerProblem& problem, const ClassicalLayer& layer,
                                const Route& start, const FrameworkOptions& options,
                                Budget& budget);

// For plans of any other form: one tabu search over all any_order nodes, then the best entries for
// the order found. Contours are represented as `representation` says, except for the near raster
// points of contours without known islands (see NearRasterPoints). Steps that need islands are left
// out (no suppressed contours, no neighborhoods). Valid if `start` is.
Route SearchAnyPlan(const LayerProblem& problem, const Route& start,
                    const FrameworkOptions& options, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_FRAMEWORK_SEARCH_H_
