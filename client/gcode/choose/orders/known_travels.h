// The travel moves between the paths of one layer, as estimated.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_KNOWN_TRAVELS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_KNOWN_TRAVELS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/link/link_parts.h"
#include "client/gcode/link/travel_totals.h"
#include "client/gcode/write/layer_writer.h"

namespace traverse::gcode {

// Those around walls take long to find, and the same few are asked for again and again: while
// orders of the layer are merged, and when the one that was chosen is improved. Not thread-safe.
class KnownTravels {
 public:
  // `writer` outlives it.
  explicit KnownTravels(const LayerWriter& writer);

  const LayerWriter& writer() const { return writer_; }

  // LayerWriter::EstimateTravel; of a move longer than the longest one of the file that goes
  // without a retraction, and does so too, `too_long`.
  TravelTotals operator()(size_t place, const Placement& from, const Placement& to);

  // The link before `place` is that of the file.
  bool IsAsGiven(size_t place, const Placement& from, const Placement& to) const;

  // Forgets what takes memory, but for up to `most` moves, whichever.
  void Shrink(size_t most);

  // Moves that it knows.
  size_t size() const { return known_.size(); }

 private:
  using Key = std::tuple<uint32_t, uint32_t, uint32_t>;

  // Of 56 bytes each.
  static constexpr size_t kMostKnown = 400'000;

  // Of all placements of the layer's paths.
  uint32_t Number(const Placement& placement) const {
    return numbers_[PathOf(placement)] + placement.entry;
  }

  size_t PathOf(const Placement& placement) const { return placement.block - given_.front().block; }

  LinkParts& Parts();

  const LayerWriter& writer_;
  const LayerOrder given_;
  std::optional<LinkParts> parts_;
  std::vector<uint32_t> numbers_;  // [path] the number of its first placement
  std::vector<bool> boundaries_;   // [place] the file has something that nothing may cross
  std::vector<TravelTotals> given_travels_;  // [place] as the layer was given
  double longest_open_mm_ = 0;               // of them
  absl::flat_hash_map<Key, TravelTotals> known_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_KNOWN_TRAVELS_H_
