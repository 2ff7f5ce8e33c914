#include "engine/weller/steps/neighborhood.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "engine/base/rest.h"
#include "engine/geometry/bounding_box.h"
#include "engine/geometry/set_distance.h"
#include "engine/weller/steps/point_reduction.h"

namespace traverse {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Of so many clusters each pair is linked. The links of more would leave little of a neighborhood,
// and take memory for each pair.
constexpr int kMostPairedClusters = 200;

std::vector<BoundingBox> BoxesOf(const std::vector<CircledContour>& nodes) {
  std::vector<BoundingBox> boxes;
  boxes.reserve(nodes.size());
  for (const CircledContour& node : nodes) boxes.emplace_back(node.points);
  return boxes;
}

std::vector<CircledContour> WithOrigin(const std::vector<CircledContour>& contours, Point origin) {
  std::vector<CircledContour> nodes = contours;
  nodes.push_back({{origin}, origin, 0});
  return nodes;
}

// Distances from one center to contours, nearest first. Exact distances are computed only as far as
// they are asked for: those to the boxes come first and are never greater.
class NearestContours {
 public:
  NearestContours(const std::vector<CircledContour>& nodes, const std::vector<BoundingBox>& boxes,
                  size_t node, Budget& budget)
      : nodes_(nodes), center_(nodes[node].center), budget_(budget) {
    std::vector<Candidate> boxed;
    for (size_t i = 0; i + 1 < nodes.size(); ++i) {  // the origin, the last one, is never met
      if (i != node) boxed.push_back({boxes[i].DistanceTo(center_), false, static_cast<int>(i)});
    }
    queue_ = Queue(std::greater<>(), std::move(boxed));
  }

  bool empty() const { return queue_.empty(); }

  // The next contour and its distance. REQUIRES: not empty.
  std::pair<int, double> Next() {
    while (true) {
      assert(!empty());
      const Candidate candidate = queue_.top();
      queue_.pop();
      if (candidate.exact) return {candidate.node, candidate.distance};
      const auto& points = nodes_[static_cast<size_t>(candidate.node)].points;
      queue_.push({LeastDistance(points, {center_}, budget_), true, candidate.node});
    }
  }

 private:
  struct Candidate {
    double distance;
    bool exact;
    int node;
    auto operator<=>(const Candidate&) const = default;
  };
  using Queue = std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>>;

  const std::vector<CircledContour>& nodes_;
  Point center_;
  Budget& budget_;
  Queue queue_;
};

// The first radius, in steps from `first`, that is not below `distance`.
double RadiusReaching(double distance, double first, double step) {
  return distance <= first ? first : first + std::ceil((distance - first) / step) * step;
}

// A link between two components, if it is the shortest one found so far for either.
struct ShortestLink {
  double distance = kFar;
  int from = -1;
  int to = -1;
};

// [a * clusters + b] the shortest link between components a and b, a < b; no nodes for the others.
std::vector<ShortestLink> LinksOfPairs(const std::vector<CircledContour>& nodes,
                                       const std::vector<BoundingBox>& boxes,
                                       const std::vector<int>& component, int clusters,
                                       Budget& budget) {
  Rest rest(&budget);
  std::vector<ShortestLink> best(static_cast<size_t>(clusters) * static_cast<size_t>(clusters));
  for (size_t i = 0; i < nodes.size() && !budget.Exhausted(); ++i) {
    for (size_t j = i + 1; j < nodes.size() && rest(2); ++j) {
      if (component[i] == component[j]) continue;
      const auto [a, b] = std::minmax(component[i], component[j]);
      ShortestLink& link = best[static_cast<size_t>(a * clusters + b)];
      if (boxes[i].DistanceTo(boxes[j]) >= link.distance) continue;
      const double distance = LeastDistance(nodes[i].points, nodes[j].points, budget);
      if (distance >= link.distance) continue;
      link = {distance, static_cast<int>(i), static_cast<int>(j)};
    }
  }
  return best;
}

// The shortest links out of each component. Pairs whose boxes are farther apart than what both
// their components already have are left out.
std::vector<ShortestLink> ShortestLinks(const std::vector<CircledContour>& nodes,
                                        const std::vector<BoundingBox>& boxes,
                                        const std::vector<int>& component, Budget& budget) {
  Rest rest(&budget);
  std::vector<ShortestLink> best(nodes.size());
  for (size_t i = 0; i < nodes.size() && !budget.Exhausted(); ++i) {
    for (size_t j = i + 1; j < nodes.size() && rest(2); ++j) {
      if (component[i] == component[j]) continue;
      ShortestLink& of_i = best[static_cast<size_t>(component[i])];
      ShortestLink& of_j = best[static_cast<size_t>(component[j])];
      if (boxes[i].DistanceTo(boxes[j]) >= std::max(of_i.distance, of_j.distance)) continue;
      const ShortestLink link{LeastDistance(nodes[i].points, nodes[j].points, budget),
                              static_cast<int>(i), static_cast<int>(j)};
      if (link.distance < of_i.distance) of_i = link;
      if (link.distance < of_j.distance) of_j = link;
    }
  }
  return best;
}

// Links the components as a tree. Boruvka's rounds of the minimum spanning tree, which single
// linkage builds link by link: the shortest link out of any component is always part of it. Ties
// could close a ring within one round, so components are looked at again before each link.
void LinkAsTree(const std::vector<CircledContour>& nodes, const std::vector<BoundingBox>& boxes,
                Neighborhood& neighborhood, Budget& budget) {
  while (!budget.Exhausted()) {
    std::vector<int> component = neighborhood.Components();
    if (*std::max_element(component.begin(), component.end()) == 0) return;
    for (const ShortestLink& link : ShortestLinks(nodes, boxes, component, budget)) {
      if (link.from < 0) continue;
      const int joined = component[static_cast<size_t>(link.from)];
      const int other = component[static_cast<size_t>(link.to)];
      if (joined == other) continue;
      neighborhood.Link(link.from, link.to);
      std::replace(component.begin(), component.end(), other, joined);
    }
  }
}

}  // namespace

