#include "client/warm_start/start_from.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "client/warm_start/layer_shape.h"
#include "client/warm_start/match_paths.h"
#include "client/warm_start/point_tree.h"

namespace traverse {
namespace {

using XY = std::pair<double, double>;

double Between(XY a, XY b) { return std::hypot(a.first - b.first, a.second - b.second); }

// The paths of a layer in the order that is known of them, and the others where they are near.
class RouteMaker {
 public:
  RouteMaker(const LayerShape& shape, absl::Span<const FoundPath> found)
      : shape_(shape), entry_(shape.paths.size()), rank_(shape.paths.size(), -1) {
    for (const FoundPath& visit : found) {
      if (visit.path < 0) continue;
      rank_[static_cast<size_t>(visit.path)] = static_cast<double>(known_.size());
      below_[shape.paths[static_cast<size_t>(visit.path)].parent].push_back(known_.size());
      entry_[static_cast<size_t>(visit.path)] = visit.entry;
      known_.push_back(visit);
    }
  }

  size_t known() const { return known_.size(); }

  // Empty if the layer allows no order. REQUIRES: some path is known.
  std::vector<v1::Visit> Route() {
    assert(!known_.empty());
    std::map<size_t, std::vector<int>> news;  // by the known visit before which they come
    for (size_t p = 0; p < shape_.paths.size(); ++p) {
      if (rank_[p] < 0) news[GapFor(shape_.paths[p])].push_back(static_cast<int>(p));
    }
    for (const auto& [gap, paths] : news) RankInGap(gap, paths);
    const std::vector<int> order = OrderByRanks(shape_, rank_);
    std::vector<v1::Visit> route;
    if (order.size() != shape_.paths.size()) return route;
    for (const int path : order) {
      const auto p = static_cast<size_t>(path);
      route.push_back(shape_.paths[p].VisitAt(entry_[p]));
    }
    return route;
  }

 private:
  XY EnterOf(size_t known) const {
    return shape_.paths[static_cast<size_t>(known_[known].path)].Enter(known_[known].entry);
  }
  XY ExitOf(size_t known) const {
    return shape_.paths[static_cast<size_t>(known_[known].path)].Exit(known_[known].entry);
  }

  // The ends of the known visits below one node, by their numbers among all; of all if none is
  // below it.
  const PointTree& EndsBelow(int parent) {
    const auto own = below_.find(parent);
    if (own == below_.end()) {
      if (!all_ends_) {
        std::vector<size_t> all(known_.size());
        std::iota(all.begin(), all.end(), size_t{0});
        all_ends_.emplace(EndsOf(all));
      }
      return *all_ends_;
    }
    const auto made = ends_.find(parent);
    if (made != ends_.end()) return made->second;
    return ends_.emplace(parent, PointTree(EndsOf(own->second))).first->second;
  }

  std::vector<OwnedPoint> EndsOf(absl::Span<const size_t> known) const {
    std::vector<OwnedPoint> ends;
    for (const size_t i : known) {
      for (const auto& [x, y] : {EnterOf(i), ExitOf(i)}) {
        ends.push_back({x, y, static_cast<int>(i), 0});
      }
    }
    return ends;
  }

  // The known visit before which a new path comes: beside the nearest one among its siblings, on
  // the side where the detour is shorter.
  size_t GapFor(const ShapePath& path) {
    const PointTree& ends = EndsBelow(path.parent);
    XY at;
    size_t beside = 0;
    double least = -1;
    for (const uint32_t entry : path.entries) {
      const XY enter = path.Enter(entry);
      const OwnedPoint& nearest = *ends.Nearest(enter.first, enter.second);
      const double distance = Between(enter, {nearest.x, nearest.y});
      if (least >= 0 && distance >= least) continue;
      least = distance;
      at = enter;
      beside = static_cast<size_t>(nearest.owner);
    }
    const double before =
        beside == 0 ? Between(at, EnterOf(0)) : Detour(ExitOf(beside - 1), at, EnterOf(beside));
    const double after = beside + 1 == known_.size()
                             ? Between(ExitOf(beside), at)
                             : Detour(ExitOf(beside), at, EnterOf(beside + 1));
    return before < after ? beside : beside + 1;
  }

  static double Detour(XY from, XY by, XY to) {
    return Between(from, by) + Between(by, to) - Between(from, to);
  }

  // Ranks new paths between two known visits, each time the nearest one next.
  void RankInGap(size_t gap, const std::vector<int>& paths) {
    std::vector<OwnedPoint> entries;
    for (size_t i = 0; i < paths.size(); ++i) {
      const ShapePath& path = shape_.paths[static_cast<size_t>(paths[i])];
      for (const uint32_t entry : path.entries) {
        const auto [x, y] = path.Enter(entry);
        entries.push_back({x, y, static_cast<int>(i), static_cast<int>(entry)});
      }
    }
    PointTree left(std::move(entries));
    XY at = gap == 0 ? EnterOf(0) : ExitOf(gap - 1);
    for (size_t i = 0; i < paths.size(); ++i) {
      const OwnedPoint next = *left.Nearest(at.first, at.second);
      left.Remove(next.owner);
      const auto path = static_cast<size_t>(paths[static_cast<size_t>(next.owner)]);
      entry_[path] = static_cast<uint32_t>(next.vertex);
      rank_[path] = static_cast<double>(gap) - 1 +
                    static_cast<double>(i + 1) / static_cast<double>(paths.size() + 1);
      at = shape_.paths[path].Exit(entry_[path]);
    }
  }

