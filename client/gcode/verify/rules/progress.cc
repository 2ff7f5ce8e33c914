// The sequence of M73 lines is unchanged.

#include <algorithm>

#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {

void CompareProgress(const std::vector<Progress>& was, const std::vector<Progress>& is,
                     std::vector<Finding>& breaks) {
  const size_t common = std::min(was.size(), is.size());
  size_t i = 0;
  while (i < common && was[i].digest == is[i].digest) ++i;
  if (i == was.size() && i == is.size()) return;
  breaks.push_back({VerifyRule::kProgress, i < was.size() ? was[i].line : 0,
                    i < is.size() ? is[i].line : 0, -1, "this M73 is out of sequence"});
}

}  // namespace traverse::gcode
