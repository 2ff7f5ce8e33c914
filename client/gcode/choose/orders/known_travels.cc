#include "client/gcode/choose/orders/known_travels.h"

#include <algorithm>
#include <utility>

#include "client/gcode/model/part_links.h"

namespace traverse::gcode {
namespace {

// Rounding of lengths.
constexpr double kGrainMm = 1e-6;

}  // namespace

KnownTravels::KnownTravels(const LayerWriter& writer)
    : writer_(writer), given_(writer.GivenOrder()) {
  uint32_t placements = 0;
  for (const Outline& outline : writer.outlines()) {
    numbers_.push_back(placements);
    placements += static_cast<uint32_t>(std::max<size_t>(outline.points.size(), 2));
  }
  for (const Placement& placement : given_) {
    boundaries_.push_back(IsBoundary(writer.file().blocks[placement.block]));
  }
  given_travels_.resize(given_.size());
  for (size_t i = 1; i < given_.size(); ++i) {
    given_travels_[i] = writer.EstimateTravel(i, given_[i - 1], given_[i], Parts());
    longest_open_mm_ = std::max(longest_open_mm_, given_travels_[i].open_mm);
  }
}

bool KnownTravels::IsAsGiven(size_t place, const Placement& from, const Placement& to) const {
  const size_t next = PathOf(to);
  if (next == 0 || from != given_[next - 1] || to != given_[next]) return false;
  // Where something stands in the file, the travel depends on what that is.
  return next == place || !(boundaries_[place] || boundaries_[next]);
}

TravelTotals KnownTravels::operator()(size_t place, const Placement& from, const Placement& to) {
  if (IsAsGiven(place, from, to)) return given_travels_[PathOf(to)];
  if (known_.size() >= kMostKnown) known_.clear();
  const uint32_t at = boundaries_[place] ? static_cast<uint32_t>(place) : 0;
  const auto [found, added] = known_.try_emplace(Key{at, Number(from), Number(to)});
  if (added) {
    TravelTotals& totals = found->second;
    totals = writer_.EstimateTravel(place, from, to, Parts());
    if (totals.open_mm > longest_open_mm_ + kGrainMm) totals.too_long = 1;
  }
  return found->second;
}

LinkParts& KnownTravels::Parts() {
  if (!parts_) parts_.emplace(writer_.file());
  return *parts_;
}

void KnownTravels::Shrink(size_t most) {
  parts_.reset();
  if (known_.size() <= most) return;
  absl::flat_hash_map<Key, TravelTotals> kept;
  kept.reserve(most);
  for (auto known = known_.begin(); kept.size() < most; ++known) kept.insert(*known);
  known_ = std::move(kept);
}

}  // namespace traverse::gcode
