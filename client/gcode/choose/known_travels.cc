#include "client/gcode/choose/known_travels.h"

#include <algorithm>

#include "client/gcode/choose/merged_orders.h"

namespace traverse::gcode {
namespace {

// Rounding of lengths.
constexpr double kGrainMm = 1e-6;

}  // namespace

KnownTravels::KnownTravels(const LayerWriter& writer, const MergeRules& rules)
    : writer_(writer), rules_(rules), parts_(writer.file()), given_(writer.GivenOrder()) {
  uint32_t placements = 0;
  for (const Outline& outline : writer.outlines()) {
    numbers_.push_back(placements);
    placements += static_cast<uint32_t>(std::max<size_t>(outline.points.size(), 2));
  }
  given_travels_.resize(given_.size());
  for (size_t i = 1; i < given_.size(); ++i) {
    given_travels_[i] = writer.EstimateTravel(i, given_[i - 1], given_[i], parts_);
    longest_open_mm_ = std::max(longest_open_mm_, given_travels_[i].open_mm);
  }
}

bool KnownTravels::IsRefused(const Placement& from, const Placement& to) const {
  return rules_.refused != nullptr && rules_.refused->contains({from, to});
}

TravelTotals KnownTravels::operator()(size_t place, const Placement& from, const Placement& to) {
  if (!places_.empty()) place = places_[place];
  // Where something stands in the file, the travel depends on what that is.
  const bool boundary = rules_.boundaries[place];
  const size_t next = to.block - given_.front().block;
  const bool as_given = next > 0 && from == given_[next - 1] && to == given_[next];
  const bool alike = next == place || !(boundary || rules_.boundaries[next]);
  if (as_given && alike) return given_travels_[next];
  if (known_.size() >= kMostKnown) known_.clear();
  const Key key{boundary ? static_cast<uint32_t>(place) : 0, Number(from), Number(to)};
  const auto [found, added] = known_.try_emplace(key);
  if (added) found->second = Estimate(place, from, to);
  return found->second;
}

TravelTotals KnownTravels::Estimate(size_t place, const Placement& from, const Placement& to) {
  TravelTotals totals = writer_.EstimateTravel(place, from, to, parts_);
  if (totals.open_mm > longest_open_mm_ + kGrainMm) totals.too_long = 1;
  if (IsRefused(from, to)) ++totals.too_long;
  return totals;
}

}  // namespace traverse::gcode
