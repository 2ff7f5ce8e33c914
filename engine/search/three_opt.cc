#include "engine/search/three_opt.h"

#include <algorithm>
#include <array>
#include <utility>

namespace traverse {
namespace {

using Kind = SegmentMove::Kind;
using Neighbor = NeighborLists::Neighbor;

// Three cuts leave ... p | B | C | q ...; their ends in the order of the route are numbered from 0:
// p, B's first, B's last, C's first, C's last, q. Joins are given as mate[end] = end.
constexpr int kNoMove = -1;

constexpr int KindOf(const std::array<int, 6>& mate) {
  if (mate[0] == 2 && mate[1] == 4) return static_cast<int>(Kind::kReverseBoth);
  if (mate[0] == 3 && mate[4] == 1) return static_cast<int>(Kind::kExchange);
  if (mate[0] == 3 && mate[4] == 2) return static_cast<int>(Kind::kExchangeReverseFirst);
  if (mate[0] == 4 && mate[3] == 1) return static_cast<int>(Kind::kExchangeReverseSecond);
  return kNoMove;
}

// The move that joins t2 with t3, t4 with t5 and t6 with t1, by the ranks of the first and the
// second cut among the three and by which of t1, t3 and t5 are right of their cuts.
using MoveTable = std::array<std::array<std::array<int, 8>, 3>, 3>;

constexpr MoveTable MakeMoveTable() {
  MoveTable table{};
  for (int rank1 = 0; rank1 < 3; ++rank1) {
    for (int rank2 = 0; rank2 < 3; ++rank2) {
      for (int right = 0; right < 8; ++right) {
        int& kind = table[static_cast<size_t>(rank1)][static_cast<size_t>(rank2)]
                         [static_cast<size_t>(right)];
        kind = kNoMove;
        if (rank1 == rank2) continue;
        const int rank3 = 3 - rank1 - rank2;
        const int r1 = right & 1;
        const int r3 = right >> 1 & 1;
        const int r5 = right >> 2;
        std::array<int, 6> mate{};
        const auto join = [&mate](int a, int b) {
          mate[static_cast<size_t>(a)] = b;
          mate[static_cast<size_t>(b)] = a;
        };
        join(2 * rank1 + 1 - r1, 2 * rank2 + r3);
        join(2 * rank2 + 1 - r3, 2 * rank3 + r5);
        join(2 * rank3 + 1 - r5, 2 * rank1 + r1);
        kind = KindOf(mate);
      }
    }
  }
  return table;
}

constexpr MoveTable kMoveTable = MakeMoveTable();

// Whether a move may cost less than `most`: for most moves this can be said without a square root.
struct LengthCost {
  static constexpr bool kHasWalls = false;
  double OfLength(double length_mm) const { return length_mm; }
  double operator()(Point a, Point b) const { return Distance(a, b); }
  bool MayBeWithin(Point a, Point b, double most) const {
    const double dx = a.x - b.x;
    const double dy = a.y - b.y;
    return most > 0 && dx * dx + dy * dy < most * most;
  }
};

struct TimeCost {
  static constexpr bool kHasWalls = false;
  double OfLength(double length_mm) const { return cost.OfLength(length_mm); }
  double operator()(Point a, Point b) const { return cost.Base(a, b); }
  bool MayBeWithin(Point a, Point b, double most) const {
    return most > 0 && cost.Base(a, b) < most;
  }

  const TravelCost& cost;
};

// A length ignores walls, but gives the least that the move costs; the true cost is only asked for
// if that does not rule the move out.
struct WallsCost {
  static constexpr bool kHasWalls = true;
  double AtLeast(Point a, Point b) const { return cost.Base(a, b); }
  double operator()(Point a, Point b) const { return cost(a, b); }
  bool MayBeWithin(Point a, Point b, double most) const {
    return most > 0 && cost.Base(a, b) < most;
  }

