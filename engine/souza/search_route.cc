#include "engine/souza/search_route.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

#include "engine/base/rest.h"
#include "engine/base/resting_sort.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"

namespace traverse {

SearchRoute::SearchRoute(const LayerView& layer, const Route& route, Budget* budget)
    : layer_(&layer),
      begin_(static_cast<size_t>(layer.tree.node_count())),
      order_(static_cast<size_t>(layer.tree.first_child(layer.tree.node_count()))),
      pending_node_(begin_.size(), 1),
      pending_visit_(route.size(), 1) {
  assert(ValidateRoute(layer.plan(), route).ok());
  entries_.reserve(route.size());
  Rest rest(budget);
  for (const Visit& visit : route) {
    rest(16);
    begin_[static_cast<size_t>(layer.tree.leaf(visit.path))] = size();
    entries_.push_back(layer.table.EntryOf(visit));
  }
  // From the leaves up: children have greater indices than their parents.
  for (int node = layer.tree.node_count(); node-- > 0;) {
    rest();
    if (!layer.tree.children(node).empty()) SortChildren(node, rest);
  }
}

void SearchRoute::SortChildren(int node, Rest& rest) {
  const absl::Span<const int> children = layer_->tree.children(node);
  const auto first = order_.begin() + layer_->tree.first_child(node);
  const auto begin_of = [&](int slot) { return begin(children[static_cast<size_t>(slot)]); };
  std::vector<int> slots(children.size());
  std::iota(slots.begin(), slots.end(), 0);
  RestingSort(slots, rest, [&](int a, int b) { return begin_of(a) < begin_of(b); });
  std::copy(slots.begin(), slots.end(), first);
  begin_[static_cast<size_t>(node)] = begin_of(*first);
}

void SearchRoute::SetEntry(int position, int entry) {
  entries_[static_cast<size_t>(position)] = entry;
  for (int p = position - 1; p <= position + 1; ++p) Touch(p);
}

#ifndef NDEBUG
bool SearchRoute::MayArrange(int node, absl::Span<const int> slots,
                             absl::Span<const char> reversed) const {
  const absl::Span<const int> children = layer_->tree.children(node);
  if (slots.size() != children.size() || reversed.size() != children.size()) return false;
  std::vector<int> position(slots.size(), -1);
  for (size_t k = 0; k < slots.size(); ++k) {
    const size_t slot = static_cast<size_t>(slots[k]);
    if (reversed[k] != 0 && !layer_->tree.reversible(children[slot])) return false;
    position[slot] = static_cast<int>(k);
  }
  const Precedence& precedence = layer_->tree.precedence(node);
  if (precedence.empty()) return true;
  std::vector<int> last;
  precedence.LastBefore(position, last);
  return std::equal(position.begin(), position.end(), last.begin(), std::greater<>());
}
#endif

void SearchRoute::Arrange(int node, absl::Span<const int> slots, absl::Span<const char> reversed) {
  const absl::Span<const int> children = layer_->tree.children(node);
  assert(MayArrange(node, slots, reversed));
  const int first = begin(node);
  const int end = first + layer_->tree.path_count(node);
  scratch_.assign(entries_.begin() + first, entries_.begin() + end);
  std::copy(slots.begin(), slots.end(), order_.begin() + layer_->tree.first_child(node));
  int at = first;
  for (size_t k = 0; k < slots.size(); ++k) {
    const int child = children[static_cast<size_t>(slots[k])];
    const int count = layer_->tree.path_count(child);
    const auto source = scratch_.begin() + (begin(child) - first);
    const auto target = entries_.begin() + at;
    if (reversed[k]) {
      std::reverse_copy(source, source + count, target);
      std::transform(target, target + count, target, [&](int e) { return Backwards(e); });
    } else {
      std::copy(source, source + count, target);
    }
    if (reversed[k] || begin(child) != at) Place(child, at, reversed[k] != 0);
    at += count;
  }
  Touch(first - 1);
  Touch(first);
  Touch(end - 1);
  Touch(end);
}

int SearchRoute::Backwards(int entry) const {
  const int path = layer_->table.path_of(entry);
  if (layer_->plan().paths[static_cast<size_t>(path)].kind == Path::Kind::kContour) return entry;
  return 2 * layer_->table.first(path) + 1 - entry;
}

// What moved is pending: its neighbors are new, if only those of its first and last visit.
void SearchRoute::Place(int node, int begin, bool reversed) {
  begin_[static_cast<size_t>(node)] = begin;
  pending_node_[static_cast<size_t>(node)] = 1;
  if (layer_->tree.is_leaf(node)) {
    pending_visit_[static_cast<size_t>(layer_->tree.node(node).path)] = 1;
    return;
  }
  const absl::Span<const int> children = layer_->tree.children(node);
  const auto first = order_.begin() + layer_->tree.first_child(node);
  if (reversed) std::reverse(first, first + static_cast<std::ptrdiff_t>(children.size()));
  for (size_t k = 0; k < children.size(); ++k) {
    const int child = children[static_cast<size_t>(*(first + static_cast<std::ptrdiff_t>(k)))];
    Place(child, begin, reversed);
    begin += layer_->tree.path_count(child);
  }
}

void SearchRoute::Touch(int position) {
  if (position < 0 || position >= size()) return;
  const int path = layer_->table.path_of(entry(position));
  pending_visit_[static_cast<size_t>(path)] = 1;
  for (int node = layer_->tree.leaf(path); node >= 0; node = layer_->tree.parent(node)) {
    pending_node_[static_cast<size_t>(node)] = 1;
  }
}

Route SearchRoute::ToRoute() const {
  Route route;
  route.reserve(entries_.size());
  for (const int entry : entries_) route.push_back(layer_->table.VisitOf(entry));
  return route;
}

double SearchRoute::Cost() const { return RouteCost(layer_->problem, ToRoute()); }

}  // namespace traverse
