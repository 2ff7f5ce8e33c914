#include "engine/schedule/route_history.h"

#include <utility>

#include "engine/base/tolerances.h"

namespace traverse {

RouteHistory::Make& RouteHistory::MakeOf(uint64_t make) {
  if (makes_.size() >= kMostMakes && makes_.count(make) == 0) makes_.clear();
  return makes_[make];
}

// Returns the entry kLag before, or the first one that is left; null if there is none.
RouteHistory::Entry RouteHistory::Push(std::deque<Entry>& entries, const Entry& mine) {
  Entry model = entries.empty() ? nullptr : entries.front();
  entries.push_back(mine);
  if (entries.size() > kLag) entries.pop_front();
  return model;
}

RouteHistory::Entry RouteHistory::Enter(uint64_t make, uint64_t kind, const Entry& mine) {
  Make& same_make = MakeOf(make);
  mine->kind = kind;
  Entry of_make = Push(same_make.entries, mine);
  if (same_make.kinds.size() >= kMostKinds && same_make.kinds.count(kind) == 0) {
    same_make.kinds.clear();
  }
  std::deque<Entry>& same_kind = same_make.kinds[kind];
  if (!same_kind.empty()) {
    mine->previous = same_kind.back();
    mine->previous->next = mine;
  }
  Entry of_kind = Push(same_kind, mine);
  return of_kind ? of_kind : of_make;
}

void RouteHistory::Learn(uint64_t make, uint64_t kind, KnownRoutePtr known) {
  const auto found = makes_.find(make);
  if (found == makes_.end() || found->second.kinds.count(kind) > 0) return;
  auto entry = std::make_shared<RouteToCome>();
  entry->kind = kind;
  entry->best = std::move(known);
  entry->ready = true;
  found->second.kinds[kind].push_back(std::move(entry));
}

std::vector<uint64_t> RouteHistory::Complete(Entry entry, KnownRoutePtr own, bool in_vain) {
  entry->own = std::move(own);
  entry->in_vain = in_vain;
  std::vector<uint64_t> released;
  while (entry && entry->own && (!entry->previous || entry->previous->ready)) {
    const Entry previous = std::exchange(entry->previous, nullptr);
    if (previous) previous->next.reset();
    if (previous && previous->best->cost <= entry->own->cost * (1 + kSameCost)) {
      entry->best = previous->best;
      entry->idle = previous->idle + (entry->in_vain ? 1 : 0);
    } else {
      entry->best = entry->own;
    }
    entry->ready = true;
    released.insert(released.end(), entry->waiting.begin(), entry->waiting.end());
    entry->waiting.clear();
    entry = entry->next;
  }
  return released;
}

}  // namespace traverse
