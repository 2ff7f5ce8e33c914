// Steps 2 and 4 of the thesis's framework by tabu search.

#ifndef TRAVERSE_ENGINE_WELLER_TABU_TABU_METHOD_H_
#define TRAVERSE_ENGINE_WELLER_TABU_TABU_METHOD_H_

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/weller/framework_search.h"

namespace traverse {

class TabuMethod : public SequenceMethod {
 public:
  // `options` must outlive the method.
  explicit TabuMethod(const TabuOptions& options) : options_(options) {}

  std::vector<TabuElite> ArrangeContours(const LayerProblem& problem, const LinkRules& rules,
                                         const Route& start, Budget& budget) override {
    return Search(problem, rules, start, budget);
  }
  std::vector<TabuElite> ArrangeRasters(const LayerProblem& problem, const LinkRules& rules,
                                        const Route& start, Budget& budget) override {
    return Search(problem, rules, start, budget);
  }

  // Over all searches so far: the sum of their evaluations, the diversifications of the shortest.
  int64_t evaluations() const { return evaluations_; }
  int diversifications() const { return diversifications_.value_or(0); }

 private:
  std::vector<TabuElite> Search(const LayerProblem& problem, const LinkRules& rules,
                                const Route& start, Budget& budget) {
    TabuResult found = TabuSearch(problem, rules, start, options_, budget);
    evaluations_ += found.evaluations;
    diversifications_ =
        std::min(diversifications_.value_or(found.diversifications), found.diversifications);
    return std::move(found.elite);
  }

  const TabuOptions& options_;
  int64_t evaluations_ = 0;
  std::optional<int> diversifications_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_TABU_METHOD_H_
