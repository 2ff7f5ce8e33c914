#include "engine/cost/neighbor_lists.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/base/rest.h"
#include "engine/geometry/bounding_box.h"
#include "engine/geometry/float_points.h"

namespace traverse {
namespace {

using Member = NeighborLists::Member;

constexpr size_t kPieceSize = 4;

float Most(float a, float b) { return a > b ? a : b; }
float Least(float a, float b) { return a < b ? a : b; }

// In the floats of a search.
struct Box {
  float low_x = std::numeric_limits<float>::infinity();
  float low_y = std::numeric_limits<float>::infinity();
  float high_x = -std::numeric_limits<float>::infinity();
  float high_y = -std::numeric_limits<float>::infinity();

  void Add(FloatPoint point) { Add(Box{point.x, point.y, point.x, point.y}); }
  void Add(const Box& other) {
    low_x = Least(low_x, other.low_x);
    low_y = Least(low_y, other.low_y);
    high_x = Most(high_x, other.high_x);
    high_y = Most(high_y, other.high_y);
  }

  // Square of the distance to another box.
  float SquaredDistanceTo(const Box& other) const {
    const float dx = Most(Most(low_x - other.high_x, other.low_x - high_x), 0);
    const float dy = Most(Most(low_y - other.high_y, other.low_y - high_y), 0);
    return dx * dx + dy * dy;
  }
  Box center() const {
    const float x = (low_x + high_x) / 2;
    const float y = (low_y + high_y) / 2;
    return {x, y, x, y};
  }
};

// Samples of a group that follow each other.
struct Piece {
  Box box;
  int slot;  // of a member
};

// The nearest members found so far, nearest first.
class Nearest {
 public:
  explicit Nearest(int count) : limit_(static_cast<size_t>(count)) { list_.reserve(limit_); }

  void Clear() { list_.clear(); }

  // Squared distances from here on are of no interest.
  float bound() const {
    return list_.size() < limit_ ? std::numeric_limits<float>::infinity() : list_.back().squared;
  }

  // `there`: the number of the sample of the member that is so far away. REQUIRES: no member twice.
  void Offer(int slot, float squared, size_t there) {
    if (squared >= bound()) return;
    if (list_.size() < limit_) list_.emplace_back();
    size_t place = list_.size() - 1;
    for (; place > 0 && squared < list_[place - 1].squared; --place) {
      list_[place] = list_[place - 1];
    }
    list_[place] = Item{squared, slot, there};
  }

  struct Item {
    float squared = 0;  // of the distance in mm
    int slot = 0;
    size_t there = 0;
  };
  const std::vector<Item>& list() const { return list_; }

 private:
  size_t limit_;
  std::vector<Item> list_;
};

// A tree of bounding boxes over pieces. Not parted any further once the budget is exhausted.
class PieceTree {
 public:
  PieceTree(std::vector<Piece> pieces, Budget& budget)
      : pieces_(std::move(pieces)), rest_(&budget) {
    nodes_.reserve(pieces_.size() / 2 + 1);
    if (!pieces_.empty()) Build(0, pieces_.size());
  }

  // Calls `offer` with the slot of every piece that is not farther from `own` than bound() says.
  template <typename Bound, typename Offer>
  void Query(const Box& own, const Bound& bound, const Offer& offer) const {
    if (!nodes_.empty()) Visit(0, own, bound, offer);
  }

 private:
  static constexpr size_t kLeafSize = 4;

  struct Node {
    Box box;
    size_t begin = 0;
    size_t end = 0;
    size_t right = 0;  // the second child; the first one follows the node; 0: a leaf
  };

  size_t Build(size_t begin, size_t end) {
    const size_t index = nodes_.size();
    nodes_.push_back(Node{{}, begin, end, 0});
    Box box;
    for (size_t i = begin; i < end; ++i) box.Add(pieces_[i].box);
    nodes_[index].box = box;
    if (!rest_(4 * (end - begin)) || end - begin <= kLeafSize) return index;
    const size_t middle = begin + (end - begin) / 2;
    const bool by_x = box.high_x - box.low_x > box.high_y - box.low_y;
    const auto at = [this](size_t i) { return pieces_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [by_x](const Piece& a, const Piece& b) {
      return by_x ? a.box.low_x + a.box.high_x < b.box.low_x + b.box.high_x
                  : a.box.low_y + a.box.high_y < b.box.low_y + b.box.high_y;
    });
    Build(begin, middle);
    const size_t right = Build(middle, end);
    nodes_[index].right = right;
    return index;
  }

