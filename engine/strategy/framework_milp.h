// Steps 2 and 4 of the thesis's framework by mixed integer programmes.

#ifndef TRAVERSE_ENGINE_STRATEGY_FRAMEWORK_MILP_H_
#define TRAVERSE_ENGINE_STRATEGY_FRAMEWORK_MILP_H_

#include <memory>
#include <vector>

#include "engine/exact/contour_milp.h"
#include "engine/strategy/framework_search.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// Each programme begins with the route that ni2opt finds for it, whose links count as neighbors: so
// there always is a sequence. Where the budget has a deadline, step 2 may use half of the time.
class MilpMethod : public SequenceMethod {
 public:
  // `time_limit_seconds` of each programme.
  MilpMethod(const MilpOptions& options, double time_limit_seconds);

  std::vector<TabuElite> ArrangeContours(const LayerProblem& problem, const LinkRules& rules,
                                         const Route& start, Budget& budget) override;
  std::vector<TabuElite> ArrangeRasters(const LayerProblem& problem, const LinkRules& rules,
                                        const Route& start, Budget& budget) override;

  // Of the programmes solved; `complete` is false of one that was not reached.
  const MilpRoute& contours() const { return contours_; }
  const MilpRoute& rasters() const { return rasters_; }

  // Whether a limit of time ended one of them.
  bool timed_out() const { return timed_out_; }

 private:
  Budget StepBudget(const Budget& budget, double share) const;
  std::vector<TabuElite> Finish(const LayerProblem& problem, const MilpRoute& found,
                                const Route& first, const Budget& step);

  const MilpOptions options_;
  const double time_limit_seconds_;
  const std::unique_ptr<Strategy> heuristic_;
  MilpRoute contours_;
  MilpRoute rasters_;
  bool timed_out_ = false;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_FRAMEWORK_MILP_H_
