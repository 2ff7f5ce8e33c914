#include "engine/souza/two_opt.h"

namespace traverse {

double TwoOpt(BlockLine& line, Budget& budget) {
  double change = 0;
  // Ends where a whole round since the last gain found none.
  int since_gain = 0;
  for (int first = 0; since_gain < line.size(); first = first + 1 < line.size() ? first + 1 : 0) {
    if (budget.Exhausted()) break;
    const BlockLine::Reversal best = line.BestReversalFrom(first, -line.tolerance());
    ++since_gain;
    if (best.last < 0) continue;
    line.Reverse(first, best.last);
    change += best.delta;
    since_gain = 0;
  }
  return change;
}

}  // namespace traverse
