#include "client/gcode/link/link_donors.h"

#include <algorithm>
#include <map>

#include "client/gcode/link/link.h"
#include "client/gcode/model/part_links.h"

namespace traverse::gcode {
namespace {

// The lift of at least three quarters of the links that retract and lead to a layer; 0 if there is
// none.
Decimal UsualLiftToLayers(const GcodeFile& file) {
  constexpr double kMost = 0.75;
  std::map<Decimal, int64_t> links;  // [lift]
  int64_t all = 0;
  for (const Layer& layer : file.layers) {
    if (layer.first_block == 0) continue;
    const Block& first = file.blocks[layer.first_block];
    if ((first.link & kLinkRetracts) == 0 || first.travel_mm <= 0) continue;
    ++links[first.lift];
    ++all;
  }
  for (const auto& [lift, count] : links) {
    if (static_cast<double>(count) >= kMost * static_cast<double>(all)) return lift;
  }
  return 0;
}

}  // namespace

LinkDonors::LinkDonors(const GcodeFile& file)
    : file_(file), lift_to_layers_(UsualLiftToLayers(file)) {
  constexpr int kNoExample = kLinkSplits | kLinkFixed | kLinkRetractsAgain;
  may_follow_.reserve(file.blocks.size());
  for (uint32_t i = 0; i < file.blocks.size(); ++i) {
    const Block& block = file.blocks[i];
    may_follow_.push_back((block.link & kNoExample) == 0 && LeadsWithinPart(file, i));
    // If a path begins at the end of the one before it, there is no travel to learn from.
    if (!MayFollow(i) || !(block.travel_mm > 0)) continue;
    const Kind kind = KindOf(i);
    const KindInLayer in_layer(kind, file.LayerOf(i));
    const Decimal rise = RiseOf(i);
    donors_[kind][rise].push_back(i);
    first_.emplace(in_layer, i);
    if (block.lift > 0) lifted_[kind][rise].push_back(i);
    if ((block.link & kLinkWipes) != 0) wiping_[kind][rise].push_back(i);
    lifts_[in_layer] += block.lift > 0 ? 1 : -1;
    highest_lift_ = std::max(highest_lift_, block.lift);
  }
}

LinkDonors::Kind LinkDonors::KindOf(uint32_t block) const {
  return {file_.blocks[block].mode, (file_.blocks[block].link & kLinkRetracts) != 0};
}

Decimal LinkDonors::LiftToLayer(uint32_t block) const {
  return block > 0 && (file_.blocks[block].link & kLinkNewLayer) != 0 ? lift_to_layers_ : 0;
}

bool LinkDonors::LacksLift(uint32_t block) const {
  const Block& to = file_.blocks[block];
  if (to.lift > 0) return false;
  const auto found = lifts_.find({KindOf(block), file_.LayerOf(block)});
  return found != lifts_.end() && found->second > 0;
}

bool LinkDonors::IsOwnExample(uint32_t block, bool retracts, bool wipes) const {
  const int link = file_.blocks[block].link;
  return MayFollow(block) && !LacksLift(block) && ((link & kLinkRetracts) != 0) == retracts &&
         ((link & kLinkWipes) != 0 || !wipes);
}

std::optional<uint32_t> LinkDonors::Find(uint32_t block, bool retracts, bool wipes) const {
  const Kind kind{file_.blocks[block].mode, retracts};
  if (wipes && wiping_.contains(kind)) return FindAmong(wiping_, kind, block);
  const std::optional<uint32_t> nearest = FindAmong(donors_, kind, block);
  if (!nearest || !LacksLift(*nearest)) return nearest;
  const std::optional<uint32_t> lifted = FindAmong(lifted_, kind, block);
  return lifted ? lifted : nearest;
}

Decimal LinkDonors::RiseOf(uint32_t block) const {
  return file_.blocks[block].last.z - file_.blocks[block].first.z;
}

std::optional<uint32_t> LinkDonors::PaceFor(uint32_t block, uint32_t link) const {
  const size_t layer = file_.LayerOf(block);
  if (file_.LayerOf(link) == layer) return std::nullopt;
  Kind kind = KindOf(link);
  for (int i = 0; i < 2; ++i, kind.second = !kind.second) {
    const auto found = first_.find({kind, layer});
    if (found != first_.end()) return found->second;
  }
  return std::nullopt;
}

std::optional<uint32_t> LinkDonors::FindAmong(const std::map<Kind, ByRise>& donors,
                                              const Kind& kind, uint32_t block) const {
  const auto of_kind = donors.find(kind);
  if (of_kind == donors.end()) return std::nullopt;
  const auto as_steep = of_kind->second.find(RiseOf(block));
  const std::vector<uint32_t>& links =
      as_steep != of_kind->second.end() ? as_steep->second : of_kind->second.begin()->second;
  const auto behind = std::upper_bound(links.begin(), links.end(), block);
  if (behind == links.begin()) return *behind;
  const uint32_t before = *(behind - 1);
  const size_t layer = file_.LayerOf(block);
  const bool behind_is_of_it = behind != links.end() && file_.LayerOf(*behind) == layer;
  return behind_is_of_it && file_.LayerOf(before) != layer ? *behind : before;
}

}  // namespace traverse::gcode
