#include "engine/search/polisher.h"

#include "engine/cost/route_entries.h"
#include "engine/search/iterated_search.h"

namespace traverse {

Polisher::Polisher(const LayerView& layer, Budget& budget)
    : layer_(layer),
      tree_(layer.tree, &budget),
      entries_(layer.problem, &budget),
      groups_(entries_, &budget),
      neighbors_(FindNeighbors(tree_, groups_, ThreeOptOptions().first_breadth, budget)),
      state_(layer.problem, tree_, entries_) {}

Route Polisher::Descend(Route route, Budget& budget) {
  Rng unused(0);
  return Iterate(std::move(route), 0, unused, budget);
}

Route Polisher::Iterate(Route route, int64_t patience, Rng& rng, Budget& budget) {
  ChooseEntries(layer_, route, budget);
  if (!tree_.has_choice()) return route;
  state_.Load(route, &budget);
  IteratedSearchOptions options;
  options.patience = patience;
  // First without detours, which find less where kicks are as few as here; then with them, from the
  // best route, out of what no single kick leads out of.
  const double detours = options.temperature;
  options.temperature = 0;
  IteratedSearch search(state_, neighbors_, options);
  search.Descend(budget);
  search.Run(rng, budget);
  options.temperature = detours;
  IteratedSearch(state_, neighbors_, options).Run(rng, budget);
  Route polished = state_.Unload();
  ChooseEntries(layer_, polished, budget);
  return polished;
}

}  // namespace traverse
