#include "engine/schedule/route_history.h"

#include <utility>

#include "engine/base/tolerances.h"

namespace traverse {

// One after another: a job that is given up may leave a million in a row, and the stack holds no
// call for each.
PendingRoute::~PendingRoute() {
  std::shared_ptr<PendingRoute> entry = std::move(previous);
  while (entry != nullptr && entry.use_count() == 1) {
    entry = std::exchange(entry->previous, nullptr);
  }
}

RouteHistory::Shape& RouteHistory::OfShape(uint64_t shape) {
  if (shapes_.size() >= kMostShapes && shapes_.count(shape) == 0) shapes_.clear();
  return shapes_[shape];
}

// Returns the entry kLag before, or the first that remains; null if there is none.
RouteHistory::Entry RouteHistory::Push(std::deque<Entry>& entries, const Entry& mine) {
  Entry model = entries.empty() ? nullptr : entries.front();
  entries.push_back(mine);
  if (entries.size() > kLag) entries.pop_front();
  return model;
}

RouteHistory::Entry RouteHistory::Enter(uint64_t shape, uint64_t key, const Entry& mine) {
  Shape& same_shape = OfShape(shape);
  ++same_shape.seen;
  mine->key = key;
  Entry of_shape = Push(same_shape.entries, mine);
  if (same_shape.keys.size() >= kMostKeys && same_shape.keys.count(key) == 0) {
    same_shape.keys.clear();
  }
  std::deque<Entry>& same_key = same_shape.keys[key];
  if (!same_key.empty()) {
    mine->previous = same_key.back();
    mine->previous->next = mine;
  }
  Entry of_key = Push(same_key, mine);
  return of_key ? of_key : of_shape;
}

int RouteHistory::Seen(uint64_t shape) const {
  const auto found = shapes_.find(shape);
  return found == shapes_.end() ? 0 : found->second.seen;
}

void RouteHistory::Learn(uint64_t shape, uint64_t key, KnownRoutePtr known) {
  const auto found = shapes_.find(shape);
  if (found == shapes_.end() || found->second.keys.count(key) > 0) return;
  auto entry = std::make_shared<PendingRoute>();
  entry->key = key;
  entry->best = std::move(known);
  entry->ready = true;
  found->second.keys[key].push_back(std::move(entry));
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
    entry = entry->next.lock();
  }
  return released;
}

}  // namespace traverse
