#include "client/gcode/verify/match/link_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// By what two words in inches are rounded.
constexpr Micro kAmountSlack = 600;

// So many parts that differ in amounts and heights alone are remembered; no slicer has as many.
constexpr size_t kMostAlike = 256;

// So many ways to cut a link are tried, and remembered if none is right. Slicers' links have fewer
// runs of travel moves, and fewer moves where two paths meet.
constexpr size_t kMostCuts = 4;

int64_t Um(double mm) { return std::llround(mm * 1000); }

bool IsAtTheSameHeight(const PartStep& a, const PartStep& b) {
  return std::abs(a.above_um - b.above_um) <= kSlackUm ||
         std::abs(a.behind_um - b.behind_um) <= kSlackUm;
}

bool IsLike(const PartStep& known, const PartStep& step) {
  return IsAtTheSameHeight(known, step) &&
         std::abs(known.filament - step.filament) <= kAmountSlack &&
         std::abs(known.pulled - step.pulled) <= kAmountSlack &&
         step.length_mm <= known.length_mm + kSamePointMm;
}

bool IsSame(const PartStep& known, const PartStep& step) {
  return IsLike(known, step) && known.above_um == step.above_um &&
         known.behind_um == step.behind_um;
}

// Above the next path, and down again.
bool IsOfLift(const PartStep& step) {
  return step.kind == MoveKind::kDown || (step.kind == MoveKind::kUp && step.behind_um > kSlackUm);
}

uint64_t FormOf(const LinkPart& part) {
  uint64_t digest = part.role + (part.in_place ? 3u : 0u);
  for (const PartStep& step : part.steps) digest = Mix(digest, static_cast<uint64_t>(step.kind));
  return digest;
}

uint64_t KeyOf(const LinkPart& part) {
  uint64_t digest = FormOf(part);
  for (const PartStep& step : part.steps) {
    digest = MixAll(digest, step.firmware, step.feed, step.tool, step.spiral);
  }
  return digest;
}

template <typename Like>
bool HasAny(const std::vector<LinkPart>& parts, const LinkPart& part, const Like& like) {
  return std::ranges::any_of(parts, [&](const LinkPart& known) {
    return std::ranges::equal(known.steps, part.steps, like);
  });
}

}  // namespace

LinkCutter::LinkCutter(const TraceChunk& chunk, uint32_t link, uint32_t skipped,
                       const LayerPair* known_in)
    : known_in_(known_in) {
  const bool last = link == chunk.paths.size();
  const uint32_t fixed = last ? 0 : chunk.links[link].fixed;
  for (const TraceMove& move : chunk.MovesOf(link, std::max(skipped, fixed))) {
    if (last && move.z_from_mm != move.z_to_mm) break;
    if (move.in_print && !move.IsNothing(kLeastMoveMm)) moves_.push_back(&move);
  }
  if (moves_.empty()) return;
  from_mm_ = moves_.front()->z_from_mm;
  to_mm_ = last ? from_mm_ : chunk.paths[link].z_mm;
  level_ = std::abs(from_mm_ - to_mm_) <= kOneHeightMm;
  if (to_mm_ > from_mm_) DropRisesToLayer(to_mm_ + kOneHeightMm);
}

// The head may go up to a higher path at any time between a retraction and its prime.
void LinkCutter::DropRisesToLayer(double top_mm) {
  const auto primes = [](const TraceMove* move) { return move->kind == MoveKind::kPriming; };
  const auto pulls = [](const TraceMove* move) { return Retracts(*move); };
  const auto first_prime = std::ranges::find_if(moves_, primes);
  const auto last_pull = std::find_if(moves_.rbegin(), moves_.rend(), pulls).base();
  const auto end = std::max(last_pull, first_prime);
  moves_.erase(std::remove_if(last_pull, end,
                              [top_mm](const TraceMove* move) {
                                return move->kind == MoveKind::kUp && move->z_to_mm <= top_mm;
                              }),
               end);
}

bool LinkCutter::GoesOn(size_t i) const {
  return i + 1 < moves_.size() && Travels(i) && Travels(i + 1) &&
         moves_[i]->open == moves_[i + 1]->open;
}

std::vector<LinkPart> LinkCutter::Parts() const {
  size_t longest = moves_.size();
  for (size_t i = 0; i < moves_.size(); ++i) {
    const bool longer =
        longest == moves_.size() || moves_[i]->length_mm() > moves_[longest]->length_mm();
    if (Travels(i) && longer) longest = i;
  }
  while (longest > 0 && GoesOn(longest - 1)) --longest;
  return CutAt(longest);
}

std::vector<std::vector<LinkPart>> LinkCutter::AllParts() const {
  std::vector<std::vector<LinkPart>> cuts;
  for (size_t i = 0; i < moves_.size() && cuts.size() < kMostCuts; ++i) {
    if (Travels(i) && (i == 0 || !GoesOn(i - 1))) cuts.push_back(CutAt(i));
  }
  if (!cuts.empty()) return cuts;
  cuts.push_back(CutAt(moves_.size()));
  const bool wipes = std::ranges::any_of(
      moves_, [](const TraceMove* move) { return move->kind == MoveKind::kWipe; });
  if ((level_ && !wipes) || moves_.size() > 2 * kMostCuts) return cuts;
  // Two paths that meet, one above the other, or where the wipe of the one ends.
  LinkCutter flat = *this;
  flat.DropRisesToLayer(HUGE_VAL);
  for (const LinkCutter& cutter : {*this, flat}) {
    for (size_t i = 0; i <= cutter.moves_.size(); ++i) cuts.push_back(cutter.CutAt(i));
  }
  return cuts;
}

