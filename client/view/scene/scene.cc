#include "client/view/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace traverse::view {
namespace {

// Moves closer than this are the same; files state three digits.
constexpr double kSameMm = 1e-3;

using Key = std::pair<std::pair<int64_t, int64_t>, std::pair<int64_t, int64_t>>;

std::pair<int64_t, int64_t> Rounded(const DrawnPoint& point) {
  return {std::llround(point.x / kSameMm), std::llround(point.y / kSameMm)};
}

// The ends of a move, equal for both directions.
Key EndsOf(const DrawnMove& move) {
  const auto ends = std::minmax({Rounded(move.front()), Rounded(move.back())});
  return {ends.first, ends.second};
}

}  // namespace

DrawnPoint EntryOf(const DrawnPath& path, const DrawnVisit& visit) {
  if (path.closed) return path.points[visit.entry];
  return visit.entry == 0 ? path.points.front() : path.points.back();
}

DrawnPoint ExitOf(const DrawnPath& path, const DrawnVisit& visit) {
  if (path.closed) return path.points[visit.entry];
  return visit.entry == 0 ? path.points.back() : path.points.front();
}

std::vector<DrawnMove> MovesOf(const DrawnLayer& layer, const DrawnRoute& route,
                               std::optional<DrawnForm> form) {
  std::vector<DrawnMove> moves;
  DrawnPoint at = route.start;
  for (const DrawnVisit& visit : route.visits) {
    const DrawnPath& path = layer.paths[visit.path];
    DrawnMove move = {at};
    for (const DrawnPoint& corner : visit.via) {
      if (!(corner == move.back())) move.push_back(corner);
    }
    if (const DrawnPoint entry = EntryOf(path, visit); !(entry == move.back()))
      move.push_back(entry);
    const bool asked = !form || *form == visit.form;
    if (move.size() > 1 && asked) moves.push_back(std::move(move));
    at = ExitOf(path, visit);
  }
  return moves;
}

std::vector<DrawnForm> FormsOf(const DrawnLayer& layer) {
  std::set<DrawnForm> forms;
  for (const DrawnRoute& route : layer.routes) {
    for (const DrawnVisit& visit : route.visits) forms.insert(visit.form);
  }
  return {forms.begin(), forms.end()};
}

DrawnPoint EndOf(const DrawnLayer& layer, const DrawnRoute& route) {
  if (route.visits.empty()) return route.start;
  return ExitOf(layer.paths[route.visits.back().path], route.visits.back());
}

std::vector<DrawnMove> Vanished(const std::vector<DrawnMove>& before,
                                const std::vector<DrawnMove>& after) {
  std::map<Key, int> kept;
  for (const DrawnMove& move : after) ++kept[EndsOf(move)];
  std::vector<DrawnMove> gone;
  for (const DrawnMove& move : before) {
    const auto found = kept.find(EndsOf(move));
    if (found == kept.end() || found->second-- <= 0) gone.push_back(move);
  }
  return gone;
}

size_t LayerWithMostSaved(const Scene& scene) {
  const std::vector<Figures>& before = scene.routes.front().layers;
  const std::vector<Figures>& after = scene.routes[scene.shown].layers;
  size_t best = 0;
  const auto saved = [&](size_t i) { return before[i].travel_mm - after[i].travel_mm; };
  for (size_t i = 1; i < scene.layers(); ++i) {
    if (saved(i) > saved(best)) best = i;
  }
  return best;
}

}  // namespace traverse::view
