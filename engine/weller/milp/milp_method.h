// Steps 2 and 4 of the thesis's framework by mixed integer programmes.

#ifndef TRAVERSE_ENGINE_WELLER_MILP_MILP_METHOD_H_
#define TRAVERSE_ENGINE_WELLER_MILP_MILP_METHOD_H_

#include <functional>
#include <vector>

#include "engine/weller/framework_search.h"
#include "engine/weller/milp/contour_milp.h"

namespace traverse {

// Each programme begins with the route that `first` finds for it, whose links count as neighbors:
// so there always is a sequence. Without `first` it begins cold, as the thesis's did; where it ends
// without a sequence the order given stands in. Where the budget has a deadline, step 2 may use
// half of the time.
class MilpMethod : public SequenceMethod {
 public:
  using FirstRoute = std::function<Route(const LayerProblem&, Budget&)>;

  // `time_limit_seconds` of each programme.
  MilpMethod(const MilpOptions& options, double time_limit_seconds, FirstRoute first);

  std::vector<TabuElite> ArrangeContours(const LayerProblem& problem, const LinkRules& rules,
                                         const Route& start, Budget& budget) override;
  std::vector<TabuElite> ArrangeRasters(const LayerProblem& problem, const LinkRules& rules,
                                        const Route& start, Budget& budget) override;

  // Of the programmes solved: those of step 2, and those of step 4. One each in sequential
  // deposition, in the order solved; of a layer's islands in interleaved deposition.
  const std::vector<MilpRoute>& contours() const { return contours_; }
  const std::vector<MilpRoute>& rasters() const { return rasters_; }

  // Whether a limit of time ended one of them.
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
