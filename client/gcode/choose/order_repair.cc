#include "client/gcode/choose/order_repair.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace traverse::gcode {
namespace {

LayerOrder::iterator Find(LayerOrder& order, uint32_t block) {
  return std::find_if(order.begin(), order.end(),
                      [block](const Placement& placement) { return placement.block == block; });
}

// `order` with `first` and the path behind it next to each other, both as sliced. Paths between
// them that come earlier as sliced go before both, all others behind.
LayerOrder Joined(LayerOrder order, const Placement& first, const Placement& second) {
  auto begin = Find(order, first.block);
  auto end = Find(order, second.block);
  if (end < begin) std::swap(begin, end);
  ++end;
  LayerOrder behind;
  auto to = begin;
  for (auto path = begin; path != end; ++path) {
    if (path->block < first.block) {
      *to++ = *path;
    } else if (path->block > second.block) {
      behind.push_back(*path);
    }
  }
  *to++ = first;
  *to++ = second;
  std::copy(behind.begin(), behind.end(), to);
  return order;
}

// `order` with its paths at [begin, end) as sliced.
LayerOrder AsSliced(LayerOrder order, size_t begin, size_t end) {
  const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = order.begin() + static_cast<std::ptrdiff_t>(end);
  for (auto path = first; path != last; ++path) path->entry = 0;
  std::sort(first, last, [](const Placement& a, const Placement& b) { return a.block < b.block; });
  return order;
}

}  // namespace

bool HasAnyOf(const LayerOrder& order, const LinkSet& links) {
  for (size_t place = 1; place < order.size() && !links.empty(); ++place) {
    if (links.contains({order[place - 1], order[place]})) return true;
  }
  return false;
}

std::vector<LayerOrder> OrdersWithoutLink(const LayerOrder& order, size_t place,
                                          const LayerOrder& sliced, size_t reach) {
  assert(0 < place && place < order.size() && order.size() == sliced.size() && reach > 0);
  const uint32_t first = sliced.front().block;
  const size_t from = order[place - 1].block - first;
  const size_t to = order[place].block - first;
  std::vector<LayerOrder> orders;
  if (from + 1 < sliced.size()) orders.push_back(Joined(order, sliced[from], sliced[from + 1]));
  if (to > 0) orders.push_back(Joined(order, sliced[to - 1], sliced[to]));
  orders.push_back(
      AsSliced(order, place - std::min(place, reach), std::min(place + reach, order.size())));
  return orders;
}

LayerOrder BegunAsSliced(const LayerOrder& order, const LayerOrder& sliced) {
  LayerOrder begun = order;
  const auto first = Find(begun, sliced.front().block);
  std::rotate(begun.begin(), first, first + 1);
  begun.front() = sliced.front();
  return begun;
}

LayerOrder EndedAsSliced(const LayerOrder& order, const LayerOrder& sliced) {
  LayerOrder ended = order;
  const auto last = Find(ended, sliced.back().block);
  std::rotate(last, last + 1, ended.end());
  ended.back() = sliced.back();
  return ended;
}

}  // namespace traverse::gcode