  template <typename Bound, typename Offer>
  void Visit(size_t index, const Box& own, const Bound& bound, const Offer& offer) const {
    const Node& node = nodes_[index];
    if (node.right == 0) {
      for (size_t i = node.begin; i < node.end; ++i) {
        if (own.SquaredDistanceTo(pieces_[i].box) < bound()) offer(pieces_[i].slot);
      }
      return;
    }
    size_t near = index + 1;
    size_t far = node.right;
    float near_squared = nodes_[near].box.SquaredDistanceTo(own);
    float far_squared = nodes_[far].box.SquaredDistanceTo(own);
    // Where both boxes meet the group's, its middle tells which is nearer.
    const auto to_middle = [&](size_t child) {
      return nodes_[child].box.SquaredDistanceTo(own.center());
    };
    if (far_squared < near_squared ||
        (far_squared == near_squared && to_middle(far) < to_middle(near))) {
      std::swap(near, far);
      std::swap(near_squared, far_squared);
    }
    if (near_squared < bound()) Visit(near, own, bound, offer);
    if (far_squared < bound()) Visit(far, own, bound, offer);
  }

  std::vector<Piece> pieces_;
  std::vector<Node> nodes_;
  Rest rest_;
};

// The members of one search, in single precision.
class Search {
 public:
  Search(const PointGroups& groups, absl::Span<const Member> members, Budget& budget)
      : groups_(groups), budget_(budget) {
    Rest rest(&budget);
    BoundingBox box;
    for (const Member& member : members) {
      rest(4 + groups.of(member.group).size());
      box.Add(BoundingBox(groups.of(member.group)));
    }
    if (!box.empty()) origin_ = box.center();
    for (const Member& member : members) {
      rest(16 + 4 * groups.of(member.group).size());
      if (!groups.of(member.group).empty()) Add(member);
    }
    stamps_.resize(members_.size(), -1);
  }

  int size() const { return static_cast<int>(members_.size()); }
  const Member& member(int slot) const { return members_[Index(slot)]; }
  PieceTree Tree() { return PieceTree(std::move(pieces_), budget_); }

  // Offers to `nearest` every member of another owner that may be among them.
  void Find(const PieceTree& tree, int slot, Nearest& nearest) {
    const int owner = member(slot).owner;
    const FloatGroups::Group own = samples_.of(Index(slot));
    tree.Query(
        boxes_[Index(slot)], [&] { return nearest.bound(); },
        [&](int other) {
          if (stamps_[Index(other)] == slot || member(other).owner == owner) return;
          stamps_[Index(other)] = slot;
          const NearestPair pair = NearestBetween(own, samples_.of(Index(other)));
          nearest.Offer(other, pair.squared, pair.there);
        });
  }

  // From the sample found to the nearest point of the whole group, and back: as samples are near
  // the nearest points, this is nearly always exact.
  double Refine(int from, const Nearest::Item& item) const {
    const FloatGroups::Group sampled = samples_.of(Index(item.slot));
    const FloatPoint place{sampled.x[item.there], sampled.y[item.there]};
    const FloatGroups::Group here = points_.of(Index(from));
    const size_t near = NearestOf(here, place);
    const size_t there = NearestOf(points_.of(Index(item.slot)), {here.x[near], here.y[near]});
    return Distance(PointOf(from, near), PointOf(item.slot, there));
  }

 private:
  static size_t Index(int i) { return static_cast<size_t>(i); }

  FloatPoint Relative(Point p) const {
    return {static_cast<float>(p.x - origin_.x), static_cast<float>(p.y - origin_.y)};
  }

