#include "client/gtsp/tour.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace traverse::gtsp {
namespace {

using Set = std::vector<uint32_t>;

// The shortest closed tour through `sets` in this order. It starts at the point `first`, which
// stands for sets[0].
Tour TourFrom(const Instance& instance, absl::Span<const Set* const> sets, uint32_t first) {
  const Set begin = {first};
  const Set* before = &begin;
  std::vector<int64_t> length = {0};
  std::vector<std::vector<uint32_t>> from(
      sets.size());  // by set and point: index of the point before
  const auto step = [&](uint32_t to, uint32_t& place) {
    int64_t least = std::numeric_limits<int64_t>::max();
    for (size_t i = 0; i < before->size(); ++i) {
      const int64_t sum =
          length[i] + RoundedDistance(instance.points[(*before)[i]], instance.points[to]);
      if (sum >= least) continue;
      least = sum;
      place = static_cast<uint32_t>(i);
    }
    return least;
  };
  for (size_t s = 1; s < sets.size(); ++s) {
    from[s].resize(sets[s]->size());
    std::vector<int64_t> next;
    for (size_t i = 0; i < sets[s]->size(); ++i) next.push_back(step((*sets[s])[i], from[s][i]));
    before = sets[s];
    length = std::move(next);
  }
  Tour tour;
  uint32_t place = 0;
  tour.rounded_length = step(first, place);
  for (size_t s = sets.size() - 1; s > 0; --s) {
    tour.points.push_back((*sets[s])[place]);
    place = from[s][place];
  }
  tour.points.push_back(first);
  std::reverse(tour.points.begin(), tour.points.end());
  return tour;
}

}  // namespace

int64_t RoundedDistance(const Instance::Point& a, const Instance::Point& b) {
  return static_cast<int64_t>(std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)) +
                              0.5);
}

Tour BestTour(const Instance& instance, absl::Span<const v1::LayerResult> layers) {
  assert(!layers.empty());
  const auto& layer = *std::min_element(
      layers.begin(), layers.end(),
      [](const auto& a, const auto& b) { return a.travel().total_mm() < b.travel().total_mm(); });
  // The paths are the other sets in their order, and last the point where the layer began.
  std::vector<const Set*> order = {&instance.sets[instance.first_set]};
  for (const v1::Visit& visit : layer.visits()) {
    const uint32_t path = visit.plan_path();
    if (path + 1 == instance.sets.size()) continue;
    order.push_back(&instance.sets[path < instance.first_set ? path : path + 1]);
  }
  Tour best;
  for (const uint32_t first : *order[0]) {
    Tour tour = TourFrom(instance, order, first);
    if (best.points.empty() || tour.rounded_length < best.rounded_length) best = std::move(tour);
  }
  return best;
}

}  // namespace traverse::gtsp