CircledContour CircleOf(const Path& contour, double spacing_mm) {
  const BoundingBox box(PointsAt(contour, EntryVertices(contour)));
  return {PointsAt(contour, SpacedPoints(contour, spacing_mm)), box.center(), box.shorter_side()};
}

Neighborhood GrowCircles(const std::vector<CircledContour>& contours, Point origin,
                         const NeighborhoodOptions& options, Budget& budget) {
  const std::vector<CircledContour> nodes = WithOrigin(contours, origin);
  const std::vector<BoundingBox> boxes = BoxesOf(nodes);
  BoundingBox area;
  for (const BoundingBox& box : boxes) {
    area.Add(box.low());
    area.Add(box.high());
  }
  Neighborhood neighborhood(static_cast<int>(nodes.size()));
  for (size_t node = 0; node < nodes.size() && !budget.ExhaustedNow(); ++node) {
    const CircledContour& circle = nodes[node];
    const double first =
        options.first_radius_mm > 0 ? options.first_radius_mm : circle.shorter_side_mm;
    double radius =
        RadiusReaching(area.FarthestCornerDistance(circle.center), first, options.step_mm);
    NearestContours nearest(nodes, boxes, node, budget);
    for (int met = 1; !nearest.empty(); ++met) {
      const auto [neighbor, distance] = nearest.Next();
      if (distance > radius) break;
      neighborhood.Link(static_cast<int>(node), neighbor);
      if (met == options.neighbors) radius = RadiusReaching(distance, first, options.step_mm);
    }
  }
  return neighborhood;
}

void LinkClusters(const std::vector<CircledContour>& contours, Point origin,
                  Neighborhood& neighborhood, Budget& budget) {
  const std::vector<CircledContour> nodes = WithOrigin(contours, origin);
  const std::vector<BoundingBox> boxes = BoxesOf(nodes);
  const std::vector<int> component = neighborhood.Components();
  const int clusters = *std::max_element(component.begin(), component.end()) + 1;
  if (clusters == 1) return;
  if (clusters > kMostPairedClusters) return LinkAsTree(nodes, boxes, neighborhood, budget);
  for (const ShortestLink& link : LinksOfPairs(nodes, boxes, component, clusters, budget)) {
    if (link.from >= 0) neighborhood.Link(link.from, link.to);
  }
}

Neighborhood IslandNeighborhood(const IslandLayout& layout, const std::vector<int>& contours,
                                const Neighborhood& neighborhood) {
  Neighborhood islands(static_cast<int>(layout.islands.size()));
  const auto island_of = [&](int node) {
    return layout.island_of[static_cast<size_t>(contours[static_cast<size_t>(node)])];
  };
  const int count = static_cast<int>(contours.size());
  for (int node = 0; node < count; ++node) {
    for (const int next : neighborhood.of(node)) {
      if (next < count) islands.Link(island_of(node), island_of(next));
    }
  }
  return islands;
}

}  // namespace traverse
