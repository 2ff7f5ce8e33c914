#include "engine/cost/route_entries.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "engine/cost/entry_choice.h"

namespace traverse {

void ChooseEntries(const LayerView& layer, Route& route, Budget& budget) {
  constexpr size_t kWindow = kEntryWindow;
  EntryChoice choice(layer.table, layer.cost, &budget);
  std::vector<int> paths;
  std::vector<int> entries;
  for (size_t begin = 0; begin < route.size(); begin += kWindow / 2) {
    if (budget.ExhaustedNow()) return;
    const size_t end = std::min(route.size(), begin + kWindow);
    const auto point = [&](const Visit& visit, bool exit) {
      const int entry = layer.table.EntryOf(visit);
      return exit ? layer.table.exit(entry) : layer.table.enter(entry);
    };
    const Point from = begin > 0 ? point(route[begin - 1], true) : layer.problem.start;
    const std::optional<Point> to =
        end < route.size() ? point(route[end], false) : layer.problem.finish;
    paths.clear();
    for (size_t k = begin; k < end; ++k) paths.push_back(route[k].path);
    entries.resize(paths.size());
    choice.Choose(from, paths, to, absl::MakeSpan(entries));
    if (budget.was_exhausted()) return;  // perhaps in the middle of it
    for (size_t k = begin; k < end; ++k) route[k] = layer.table.VisitOf(entries[k - begin]);
    if (end == route.size()) return;
  }
}

}  // namespace traverse