// At the travel that begins with move `first`, or right before it.
std::vector<LinkPart> LinkCutter::CutAt(size_t first) const {
  size_t leaves = 0;  // by short moves, before it retracts: their place is another rule
  double mm = 0;
  while (leaves < first && Travels(leaves) && moves_[leaves]->open) {
    mm += moves_[leaves++]->length_mm();
  }
  if (mm > kLongestDepartureMm) leaves = 0;
  size_t end = first;
  if (first < moves_.size() && Travels(first)) {
    while (GoesOn(end)) ++end;
    ++end;
  }
  std::vector<LinkPart> parts;
  AddSpeeds(0, leaves, parts);
  AddSpeeds(first, end, parts);
  AddPart(LinkPart::kDeparture, leaves, first, parts);
  AddPart(LinkPart::kArrival, end, moves_.size(), parts);
  return parts;
}

// With so much filament pulled back before it.
PartStep LinkCutter::StepOf(size_t i, Micro pulled) const {
  const TraceMove& move = *moves_[i];
  PartStep step;
  step.kind = move.kind;
  step.firmware = move.firmware;
  if (!move.firmware && move.kind != MoveKind::kWipe) step.feed = move.feed;
  if (move.filament != 0) step.tool = move.tool;
  step.spiral = move.kind == MoveKind::kUp ? move.spiral : 0;
  step.filament = move.filament;
  if (move.kind == MoveKind::kPriming) step.pulled = pulled;
  // To a higher path it may lead at any height up to that, and a scarf seam begins lower than where
  // it leads to.
  step.behind_um = std::max<int64_t>(Um(move.z_to_mm - to_mm_), 0);
  step.above_um = to_mm_ >= from_mm_ ? step.behind_um : Um(move.z_to_mm - from_mm_);
  if (move.kind == MoveKind::kTravel && move.open) step.length_mm = move.length_mm();
  return step;
}

void LinkCutter::AddSpeeds(size_t begin, size_t end, std::vector<LinkPart>& parts) const {
  for (size_t i = begin; i < end; ++i) {
    if (moves_[i]->firmware || IsKnown(i)) continue;
    PartStep step;
    step.kind = moves_[i]->kind;
    step.feed = moves_[i]->feed;
    parts.push_back({LinkPart::kSpeed, {step}});
  }
}

void LinkCutter::AddPart(LinkPart::Role role, size_t begin, size_t end,
                         std::vector<LinkPart>& parts) const {
  LinkPart part{role, {}, std::ranges::none_of(moves_, &TraceMove::sideways)};
  Micro pulled = 0;
  for (size_t i = 0; i < begin; ++i) pulled -= moves_[i]->filament;
  for (size_t i = begin; i < end; ++i) {
    const PartStep step = StepOf(i, pulled);
    pulled -= moves_[i]->filament;
    PartStep* last = part.steps.empty() ? nullptr : &part.steps.back();
    const auto follows = [&](MoveKind before, MoveKind kind) {
      return last != nullptr && last->kind == before && step.kind == kind;
    };
    const bool on = follows(MoveKind::kWipe, MoveKind::kWipe) ||
                    follows(MoveKind::kWipe, MoveKind::kRetraction);
    const bool up = follows(MoveKind::kUp, MoveKind::kUp) && last->spiral == step.spiral &&
                    last->feed == step.feed;
    const bool along = follows(MoveKind::kTravel, MoveKind::kTravel) && last->feed == step.feed;
    // How fast a wipe is, and what it leaves to be retracted, depends on its path.
    if (step.kind != MoveKind::kTravel) AddSpeeds(i, i + 1, parts);
    if (on) {
      last->filament += step.filament;
    } else if (up || along) {
      const double before_mm = last->length_mm;
      *last = step;
      last->length_mm += before_mm;
    } else {
      part.steps.push_back(step);
    }
  }
  if (!part.steps.empty()) parts.push_back(std::move(part));
}

void KnownParts::AddAsItIs(const LinkPart& part) {
  forms_.insert(FormOf(part));
  std::vector<LinkPart>& alike = parts_[KeyOf(part)];
  if (alike.size() < kMostAlike && !HasAny(alike, part, IsSame)) alike.push_back(part);
}

void KnownParts::Add(LinkPart part) {
  part.in_place = false;
  AddAsItIs(part);
  bool spirals = false;
  for (PartStep& step : part.steps) spirals |= std::exchange(step.spiral, 0) != 0;
  if (spirals) AddAsItIs(part);
  if (part.role == LinkPart::kSpeed) return;
  // To the height of the next path there is no way up within a layer.
  const auto rises = [](const PartStep& step) {
    return step.kind == MoveKind::kUp && step.behind_um <= kSlackUm;
  };
  const auto stays = std::ranges::find_if_not(part.steps, rises);
  if (stays != part.steps.begin() && stays != part.steps.end()) {
    LinkPart level = part;
    level.steps.assign(stays, part.steps.end());
    AddAsItIs(level);
  }
  part.in_place = true;
  if (std::erase_if(part.steps, IsOfLift) > 0) AddAsItIs(part);
}

void KnownParts::Append(const KnownParts& other) {
  for (const auto& [key, parts] : other.parts_) {
    for (const LinkPart& part : parts) AddAsItIs(part);
  }
}

bool KnownParts::Has(const LinkPart& part) const {
  if (HasAsItIs(part)) return true;
  LinkPart along = part;
  return std::exchange(along.in_place, false) && HasAsItIs(along);
}

bool KnownParts::HasAsItIs(const LinkPart& part) const {
  const auto found = parts_.find(KeyOf(part));
  return found != parts_.end() && HasAny(found->second, part, IsLike);
}

bool KnownParts::HasLike(const LinkPart& part) const { return forms_.contains(FormOf(part)); }

}  // namespace traverse::gcode