  // All points of the member, and about kSamples of them spread evenly.
  void Add(const Member& member) {
    const absl::Span<const Point> group = groups_.of(member.group);
    for (const Point point : group) points_.Add(Relative(point));
    points_.Close();
    Box box;
    const size_t count = std::min(group.size(), NeighborLists::kSamples);
    for (size_t i = 0; i < count; ++i) {
      const FloatPoint point = Relative(group[i * group.size() / count]);
      samples_.Add(point);
      if (i % kPieceSize == 0) pieces_.push_back({{}, size()});
      pieces_.back().box.Add(point);
      box.Add(point);
    }
    samples_.Close();
    boxes_.push_back(box);
    members_.push_back(member);
  }

  // After the last one there are only copies of it.
  Point PointOf(int slot, size_t number) const {
    const absl::Span<const Point> group = groups_.of(member(slot).group);
    return group[std::min(number, group.size() - 1)];
  }

  const PointGroups& groups_;
  Budget& budget_;
  Point origin_;
  std::vector<Member> members_;  // [slot] those that have points
  std::vector<Box> boxes_;       // [slot] of the samples
  FloatGroups samples_;          // [slot]
  FloatGroups points_;           // [slot]
  std::vector<int> stamps_;      // [slot] the query that looked at it last
  std::vector<Piece> pieces_;
};

#ifndef NDEBUG
bool NamesGroupsOnce(absl::Span<const NeighborLists::Member> members) {
  std::vector<int> groups;
  for (const NeighborLists::Member& member : members) groups.push_back(member.group);
  std::sort(groups.begin(), groups.end());
  return std::adjacent_find(groups.begin(), groups.end()) == groups.end();
}
#endif

}  // namespace

NeighborLists::NeighborLists(const PointGroups& groups) : groups_(groups) {}

void NeighborLists::FindAmong(absl::Span<const Member> members, int count, Budget& budget) {
  assert(first_.empty());  // not sealed
  assert(NamesGroupsOnce(members));
  Search search(groups_, members, budget);
  const PieceTree tree = search.Tree();
  Nearest nearest(count);
  for (int slot = 0; slot < search.size(); ++slot) {
    if (budget.Exhausted()) return;
    nearest.Clear();
    search.Find(tree, slot, nearest);
    for (const Nearest::Item& item : nearest.list()) {
      const double distance_mm = search.Refine(slot, item);
      Note({search.member(slot).group, {search.member(item.slot).group, distance_mm}});
    }
  }
}

void NeighborLists::Note(const Found& found) {
  if (found_.empty() || found_.back().size() == kBlock) {
    found_.emplace_back();
    if (found_.size() > 1) found_.back().reserve(kBlock);
  }
  found_.back().push_back(found);
}

void NeighborLists::Seal(Budget* budget) {
  Rest rest(budget);
  if (budget != nullptr && budget->was_exhausted()) {
    first_.assign(static_cast<size_t>(groups_.size()) + 1, 0);
    found_ = {};
    return;
  }
  first_.assign(static_cast<size_t>(groups_.size()) + 2, 0);
  if (found_.size() > 1) neighbors_.reserve(found_.size() * kBlock);
  for (const std::vector<Found>& block : found_) {
    rest(2 * block.size());
    for (const Found& found : block) ++first_[static_cast<size_t>(found.from) + 2];
    neighbors_.resize(neighbors_.size() + block.size());
  }
  for (size_t g = 2; g < first_.size(); ++g) first_[g] += first_[g - 1];
  for (std::vector<Found>& block : found_) {
    rest(4 * block.size());
    for (const Found& found : block) {
      const size_t place = static_cast<size_t>(first_[static_cast<size_t>(found.from) + 1]++);
      neighbors_[place] = found.neighbor;
    }
    block = {};
  }
  first_.pop_back();
  found_ = {};
  for (size_t g = 0; g + 1 < first_.size(); ++g) {
    rest(4 + 4 * static_cast<size_t>(first_[g + 1] - first_[g]));
    std::sort(neighbors_.begin() + first_[g], neighbors_.begin() + first_[g + 1],
              [](const Neighbor& a, const Neighbor& b) {
                return a.distance_mm != b.distance_mm ? a.distance_mm < b.distance_mm
                                                      : a.group < b.group;
              });
  }
}

}  // namespace traverse
