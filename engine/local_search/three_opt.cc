#include "engine/local_search/three_opt.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "engine/base/tolerances.h"

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

}  // namespace

ThreeOpt::End ThreeOpt::EndAt(int leaf, bool right) const {
  return End{leaf, right, right ? state_.in(leaf) : state_.out(leaf)};
}

ThreeOpt::Cut ThreeOpt::CutAt(const End& end) const {
  const int position = state_.position(end.leaf) - (end.right ? 1 : 0);
  return Cut{position, state_.StepCost(position)};
}

ThreeOpt::End ThreeOpt::OtherEnd(const Cut& cut, const End& end) const {
  return EndAt(state_.leaf_at(end.right ? cut.position : cut.position + 1), !end.right);
}

// Whether `group` is what its leaf shows at this side of the cut: any vertex of a contour, but only
// one end of an open path.
bool ThreeOpt::IsEnd(int group, const End& end) const {
  const LeafEntries& entries = state_.entries();
  if (!entries.open(end.leaf)) return true;
  const bool backwards = state_.entry(end.leaf) != entries.first(end.leaf);
  return group % 2 == (end.right == backwards ? 1 : 0);
}

absl::Span<const Neighbor> ThreeOpt::NeighborsOf(const End& end, int breadth) const {
  if (end.leaf >= state_.tree().path_count()) return {};
  const int first_end = EndGroups::GroupOf(end.leaf, 0);
  const auto list = neighbors_.of(IsEnd(first_end, end) ? first_end : first_end + 1);
  return list.subspan(0, std::min(list.size(), static_cast<size_t>(breadth)));
}

double ThreeOpt::Cost(const End& a, const End& b) const {
  const int finish = state_.tree().finish();
  if ((a.leaf == finish || b.leaf == finish) && !state_.has_finish()) return 0;
  return state_.cost()(a.point, b.point);
}

void ThreeOpt::Search(int t1, bool forward, double debt) {
  found_.clear();
  open_ = Open();
  t1_ = EndAt(t1, !forward);
  cut1_ = CutAt(t1_);
  t2_ = OtherEnd(cut1_, t1_);
  gain0_ = cut1_.cost - debt;
  for (const Neighbor& neighbor : NeighborsOf(t2_, options_.first_breadth)) {
    const double nearest = state_.cost().OfLength(neighbor.distance_mm);
    if (nearest >= gain0_ + options_.first_slack * Radius(t2_.leaf)) break;
    const int leaf = EndGroups::LeafOf(neighbor.group);
    for (const bool right : {false, true}) {
      const End t3 = EndAt(leaf, right);
      if (IsEnd(neighbor.group, t3)) SearchSecond(t3);
    }
  }
  if (t2_.leaf >= state_.tree().path_count()) return;
  SearchSecond(EndAt(state_.tree().start(), false));
  SearchSecond(EndAt(state_.tree().finish(), true));
}

// t2 is joined with t3.
void ThreeOpt::SearchSecond(const End& t3) {
  cut2_ = CutAt(t3);
  if (cut2_.position == cut1_.position) return;
  const double gain = gain0_ - Cost(t2_, t3);
  if (gain + options_.first_slack * (Radius(t2_.leaf) + Radius(t3.leaf)) <= 0) return;
  t3_ = t3;
  t4_ = OtherEnd(cut2_, t3);
  gain1_ = gain + cut2_.cost;
  if (t2_.right == t3_.right) {
    const auto [left, right] = std::minmax(cut1_.position, cut2_.position);
    if (right > left + 1) {
      Offer({Kind::kReverse, left + 1, left + 1, right}, Cost(t4_, t1_) - gain1_, gain1_, t4_);
    }
  }
  for (const Neighbor& neighbor : NeighborsOf(t4_, options_.second_breadth)) {
    const double nearest = state_.cost().OfLength(neighbor.distance_mm);
    if (nearest >= gain1_ + options_.second_slack * Radius(t4_.leaf)) break;
    const int leaf = EndGroups::LeafOf(neighbor.group);
    for (const bool right : {false, true}) {
      const End t5 = EndAt(leaf, right);
      if (IsEnd(neighbor.group, t5)) SearchThird(t5);
    }
  }
  if (t4_.leaf >= state_.tree().path_count()) return;
  for (const End& t5 : {EndAt(state_.tree().start(), false), EndAt(state_.tree().finish(), true)}) {
    if (gain1_ - Cost(t4_, t5) > 0) SearchThird(t5);
  }
}

// t4 is joined with t5.
void ThreeOpt::SearchThird(const End& t5) {
  const int at1 = cut1_.position;
  const int at2 = cut2_.position;
  const int at3 = state_.position(t5.leaf) - (t5.right ? 1 : 0);
  if (at3 == at1 || at3 == at2) return;
  const size_t rank1 = static_cast<size_t>((at1 > at2) + (at1 > at3));
  const size_t rank2 = static_cast<size_t>((at2 > at1) + (at2 > at3));
  const size_t right = static_cast<size_t>(t1_.right + 2 * t3_.right + 4 * t5.right);
  const int kind = kMoveTable[rank1][rank2][right];
  if (kind == kNoMove) return;
  const Cut cut3{at3, state_.StepCost(at3)};
  const End t6 = OtherEnd(cut3, t5);
  const double gain = gain1_ - Cost(t4_, t5) + cut3.cost;
  const int first = std::min({at1, at2, at3});
  const int last = std::max({at1, at2, at3});
  const int middle = at1 + at2 + at3 - first - last;
  Offer({static_cast<Kind>(kind), first + 1, middle + 1, last}, Cost(t6, t1_) - gain, gain, t6);
}

void ThreeOpt::Offer(const SegmentMove& move, double delta, double gain, const End& last_end) {
  const bool continues = gain > open_.gain;
  bool keeps = found_.size() < options_.keep || delta < found_.back().delta;
  if (keeps && delta > -kImprovementTolerance) {
    double radii = Radius(t1_.leaf) + Radius(t2_.leaf) + Radius(t3_.leaf) + Radius(t4_.leaf);
    if (move.segment_count() == 2) {
      radii += Radius(last_end.leaf);
    }
    keeps = delta < options_.slack * radii;
  }
  if ((!continues && !keeps) || !state_.Allows(move)) return;
  if (continues) open_ = Open{move, delta, gain, last_end.leaf};
  if (!keeps) return;
  if (found_.size() == options_.keep) found_.pop_back();
  const auto place = std::upper_bound(found_.begin(), found_.end(), delta,
                                      [](double d, const Found& f) { return d < f.delta; });
  found_.insert(place, Found{move, delta});
}

}  // namespace traverse
