#include "engine/search/greedy/frontier.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "engine/base/resting_sort.h"
#include "engine/cost/first_entries.h"

namespace traverse {
namespace {

// The leaf, or the any_order node of several children, with which `node` begins.
int SearchedBeginning(const PlanTree& tree, int node) {
  node = Beginning(tree, node);
  while (!tree.is_leaf(node) && tree.children(node).size() == 1) {
    node = Beginning(tree, tree.children(node)[0]);
  }
  return node;
}

}  // namespace

Frontier& Frontier::Forest::Of(int node) {
  assert(layer_->tree.node(node).kind == PlanNode::Kind::kAnyOrder);
  assert(!layer_->tree.children(node).empty());
  std::unique_ptr<Frontier>& frontier = frontiers_[static_cast<size_t>(node)];
  if (frontier == nullptr) frontier = std::make_unique<Frontier>(*layer_, node, *this);
  return *frontier;
}

Frontier::Frontier(const LayerView& layer, int node, Forest& forest)
    : nested_(layer.tree.children(node).size()),
      index_(ListEntries(layer, node, forest), &forest.budget()) {
  const int slots = static_cast<int>(nested_.size());
  std::vector<bool> waits(nested_.size(), true);
  ready_.emplace(layer.tree.precedence(node), slots, [&](int slot) {
    waits[static_cast<size_t>(slot)] = false;
    if (is_nested(slot)) nested_next_.push_back(slot);
  });
  Rest& rest = forest.rest();
  for (int slot = 0; slot < slots; ++slot) {
    rest();
    if (!waits[static_cast<size_t>(slot)]) continue;
    ForEachId(slot, [&](int id) {
      rest(32);
      index_.Remove(id);
    });
  }
}

// Ids follow the entries, as ties shall be broken.
std::vector<Point> Frontier::ListEntries(const LayerView& layer, int node, Forest& forest) {
  const absl::Span<const int> children = layer.tree.children(node);
  Rest& rest = forest.rest();
  first_id_.assign(children.size() + 1, 0);
  for (size_t s = 0; s < children.size(); ++s) {
    if (!rest(16) && forest.budget().cancelled()) return {};
    const int beginning = SearchedBeginning(layer.tree, children[s]);
    if (!layer.tree.is_leaf(beginning)) {
      nested_[s] = &forest.Of(beginning);
      box_.Add(nested_[s]->box_);
      continue;
    }
    const int path = layer.tree.node(beginning).path;
    for (int e = layer.table.first(path); e < layer.table.first(path + 1); ++e) {
      entries_.emplace_back(e, static_cast<int>(s));
      rest(2);
    }
  }
  if (!std::is_sorted(entries_.begin(), entries_.end())) {
    RestingSort(entries_, rest);
  }

  std::vector<Point> points;
  points.reserve(entries_.size());
  for (const auto& [entry, slot] : entries_) {
    rest(4);
    points.push_back(layer.table.enter(entry));
    box_.Add(points.back());
    ++first_id_[static_cast<size_t>(slot) + 1];
  }
  for (size_t s = 0; s < children.size(); ++s) first_id_[s + 1] += first_id_[s];
  ids_.resize(entries_.size());
  std::vector<size_t> next(first_id_.begin(), first_id_.end() - 1);
  for (size_t id = 0; id < entries_.size(); ++id) {
    rest(2);
    ids_[next[static_cast<size_t>(entries_[id].second)]++] = static_cast<int>(id);
  }
  return points;
}

Frontier::Found Frontier::Nearest(Point at) const {
  Found found;
  SearchNearest(at, found);
  assert(found.slot >= 0);
  return found;
}

// Replaces `found` by a nearer entry of this frontier.
void Frontier::SearchNearest(Point at, Found& found) const {
  if (const int id = index_.Nearest(at); id >= 0) {
    const auto [entry, slot] = entries_[static_cast<size_t>(id)];
    const double squared_mm = index_.SquaredDistance(id, at);
    if (std::pair(squared_mm, entry) < std::pair(found.squared_mm, found.entry)) {
      found = Found{squared_mm, entry, slot};
    }
  }
  for (const int slot : nested_next_) {
    const Frontier& nested = *nested_[static_cast<size_t>(slot)];
    if (nested.box_.SquaredDistanceTo(at) > found.squared_mm) continue;
    const int before = found.entry;
    nested.SearchNearest(at, found);
    if (found.entry != before) found.slot = slot;
  }
}

Frontier::Found Frontier::Any() const {
  Found found;
  const int id = index_.Any();
  assert(id >= 0 || !nested_next_.empty());
  found.slot = id >= 0 ? entries_[static_cast<size_t>(id)].second : nested_next_.back();
  return found;
}

void Frontier::Offer(int slot) {
  if (is_nested(slot)) {
    nested_next_.push_back(slot);
  } else {
    ForEachId(slot, [&](int id) { index_.Insert(id); });
  }
}

void Frontier::Begin(int slot) {
  if (is_nested(slot)) {
    nested_next_.erase(std::find(nested_next_.begin(), nested_next_.end(), slot));
  } else {
    ForEachId(slot, [&](int id) { index_.Remove(id); });
  }
}

void Frontier::Finish(int slot) {
  ready_->Finish(slot, [&](int ready) { Offer(ready); });
}

}  // namespace traverse
