#include "engine/cost/entry_table.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "engine/base/rest.h"

namespace traverse {

EntryTable::EntryTable(const Plan& plan, Budget* budget) {
  size_t total = 0;
  for (const Path& path : plan.paths) {
    total += path.allowed.empty() ? path.points.size() : path.allowed.size();
  }
  first_.reserve(plan.paths.size() + 1);
  enter_.reserve(total);
  exit_.reserve(total);
  path_of_.reserve(total);
  visit_entry_.reserve(total);
  Rest rest(budget);
  for (size_t p = 0; p < plan.paths.size(); ++p) {
    const Path& path = plan.paths[p];
    first_.push_back(static_cast<int>(enter_.size()));
    const auto add = [&](int entry) {
      enter_.push_back(EnterPoint(path, entry));
      exit_.push_back(ExitPoint(path, entry));
      path_of_.push_back(static_cast<int>(p));
      visit_entry_.push_back(entry);
      rest(2);
    };
    if (path.kind == Path::Kind::kOpen) {
      add(0);
      if (!path.one_way) add(1);
    } else if (path.allowed.empty()) {
      for (int v = 0; v < static_cast<int>(path.points.size()); ++v) add(v);
    } else {
      for (const int v : path.allowed) add(v);
    }
  }
  first_.push_back(static_cast<int>(enter_.size()));
}

int EntryTable::EntryOf(const Visit& visit) const {
  const int begin = first(visit.path);
  const int end = first(visit.path + 1);
  // Usually all vertices are allowed; then the entry is at its own index.
  if (visit.entry < end - begin &&
      visit_entry_[static_cast<size_t>(begin + visit.entry)] == visit.entry) {
    return begin + visit.entry;
  }
  const auto from = visit_entry_.begin() + begin;
  const auto found = std::find(from, visit_entry_.begin() + end, visit.entry);
  assert(found != visit_entry_.begin() + end);
  return begin + static_cast<int>(found - from);
}

}  // namespace traverse
