#include "engine/proof/tsp/tsp_nodes.h"

#include <cassert>

namespace traverse {

TspNodes::TspNodes(const PathTsp& problem) : mate_(problem.mate), first_(1, 0), has_choice_(1, 0) {
  for (int p = 0; p < problem.ports; ++p) {
    const int item = problem.item[Index(p)] + 1;
    if (item == static_cast<int>(first_.size())) {
      first_.push_back(p);
      has_choice_.push_back(0);
    } else {
      assert(item == static_cast<int>(first_.size()) - 1);
      if (problem.mate[Index(p)] == p) has_choice_.back() = 1;
    }
    item_.push_back(item);
  }
  first_.push_back(problem.ports);
  item_.insert(item_.end(), 2, 0);
  mate_.push_back(problem.ports + 1);
  mate_.push_back(problem.ports);
}

}  // namespace traverse
