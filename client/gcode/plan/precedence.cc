#include "client/gcode/plan/precedence.h"

#include <algorithm>
#include <utility>

#include "absl/container/flat_hash_set.h"
#include "client/gcode/model/segment_grid.h"
#include "engine/base/disjoint_sets.h"

namespace traverse::gcode {
namespace {

// Segments this many cells apart are found by the grid.
constexpr double kNearInCells = 0.75;

std::vector<Segment> AllSegments(const std::vector<Outline>& outlines) {
  std::vector<Segment> segments;
  for (size_t path = 0; path < outlines.size(); ++path) {
    AddSegments(outlines[path].shape(), static_cast<uint32_t>(path), segments);
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
  absl::flat_hash_set<std::pair<uint32_t, uint32_t>> ordered;
  const SegmentGrid grid(AllSegments(outlines),
                         std::max(kTouchMm, kTouch * WidestOf(outlines)) / kNearInCells);
  const auto reach = [&](uint32_t one, uint32_t other) {
    return std::max(kTouchMm, kTouch * (outlines[one].width_mm + outlines[other].width_mm) / 2);
  };
  // Of most paths that touch nothing more is to be learnt: they do in many places.
  const size_t most_ordered = kMostOrderedEach * outlines.size();
  const auto wanted = [&](uint32_t one, uint32_t other) {
    if (ordered.size() > most_ordered) return false;
    if (!regions.AreJoined(static_cast<int>(one), static_cast<int>(other))) return true;
    const auto [first, second] = std::minmax(one, other);
    return keeps_order(first, second) && !ordered.contains({first, second});
  };
  const auto look_at = [&](uint32_t s, uint32_t t) {
    const Segment& one = grid.segments()[s];
    const Segment& other = grid.segments()[t];
    const double near = reach(one.path, other.path);
    if (SquaredDistance(one, other) > near * near) return true;
    regions.Join(static_cast<int>(one.path), static_cast<int>(other.path));
    const auto [first, second] = std::minmax(one.path, other.path);
    if (keeps_order(first, second)) ordered.emplace(first, second);
    return false;
  };
  const double most = kMostPairsOfAll + kMostPairsEach * static_cast<double>(grid.entry_count());
  contacts.complete =
      grid.ForEachNearPair(reach, wanted, look_at, most) && ordered.size() <= most_ordered;
  if (!contacts.complete) {
    contacts.island.assign(outlines.size(), 0);
    return contacts;
  }
  contacts.ordered.assign(ordered.begin(), ordered.end());
  std::sort(contacts.ordered.begin(), contacts.ordered.end());
  for (const int island : regions.Numbered()) {
    contacts.island.push_back(static_cast<uint32_t>(island));
  }
  return contacts;
}

}  // namespace traverse::gcode
