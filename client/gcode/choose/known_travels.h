// The travel moves between the paths of one layer, as estimated.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_KNOWN_TRAVELS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_KNOWN_TRAVELS_H_

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/choose/order_repair.h"
#include "client/gcode/link/link_parts.h"
#include "client/gcode/link/travel_totals.h"
#include "client/gcode/write/layer_writer.h"

namespace traverse::gcode {

struct MergeRules;

// Those around walls take long to find, and the same few are asked for again and again.
class KnownTravels {
 public:
  // All outlive it.
  KnownTravels(const LayerWriter& writer, const MergeRules& rules);

  // The rules refuse that link.
  bool IsRefused(const Placement& from, const Placement& to) const;

  // From now on the orders asked about have these LayerWriter::PlacesOf.
  void SetPlaces(std::vector<uint32_t> places) { places_ = std::move(places); }

  // See TravelEstimate.
  TravelTotals operator()(size_t place, const Placement& from, const Placement& to);

 private:
  using Key = std::tuple<uint32_t, uint32_t, uint32_t>;

  // Of 56 bytes each.
  static constexpr size_t kMostKnown = 400'000;

  // Of all placements of the layer's paths.
  uint32_t Number(const Placement& placement) const {
    return numbers_[placement.block - given_.front().block] + placement.entry;
  }

  TravelTotals Estimate(size_t place, const Placement& from, const Placement& to);

  const LayerWriter& writer_;
  const MergeRules& rules_;
  LinkParts parts_;
  const LayerOrder given_;
  std::vector<uint32_t> numbers_;            // [path] the number of its first placement
  std::vector<TravelTotals> given_travels_;  // [place] as the layer was given
  double longest_open_mm_ = 0;               // of them
  std::vector<uint32_t> places_;             // [place] of the file; empty: the same
  absl::flat_hash_map<Key, TravelTotals> known_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_KNOWN_TRAVELS_H_