  const TravelCost& cost;
};

}  // namespace

ThreeOpt::End ThreeOpt::EndAt(int leaf, bool right) const {
  return End{leaf, right, right ? at_.in[leaf] : at_.out[leaf]};
}

ThreeOpt::Cut ThreeOpt::CutAt(const End& end) const {
  const int position = at_.position[end.leaf] - (end.right ? 1 : 0);
  return Cut{position, at_.step_cost[position]};
}

ThreeOpt::End ThreeOpt::OtherEnd(const Cut& cut, const End& end) const {
  return EndAt(at_.leaf[end.right ? cut.position : cut.position + 1], !end.right);
}

// The side of a cut at which the end of an open path that `group` is can be.
bool ThreeOpt::RightOf(int group, int leaf) const {
  const bool backwards = state_.entry(leaf) != state_.entries().first(leaf);
  return (group % 2 == 1) == backwards;
}

// Whether `group` is the one that its leaf shows at this side of the cut: any vertex of a contour,
// but only one end of an open path.
bool ThreeOpt::IsEnd(int group, const End& end) const {
  return !state_.entries().open(end.leaf) || RightOf(group, end.leaf) == end.right;
}

absl::Span<const Neighbor> ThreeOpt::NeighborsOf(const End& end, int breadth) const {
  if (end.leaf >= state_.tree().path_count()) return {};
  const int first_end = EndGroups::GroupOf(end.leaf, 0);
  const auto list = neighbors_.of(IsEnd(first_end, end) ? first_end : first_end + 1);
  return list.subspan(0, std::min(list.size(), static_cast<size_t>(breadth)));
}

template <typename Cost>
double ThreeOpt::Join(const End& a, const End& b, const Cost& cost) const {
  return state_.IsFree(a.leaf) || state_.IsFree(b.leaf) ? 0 : cost(a.point, b.point);
}

// Neighbors from here on cost `limit` or more; negative if all do.
double ThreeOpt::LimitMm(double limit) const {
  return limit <= 0 ? -1 : state_.cost().LongestWithin(limit);
}

void ThreeOpt::Search(int t1, bool forward, double debt, bool wants_open) {
  wants_open_ = wants_open;
  if (state_.cost().is_length()) {
    SearchFirst(t1, forward, debt, LengthCost());
  } else if (state_.cost().has_walls()) {
    SearchFirst(t1, forward, debt, WallsCost{state_.cost()});
  } else {
    SearchFirst(t1, forward, debt, TimeCost{state_.cost()});
  }
}

template <typename Cost>
void ThreeOpt::SearchFirst(int t1, bool forward, double debt, const Cost& cost) {
  found_.clear();
  open_ = Open();
  t1_ = EndAt(t1, !forward);
  cut1_ = CutAt(t1_);
  t2_ = OtherEnd(cut1_, t1_);
  gain0_ = cut1_.cost - debt;
  const double limit_mm = LimitMm(gain0_ + options_.first_slack * Radius(t2_.leaf));
  for (const Neighbor& neighbor : NeighborsOf(t2_, options_.first_breadth)) {
    if (neighbor.distance_mm >= limit_mm) break;
    const int leaf = EndGroups::LeafOf(neighbor.group);
    if (state_.entries().open(leaf)) {
      const End t3 = EndAt(leaf, RightOf(neighbor.group, leaf));
      SearchSecond(t3, CostTo(t2_, t3, neighbor, cost), cost);
    } else {
      const double joined = cost(t2_.point, at_.in[leaf]);
      SearchSecond(EndAt(leaf, false), joined, cost);
      SearchSecond(EndAt(leaf, true), joined, cost);
    }
  }
  if (t2_.leaf >= state_.tree().path_count()) return;
  for (const End& t3 : {EndAt(state_.tree().start(), false), EndAt(state_.tree().finish(), true)}) {
    SearchSecond(t3, Join(t2_, t3, cost), cost);
  }
}

// Between two ends of open paths, the cost of the move is that of the neighbors' distance.
template <typename Cost>
double ThreeOpt::CostTo(const End& from, const End& to, const Neighbor& neighbor,
                        const Cost& cost) const {
  if constexpr (Cost::kHasWalls) {
    return cost(from.point, to.point);
  } else {
    return state_.entries().open(from.leaf) ? cost.OfLength(neighbor.distance_mm)
                                            : cost(from.point, to.point);
  }
}

// What joining the ends costs at least: with walls as if there were none.
template <typename Cost>
double ThreeOpt::LeastOf(const End& a, const End& b, const Cost& cost) const {
  if constexpr (Cost::kHasWalls) return cost.AtLeast(a.point, b.point);
  return cost(a.point, b.point);
}

// t2 is joined with t3, at this cost.
template <typename Cost>
void ThreeOpt::SearchSecond(const End& t3, double joined, const Cost& cost) {
  cut2_ = CutAt(t3);
  if (cut2_.position == cut1_.position) return;
  const double gain = gain0_ - joined;
  if (gain + options_.first_slack * (Radius(t2_.leaf) + Radius(t3.leaf)) <= 0) return;
  t3_ = t3;
  t4_ = OtherEnd(cut2_, t3);
  gain1_ = gain + cut2_.cost;
  radii_ = Radius(t1_.leaf) + Radius(t2_.leaf) + Radius(t3_.leaf) + Radius(t4_.leaf);
  const auto [left, right] = std::minmax(cut1_.position, cut2_.position);
  const bool reverses = t2_.right == t3_.right && right > left + 1;
  if (reverses && (!Cost::kHasWalls || MayKeep(t4_, t1_, gain1_, radii_, cost))) {
    const double delta = Join(t4_, t1_, cost) - gain1_;
    Offer({Kind::kReverse, left + 1, left + 1, right}, delta, gain1_, t4_.leaf, radii_);
  }
  SetKinds(left, right);
  const double limit_mm = LimitMm(gain1_ + options_.second_slack * Radius(t4_.leaf));
  for (const Neighbor& neighbor : NeighborsOf(t4_, options_.second_breadth)) {
    if (neighbor.distance_mm >= limit_mm) break;
    const int leaf = EndGroups::LeafOf(neighbor.group);
    const int position = at_.position[leaf];
    if (state_.entries().open(leaf)) {
      const bool right = RightOf(neighbor.group, leaf);
      const int kind = KindAt(position, right);
      if (kind == kNoMove) continue;
      const End t5 = EndAt(leaf, right);
      const double joined =
          Cost::kHasWalls ? LeastOf(t4_, t5, cost) : CostTo(t4_, t5, neighbor, cost);
      SearchThird(t5, kind, joined, cost);
    } else {
      const int kind_left = KindAt(position, false);
      const int kind_right = KindAt(position, true);
      if (kind_left == kNoMove && kind_right == kNoMove) continue;
      const End t5 = EndAt(leaf, false);
      const double joined = LeastOf(t4_, t5, cost);
      if (kind_left != kNoMove) SearchThird(t5, kind_left, joined, cost);
      if (kind_right != kNoMove) SearchThird({leaf, true, t5.point}, kind_right, joined, cost);
    }
  }
  if (t4_.leaf >= state_.tree().path_count()) return;
  for (const End& t5 : {EndAt(state_.tree().start(), false), EndAt(state_.tree().finish(), true)}) {
    const double joined = Join(t4_, t5, cost);
    const int kind = KindAt(at_.position[t5.leaf], t5.right);
    if (gain1_ - joined > 0 && kind != kNoMove) SearchThird(t5, kind, joined, cost);
  }
}

// Notes what a third cut makes of the first two, which are at `left` and `right`.
void ThreeOpt::SetKinds(int left, int right) {
  left_ = left;
  right_ = right;
  for (size_t place = 0; place < 3; ++place) {  // of the third cut among the three
    const bool first_is_left = cut1_.position == left;
    const size_t least = first_is_left ? 0 : 1;
    const size_t rank1 = place <= least ? least + 1 : least;
    const size_t rank2 = 3 - rank1 - place;
    const size_t sides = static_cast<size_t>(t1_.right + 2 * t3_.right);
    kinds_[0][place] = kMoveTable[rank1][rank2][sides];
    kinds_[1][place] = kMoveTable[rank1][rank2][sides + 4];
  }
}

// The move that a third cut makes on one side of the visit at `position`. Most make none, which is
// known before any distance is.
int ThreeOpt::KindAt(int position, bool right) const {
  const int at = position - right;
  if (at == left_ || at == right_) return kNoMove;
  return kinds_[right][(at > left_) + (at > right_)];
}

// t4 is joined with t5 at cost `joined`, or at least that if there are walls; `kind` is of the
// move.
template <typename Cost>
void ThreeOpt::SearchThird(const End& t5, int kind, double joined, const Cost& cost) {
  const int at = at_.position[t5.leaf] - t5.right;
  const int t6_leaf = at_.leaf[t5.right ? at : at + 1];
  const End t6{t6_leaf, !t5.right, t5.right ? at_.out[t6_leaf] : at_.in[t6_leaf]};
  const double radii = radii_ + Radius(t6.leaf);
  double gain = gain1_ - joined + at_.step_cost[at];
  if (Cost::kHasWalls) {
    if (!MayKeep(t6, t1_, gain, radii, cost)) return;
    gain = gain1_ - Join(t4_, t5, cost) + at_.step_cost[at];
  }
  if (!MayKeep(t6, t1_, gain, radii, cost)) return;
  const double last = Join(t6, t1_, cost);
  const int first = std::min(at, left_);
  const int middle = std::clamp(at, left_, right_);
  const int end = std::max(at, right_);
  Offer({static_cast<Kind>(kind), first + 1, middle + 1, end}, last - gain, gain, t6.leaf, radii);
}

// Whether Offer() may accept a move with this gain before `from` is joined with `to`.
template <typename Cost>
bool ThreeOpt::MayKeep(const End& from, const End& to, double gain, double radii,
                       const Cost& cost) const {
  if (wants_open_ && gain > open_.gain) return true;
  const double most = LeastRejected(radii) + gain;
  if (state_.IsFree(from.leaf) || state_.IsFree(to.leaf)) return most > 0;
  return cost.MayBeWithin(from.point, to.point, most);
}

// `radii`: of the contours at the cuts.
void ThreeOpt::Offer(const SegmentMove& move, double delta, double gain, int last_leaf,
                     double radii) {
  const bool continues =
      wants_open_ && gain > open_.gain && move.last - move.first < options_.longest_trial;
  const bool keeps = delta < LeastRejected(radii);
  if ((!continues && !keeps) || !state_.Allows(move)) return;
  if (continues) open_ = Open{move, delta, gain, last_leaf};
  if (!keeps) return;
  if (found_.size() == options_.keep) found_.pop_back();
  const auto place = std::upper_bound(found_.begin(), found_.end(), delta,
                                      [](double d, const Found& f) { return d < f.delta; });
  found_.insert(place, Found{move, delta});
}

}  // namespace traverse
