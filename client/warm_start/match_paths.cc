#include "client/warm_start/match_paths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "client/warm_start/point_tree.h"

namespace traverse {
namespace {

// Points this near are the same but for rounding: of a file, and of one that was moved.
constexpr double kSameMm = 1e-6;
constexpr double kSameAfterMoveMm = 2e-3;

// Of the paths near a visit only so many are looked at.
constexpr size_t kMostNear = 8;

// Objects of a plate that were moved, each in its own way.
constexpr int kMostMoves = 16;

using Label = std::tuple<bool, uint64_t, uint64_t>;  // whether a contour, island, id

Label LabelOf(const EarlierVisit& visit) { return {visit.contour, visit.island, visit.id}; }
Label LabelOf(const ShapePath& path) { return {path.contour, path.island, path.id}; }

double Distance(const PlacedPoint& a, std::pair<double, double> b) {
  return std::hypot(a.x - b.first, a.y - b.second);
}

bool MayEnter(const ShapePath& path, uint32_t entry) {
  return std::find(path.entries.begin(), path.entries.end(), entry) != path.entries.end();
}

// The points at which paths of one kind may be entered.
PointTree TreeOf(const LayerShape& shape, bool contours) {
  std::vector<OwnedPoint> points;
  for (size_t p = 0; p < shape.paths.size(); ++p) {
    const ShapePath& path = shape.paths[p];
    if (path.contour != contours) continue;
    for (const uint32_t entry : path.entries) {
      const auto [x, y] = path.Enter(entry);
      points.push_back({x, y, static_cast<int>(p), static_cast<int>(entry)});
    }
  }
  return PointTree(std::move(points));
}

class Matcher {
 public:
  Matcher(absl::Span<const EarlierVisit> route, const LayerShape& shape)
      : route_(route),
        shape_(shape),
        contours_(TreeOf(shape, true)),
        open_(TreeOf(shape, false)),
        found_(route.size()),
        taken_(shape.paths.size()) {}

  std::vector<FoundPath> Run() {
    MatchWithin(kSameMm, {});
    for (int moves = 0; moves < kMostMoves; ++moves) {
      const std::optional<PlacedPoint> move = MostCommonMove();
      if (!move || MatchWithin(kSameAfterMoveMm, *move) == 0) break;
    }
    MatchWithin(kMovedMm, {});
    for (const auto& [visit, path] : SameLabels()) Take(visit, path, EntryOf(visit, path));
    return std::move(found_);
  }

 private:
  struct Candidate {
    double distance = 0;
    bool other_label = false;
    bool other_entry = false;
    size_t visit = 0;
    int path = 0;
    uint32_t entry = 0;
    auto Key() const { return std::tie(distance, other_label, other_entry, visit, path, entry); }
  };

  bool IsMatched(size_t visit) const { return found_[visit].path >= 0; }

  void Take(size_t visit, int path, uint32_t entry) {
    found_[visit] = {path, entry};
    taken_[static_cast<size_t>(path)] = true;
    (shape_.paths[static_cast<size_t>(path)].contour ? contours_ : open_).Remove(path);
  }

  // Matches what is within `radius`, nearest first, after the visits were moved. Returns how many.
  size_t MatchWithin(double radius, PlacedPoint move) {
    std::vector<Candidate> candidates;
    for (size_t v = 0; v < route_.size(); ++v) {
      if (!IsMatched(v) && route_[v].from) AddNear(v, radius, move, candidates);
    }
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.Key() < b.Key(); });
    size_t matched = 0;
    for (const Candidate& candidate : candidates) {
      if (IsMatched(candidate.visit) || taken_[static_cast<size_t>(candidate.path)]) continue;
      Take(candidate.visit, candidate.path, candidate.entry);
      ++matched;
    }
    return matched;
  }

