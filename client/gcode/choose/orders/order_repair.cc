#include "client/gcode/choose/orders/order_repair.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace traverse::gcode {
namespace {

// So many pairs are put in order one by one, for each takes a look at the whole layer.
constexpr size_t kMostMoved = 64;

LayerOrder::iterator Find(LayerOrder& order, uint32_t block) {
  return std::ranges::find(order, block, &Placement::block);
}

// `order` with `first` and `second`, the paths at the places `begin` and `end` in either order,
// next to each other. Paths between them that come before `second` as sliced go before both, all
// others behind.
LayerOrder Joined(LayerOrder order, size_t begin, size_t end, const Placement& first,
                  const Placement& second) {
  LayerOrder behind;
  auto to = order.begin() + static_cast<std::ptrdiff_t>(begin);
  for (size_t place = begin + 1; place < end; ++place) {
    if (order[place].block < second.block) {
      *to++ = order[place];
    } else {
      behind.push_back(order[place]);
    }
  }
  *to++ = first;
  *to++ = second;
  std::copy(behind.begin(), behind.end(), to);
  return order;
}

// `order` with `first` and the path behind it as sliced next to each other, both as sliced.
LayerOrder JoinedAsSliced(LayerOrder order, const Placement& first, const Placement& second) {
  const auto a = Find(order, first.block) - order.begin();
  const auto b = Find(order, second.block) - order.begin();
  const auto [begin, end] = std::minmax(a, b);
  return Joined(std::move(order), static_cast<size_t>(begin), static_cast<size_t>(end), first,
                second);
}

// [path] its place in `order`.
std::vector<size_t> PlacesIn(const LayerOrder& order, uint32_t first) {
  std::vector<size_t> places(order.size());
  for (size_t place = 0; place < order.size(); ++place) places[order[place].block - first] = place;
  return places;
}

// `order` with the path at `later` behind the one at `earlier`, a place behind it, which comes
// before it as sliced.
LayerOrder Ordered(LayerOrder order, size_t later, size_t earlier) {
  const Placement first = order[earlier];
  const Placement second = order[later];
  return Joined(std::move(order), later, earlier, first, second);
}

// `order` with its paths at [begin, end) as sliced.
LayerOrder AsSliced(LayerOrder order, size_t begin, size_t end) {
  const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = order.begin() + static_cast<std::ptrdiff_t>(end);
  for (auto path = first; path != last; ++path) path->entry = 0;
  std::ranges::sort(first, last, {}, &Placement::block);
  return order;
}

}  // namespace

bool HasAnyOf(const LayerOrder& order, const LinkSet& links) {
  for (size_t place = 1; place < order.size() && !links.empty(); ++place) {
    if (links.contains({order[place - 1], order[place]})) return true;
  }
  return false;
}

bool BreaksAnyOf(const LayerOrder& order, uint32_t first, const std::vector<PathPair>& pairs) {
  if (pairs.empty()) return false;
  const std::vector<size_t> places = PlacesIn(order, first);
  return std::any_of(pairs.begin(), pairs.end(), [&places](const PathPair& pair) {
    return places[pair.first] > places[pair.second];
  });
}

LayerOrder InOrderOf(LayerOrder order, uint32_t first, const std::vector<PathPair>& pairs) {
  size_t moved = 0;
  size_t begin = order.size();
  size_t end = 0;
  std::vector<size_t> places = PlacesIn(order, first);
  for (const auto& [earlier, later] : pairs) {
    if (places[earlier] <= places[later]) continue;
    if (moved++ < kMostMoved) {
      order = Ordered(std::move(order), places[later], places[earlier]);
      places = PlacesIn(order, first);
    } else {
      begin = std::min(begin, places[later]);
      end = std::max(end, places[earlier] + 1);
    }
  }
  return begin < end ? AsSliced(std::move(order), begin, end) : order;
}

std::vector<LayerOrder> OrdersWithoutLink(const LayerOrder& order, size_t place,
                                          const LayerOrder& sliced, size_t reach) {
  assert(0 < place && place < order.size() && order.size() == sliced.size() && reach > 0);
  const uint32_t first = sliced.front().block;
  const size_t from = order[place - 1].block - first;
  const size_t to = order[place].block - first;
  std::vector<LayerOrder> orders;
  if (from + 1 < sliced.size())
    orders.push_back(JoinedAsSliced(order, sliced[from], sliced[from + 1]));
  if (to > 0) orders.push_back(JoinedAsSliced(order, sliced[to - 1], sliced[to]));
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
