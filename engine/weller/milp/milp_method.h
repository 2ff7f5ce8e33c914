// Steps 2 and 4 of the thesis's framework by mixed integer programmes.

#ifndef TRAVERSE_ENGINE_WELLER_MILP_MILP_METHOD_H_
#define TRAVERSE_ENGINE_WELLER_MILP_MILP_METHOD_H_

#include <functional>
#include <vector>

#include "engine/weller/framework_search.h"
#include "engine/weller/milp/contour_milp.h"

namespace traverse {

// Each programme starts from the route that `first` finds for it, whose moves count as neighbors,
// so that there always is a sequence. Without `first` it starts cold, as in the thesis; if it ends
// without a sequence, the given order is used. If the budget has a deadline, step 2 may use half of
// the time.
class MilpMethod : public SequenceMethod {
 public:
  using FirstRoute = std::function<Route(const LayerProblem&, Budget&)>;

  // `time_limit_seconds`: for each programme.
  MilpMethod(const MilpOptions& options, double time_limit_seconds, FirstRoute first);

  std::vector<TabuElite> ArrangeContours(const LayerProblem& problem, const LinkRules& rules,
                                         const Route& start, Budget& budget) override;
  std::vector<TabuElite> ArrangeRasters(const LayerProblem& problem, const LinkRules& rules,
                                        const Route& start, Budget& budget) override;

  // The programmes solved: those of step 2, and those of step 4, in the order solved. One each in
  // sequential deposition; one per island in interleaved deposition.
  const std::vector<MilpRoute>& contours() const { return contours_; }
  const std::vector<MilpRoute>& rasters() const { return rasters_; }

  // Whether a time limit ended any of them.
  bool timed_out() const { return timed_out_; }

 private:
  Budget StepBudget(const Budget& budget, double share) const;
  std::vector<TabuElite> Finish(const LayerProblem& problem, MilpRoute found, const Route& start,
                                const Budget& step, std::vector<MilpRoute>& programmes);

  const MilpOptions options_;
  const double time_limit_seconds_;
  const FirstRoute first_;
  std::vector<MilpRoute> contours_;
  std::vector<MilpRoute> rasters_;
  bool timed_out_ = false;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_MILP_MILP_METHOD_H_
