#include "engine/cost/neighbor_lists.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/geometry/bounding_box.h"

namespace traverse {
namespace {

using Member = NeighborLists::Member;

double SquaredDistance(Point a, Point b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

Point NearestOf(absl::Span<const Point> points, Point p) {
  Point nearest = points[0];
  double least = SquaredDistance(nearest, p);
  for (const Point point : points) {
    const double squared = SquaredDistance(point, p);
    if (squared >= least) continue;
    least = squared;
    nearest = point;
  }
  return nearest;
}

struct Sample {
  Point point;
  Member member;
};

// About kSamples points spread evenly over a group, of which neighbors are looked for.
struct Owned {
  Owned(absl::Span<const Point> group, Member group_member) : member(group_member) {
    const size_t n = group.size();
    const size_t count = std::min(n, NeighborLists::kSamples);
    points.reserve(count);
    for (size_t i = 0; i < count; ++i) points.push_back(group[i * n / count]);
    box = BoundingBox(points);
  }

  Member member;
  std::vector<Point> points;
  BoundingBox box;
};

// The nearest members found so far, nearest first.
class Nearest {
 public:
  explicit Nearest(int count) : limit_(static_cast<size_t>(count)) { list_.reserve(limit_ + 1); }

  void Clear() { list_.clear(); }

  // Squared distances from here on are of no interest.
  double bound() const {
    return list_.size() < limit_ ? std::numeric_limits<double>::infinity() : list_.back().squared;
  }

  // `place`: of the group's point that is so far away.
  void Offer(int group, double squared, Point place) {
    if (squared >= bound()) return;
    const auto known = std::find_if(list_.begin(), list_.end(),
                                    [group](const Item& item) { return item.group == group; });
    if (known != list_.end()) {
      if (squared >= known->squared) return;
      list_.erase(known);
    } else if (list_.size() == limit_) {
      list_.pop_back();
    }
    const auto after = std::find_if(list_.begin(), list_.end(), [&](const Item& item) {
      return squared < item.squared || (squared == item.squared && group < item.group);
    });
    list_.insert(after, Item{squared, group, place});
  }

  struct Item {
    double squared;  // of the distance in mm
    int group;
    Point place;
  };
  const std::vector<Item>& list() const { return list_; }

 private:
  size_t limit_;
  std::vector<Item> list_;
};

// A tree of bounding boxes over samples.
class SampleTree {
 public:
  explicit SampleTree(std::vector<Sample> samples) : samples_(std::move(samples)) {
    if (!samples_.empty()) Build(0, samples_.size());
  }

  // Offers every sample of another owner that may be among the nearest.
  void Query(const Owned& own, Nearest& nearest) const {
    if (!nodes_.empty()) Visit(0, own, nearest);
  }

 private:
  static constexpr size_t kLeafSize = 8;

  struct Node {
    BoundingBox box;
    size_t begin = 0;
    size_t end = 0;
    size_t right = 0;  // the second child; the first one follows the node; 0: a leaf
  };

  size_t Build(size_t begin, size_t end) {
    const size_t index = nodes_.size();
    nodes_.push_back(Node{{}, begin, end, 0});
    BoundingBox box;
    for (size_t i = begin; i < end; ++i) box.Add(samples_[i].point);
    nodes_[index].box = box;
    if (end - begin <= kLeafSize) return index;
    const size_t middle = begin + (end - begin) / 2;
    const bool by_x = box.width() > box.height();
    const auto at = [this](size_t i) { return samples_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [by_x](const Sample& a, const Sample& b) {
      return by_x ? a.point.x < b.point.x : a.point.y < b.point.y;
    });
    Build(begin, middle);
    const size_t right = Build(middle, end);
    nodes_[index].right = right;
    return index;
  }

  void Visit(size_t index, const Owned& own, Nearest& nearest) const {
    const Node& node = nodes_[index];
    if (node.right == 0) {
      VisitLeaf(node, own, nearest);
      return;
    }
    size_t near = index + 1;
    size_t far = node.right;
    double near_mm = nodes_[near].box.DistanceTo(own.box);
    double far_mm = nodes_[far].box.DistanceTo(own.box);
    // Where both boxes meet the group's, its middle tells which is nearer.
    const auto to_middle = [&](size_t child) {
      return nodes_[child].box.SquaredDistanceTo(own.box.center());
    };
    if (far_mm < near_mm || (far_mm == near_mm && to_middle(far) < to_middle(near))) {
      std::swap(near, far);
      std::swap(near_mm, far_mm);
    }
    if (near_mm * near_mm < nearest.bound()) Visit(near, own, nearest);
    if (far_mm * far_mm < nearest.bound()) Visit(far, own, nearest);
  }

  void VisitLeaf(const Node& node, const Owned& own, Nearest& nearest) const {
    for (size_t i = node.begin; i < node.end; ++i) {
      const Sample& there = samples_[i];
      if (there.member.owner == own.member.owner) continue;
      if (own.box.SquaredDistanceTo(there.point) >= nearest.bound()) continue;
      double least = std::numeric_limits<double>::infinity();
      for (const Point here : own.points) {
        const double squared = SquaredDistance(here, there.point);
        least = squared < least ? squared : least;
      }
      nearest.Offer(there.member.group, least, there.point);
    }
  }

  std::vector<Sample> samples_;
  std::vector<Node> nodes_;
};

}  // namespace

NeighborLists::NeighborLists(const PointGroups& groups) : groups_(groups) {}

void NeighborLists::FindAmong(absl::Span<const Member> members, int count, Budget& budget) {
  std::vector<Owned> owned;
  std::vector<Sample> samples;
  for (const Member& member : members) {
    if (groups_.of(member.group).empty()) continue;
    owned.emplace_back(groups_.of(member.group), member);
    for (const Point point : owned.back().points) samples.push_back({point, member});
  }
  const SampleTree tree(std::move(samples));
  Nearest nearest(count);
  for (const Owned& own : owned) {
    if (budget.Exhausted()) return;
    nearest.Clear();
    tree.Query(own, nearest);
    const int from = own.member.group;
    for (const Nearest::Item& item : nearest.list()) {
      const double squared = Refine(from, item.group, item.place, item.squared);
      found_.push_back({from, {item.group, static_cast<float>(std::sqrt(squared))}});
    }
  }
}

// From the point found to the nearest one of the whole group, and back: as the points of a sample
// are near the nearest ones, this is nearly always exact.
double NeighborLists::Refine(int from, int to, Point place, double squared) const {
  const absl::Span<const Point> here = groups_.of(from);
  const absl::Span<const Point> there = groups_.of(to);
  if (here.size() <= kSamples && there.size() <= kSamples) return squared;
  const Point near = NearestOf(here, place);
  return std::min(squared, SquaredDistance(near, NearestOf(there, near)));
}

void NeighborLists::Seal() {
  std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) {
    if (a.from != b.from) return a.from < b.from;
    if (a.neighbor.distance_mm != b.neighbor.distance_mm) {
      return a.neighbor.distance_mm < b.neighbor.distance_mm;
    }
    return a.neighbor.group < b.neighbor.group;
  });
  first_.assign(static_cast<size_t>(groups_.size()) + 1, 0);
  for (const Found& found : found_) ++first_[static_cast<size_t>(found.from) + 1];
  for (size_t g = 1; g < first_.size(); ++g) first_[g] += first_[g - 1];
  neighbors_.reserve(found_.size());
  for (const Found& found : found_) neighbors_.push_back(found.neighbor);
  found_ = {};
}

}  // namespace traverse