  const LayerShape& shape_;
  std::vector<uint32_t> entry_;               // [path]
  std::vector<double> rank_;                  // [path]; -1: not known yet
  std::vector<FoundPath> known_;              // in the earlier order
  std::map<int, std::vector<size_t>> below_;  // [parent] of them
  std::map<int, PointTree> ends_;             // [parent]
  std::optional<PointTree> all_ends_;
};

uint64_t PlaceKey(double x, double y) {
  // 0 and -0 are the same.
  return std::rotl(std::bit_cast<uint64_t>(x + 0.0), 21) * 0x9e3779b97f4a7c15u ^
         std::bit_cast<uint64_t>(y + 0.0);
}

// Which earlier layer fits one of the job.
class LayerChooser {
 public:
  explicit LayerChooser(absl::Span<const EarlierLayer> earlier) : earlier_(earlier) {
    for (size_t i = 0; i < earlier.size(); ++i) {
      const auto [slot, is_first] = by_id_.try_emplace(earlier[i].id, i);
      if (!is_first) slot->second = kSeveral;
      for (const EarlierVisit& visit : earlier[i].route) {
        if (!visit.from) continue;
        std::vector<size_t>& there = by_place_[PlaceKey(visit.from->x, visit.from->y)];
        if (there.empty() || there.back() != i) there.push_back(i);
      }
    }
  }

  // Null if none does. `position`: of the layer in the job.
  const EarlierLayer* For(const v1::Layer& layer, size_t position, const LayerShape& shape) const {
    const auto found = by_id_.find(layer.id());
    const bool has_id = found != by_id_.end() && found->second != kSeveral;
    size_t best = has_id ? found->second : position;
    if (best < earlier_.size()) {
      const Stayed stayed = CountStayed(earlier_[best].route, shape);
      if (stayed.known == 0 || stayed.visits * 2 >= stayed.known) return &earlier_[best];
      if (const std::optional<size_t> other = MostAlike(shape, best)) {
        const Stayed there = CountStayed(earlier_[*other].route, shape);
        if (there.visits > stayed.visits) best = *other;
      }
    } else if (const std::optional<size_t> other = MostAlike(shape, best)) {
      best = *other;
    }
    return best < earlier_.size() ? &earlier_[best] : nullptr;
  }

 private:
  static constexpr size_t kSeveral = SIZE_MAX;

  // The layer in which most of some of the paths were entered where they may be entered now, of
  // several the one nearest to `near`.
  std::optional<size_t> MostAlike(const LayerShape& shape, size_t near) const {
    constexpr size_t kProbes = 8;
    std::map<size_t, size_t> votes;
    const size_t count = std::min(kProbes, shape.paths.size());
    for (size_t i = 0; i < count; ++i) {
      const ShapePath& path = shape.paths[i * shape.paths.size() / count];
      std::vector<size_t> voted;
      for (const uint32_t entry : path.entries) {
        const auto [x, y] = path.Enter(entry);
        const auto there = by_place_.find(PlaceKey(x, y));
        if (there != by_place_.end()) voted.push_back(NearestOf(there->second, near));
      }
      std::sort(voted.begin(), voted.end());
      voted.erase(std::unique(voted.begin(), voted.end()), voted.end());
      for (const size_t layer : voted) ++votes[layer];
    }
    const auto most =
        std::max_element(votes.begin(), votes.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == votes.end() || most->second * 2 < count) return std::nullopt;
    return most->first;
  }

  // `sorted` is not empty.
  static size_t NearestOf(const std::vector<size_t>& sorted, size_t to) {
    const auto above = std::lower_bound(sorted.begin(), sorted.end(), to);
    if (above == sorted.begin()) return *above;
    if (above == sorted.end()) return *std::prev(above);
    return *above - to < to - *std::prev(above) ? *above : *std::prev(above);
  }

  const absl::Span<const EarlierLayer> earlier_;
  std::unordered_map<uint64_t, size_t> by_id_;                  // kSeveral: of several
  std::unordered_map<uint64_t, std::vector<size_t>> by_place_;  // layers, ascending
};

}  // namespace

WarmStart StartFrom(absl::Span<const EarlierLayer> earlier, InputJob& job) {
  const LayerChooser chooser(earlier);
  const bool interleaved = job.options.deposition() == v1::DEPOSITION_INTERLEAVED;
  WarmStart start;
  for (size_t i = 0; i < job.layers.size(); ++i) {
    v1::Layer& layer = job.layers[i];
    const PathNotes* notes = i < job.notes.size() ? &job.notes[i] : nullptr;
    const std::optional<LayerShape> shape = ShapeOf(layer, interleaved, notes);
    if (!shape || shape->paths.empty()) continue;
    const EarlierLayer* known = chooser.For(layer, job.first_layer + i, *shape);
    if (known == nullptr) continue;
    RouteMaker maker(*shape, MatchPaths(known->route, *shape));
    if (maker.known() == 0) continue;
    const std::vector<v1::Visit> route = maker.Route();
    if (route.empty()) continue;
    layer.mutable_initial_route()->Assign(route.begin(), route.end());
    ++start.layers;
    start.paths += shape->paths.size();
    start.known += maker.known();
  }
  return start;
}

}  // namespace traverse