  void AddNear(size_t visit, double radius, PlacedPoint move, std::vector<Candidate>& all) const {
    const EarlierVisit& earlier = route_[visit];
    const PlacedPoint from{earlier.from->x + move.x, earlier.from->y + move.y};
    std::vector<Candidate> near;
    for (const OwnedPoint& point :
         (earlier.contour ? contours_ : open_).Within(from.x, from.y, radius)) {
      const ShapePath& path = shape_.paths[static_cast<size_t>(point.owner)];
      const auto entry = static_cast<uint32_t>(point.vertex);
      double distance = Distance(from, path.Enter(entry));
      if (earlier.to) {
        const PlacedPoint to{earlier.to->x + move.x, earlier.to->y + move.y};
        distance = std::max(distance, Distance(to, path.Exit(entry)));
      }
      if (distance > radius) continue;
      near.push_back({distance, LabelOf(path) != LabelOf(earlier), entry != earlier.entry, visit,
                      point.owner, entry});
    }
    std::sort(near.begin(), near.end(),
              [](const Candidate& a, const Candidate& b) { return a.Key() < b.Key(); });
    std::vector<int> paths;
    for (const Candidate& candidate : near) {
      if (std::find(paths.begin(), paths.end(), candidate.path) != paths.end()) continue;
      paths.push_back(candidate.path);
      all.push_back(candidate);
      if (paths.size() == kMostNear) return;
    }
  }

  // The visits and paths that are not matched and have the same label, which nothing else has.
  std::vector<std::pair<size_t, int>> SameLabels() const {
    constexpr int kSeveral = -2;
    std::map<Label, std::pair<int, int>> by_label;  // visit and path; -1: none
    const auto note = [](int& slot, size_t index) {
      slot = slot == -1 ? static_cast<int>(index) : kSeveral;
    };
    for (size_t v = 0; v < route_.size(); ++v) {
      if (IsMatched(v)) continue;
      note(by_label.try_emplace(LabelOf(route_[v]), -1, -1).first->second.first, v);
    }
    for (size_t p = 0; p < shape_.paths.size(); ++p) {
      if (taken_[p]) continue;
      note(by_label.try_emplace(LabelOf(shape_.paths[p]), -1, -1).first->second.second, p);
    }
    std::vector<std::pair<size_t, int>> pairs;
    for (const auto& [label, ends] : by_label) {
      if (ends.first >= 0 && ends.second >= 0) {
        pairs.emplace_back(static_cast<size_t>(ends.first), ends.second);
      }
    }
    return pairs;
  }

  // By how much most of what has the same label was moved, if it was by the same.
  std::optional<PlacedPoint> MostCommonMove() const {
    constexpr double kUnitsPerMm = 1e3;
    std::map<std::pair<double, double>, std::pair<int, PlacedPoint>> moves;  // by rounded ones
    int most = 0;
    std::optional<PlacedPoint> common;
    for (const auto& [v, p] : SameLabels()) {
      const EarlierVisit& visit = route_[v];
      const ShapePath& path = shape_.paths[static_cast<size_t>(p)];
      if (!visit.from || !MayEnter(path, visit.entry)) continue;
      const auto [x, y] = path.Enter(visit.entry);
      const PlacedPoint move{x - visit.from->x, y - visit.from->y};
      auto& [count, first] =
          moves
              .try_emplace({std::round(move.x * kUnitsPerMm), std::round(move.y * kUnitsPerMm)}, 0,
                           move)
              .first->second;
      if (++count <= most) continue;
      most = count;
      common = first;
    }
    // One path alone may be another one that has the label now.
    return most > 1 ? common : std::nullopt;
  }

  // Where to enter a path of which only the label is the same.
  uint32_t EntryOf(size_t visit, int path) const {
    const ShapePath& of = shape_.paths[static_cast<size_t>(path)];
    const uint32_t entry = route_[visit].entry;
    return MayEnter(of, entry) ? entry : of.entries.front();
  }

  const absl::Span<const EarlierVisit> route_;
  const LayerShape& shape_;
  PointTree contours_;
  PointTree open_;
  std::vector<FoundPath> found_;  // [visit]
  std::vector<bool> taken_;       // [path]
};

}  // namespace

std::vector<FoundPath> MatchPaths(absl::Span<const EarlierVisit> route, const LayerShape& shape) {
  return Matcher(route, shape).Run();
}

Stayed CountStayed(absl::Span<const EarlierVisit> route, const LayerShape& shape) {
  const PointTree trees[] = {TreeOf(shape, false), TreeOf(shape, true)};
  Stayed stayed;
  for (const EarlierVisit& visit : route) {
    if (!visit.from) continue;
    ++stayed.known;
    const auto [x, y] = *visit.from;
    const OwnedPoint* nearest = trees[visit.contour ? 1 : 0].Nearest(x, y);
    if (nearest != nullptr && std::hypot(nearest->x - x, nearest->y - y) <= kSameMm) {
      ++stayed.visits;
    }
  }
  return stayed;
}

}  // namespace traverse
