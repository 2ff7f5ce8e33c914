#include "client/gcode/plan/precedence.h"

#include <algorithm>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/model/segment_grid.h"
#include "engine/base/disjoint_sets.h"

namespace traverse::gcode {
namespace {

// Segments this many cells apart are found by the grid.
constexpr double kNearInCells = 0.75;

// What is known about the order of two paths.
enum class Order : uint8_t { kNone, kIfTheyTouch, kKnown };

std::vector<Segment> AllSegments(const std::vector<Outline>& outlines) {
  std::vector<Segment> segments;
  for (size_t path = 0; path < outlines.size(); ++path) {
    const std::vector<Vertex>& points = outlines[path].shape();
    for (size_t k = 0; k + 1 < points.size(); ++k) {
      segments.push_back(Segment{points[k], points[k + 1], static_cast<uint32_t>(path)});
    }
  }
  return segments;
}

double WidestOf(const std::vector<Outline>& outlines) {
  double widest = 0.1;
  for (const Outline& outline : outlines) widest = std::max(widest, outline.width_mm);
  return widest;
}

}  // namespace

Contacts FindContacts(const std::vector<Outline>& outlines,
                      const std::function<bool(uint32_t, uint32_t)>& keeps_order) {
  Contacts contacts;
  DisjointSets regions(static_cast<int>(outlines.size()));
  absl::flat_hash_map<std::pair<uint32_t, uint32_t>, Order> orders;
  const auto ascending = [](uint32_t i, uint32_t j) {
    return std::pair<uint32_t, uint32_t>(std::min(i, j), std::max(i, j));
  };
  const SegmentGrid grid(AllSegments(outlines),
                         std::max(kTouchMm, kTouch * WidestOf(outlines)) / kNearInCells);
  const auto reach = [&](uint32_t one, uint32_t other) {
    return std::max(kTouchMm, kTouch * (outlines[one].width_mm + outlines[other].width_mm) / 2);
  };
  const auto order_of = [&](uint32_t one, uint32_t other) -> Order& {
    const std::pair<uint32_t, uint32_t> pair = ascending(one, other);
    const auto [found, added] = orders.try_emplace(pair, Order::kNone);
    if (added && keeps_order(pair.first, pair.second)) found->second = Order::kIfTheyTouch;
    return found->second;
  };
  // Of most paths that touch nothing more is to be learnt: they do in many places.
  const auto reach_if_wanted = [&](uint32_t one, uint32_t other) {
    const bool joined = regions.AreJoined(static_cast<int>(one), static_cast<int>(other));
    return joined && order_of(one, other) != Order::kIfTheyTouch ? -1.0 : reach(one, other);
  };
  const auto look_at = [&](uint32_t s, uint32_t t) {
    const Segment& one = grid.segments()[s];
    const Segment& other = grid.segments()[t];
    const double near = reach(one.path, other.path);
    if (SquaredDistance(one, other) > near * near) return true;
    regions.Join(static_cast<int>(one.path), static_cast<int>(other.path));
    if (Order& order = order_of(one.path, other.path); order == Order::kIfTheyTouch) {
      order = Order::kKnown;
      contacts.ordered.push_back(ascending(one.path, other.path));
    }
    return false;
  };
  const double most = kMostPairsOfAll + kMostPairsEach * static_cast<double>(grid.entry_count());
  contacts.complete = grid.ForEachNearPair(reach_if_wanted, look_at, most);
  if (!contacts.complete) {
    contacts.island.assign(outlines.size(), 0);
    return contacts;
  }
  std::sort(contacts.ordered.begin(), contacts.ordered.end());
  for (const int island : regions.Numbered()) {
    contacts.island.push_back(static_cast<uint32_t>(island));
  }
  return contacts;
}

}  // namespace traverse::gcode
