// What the verifier refuses in a layer, so that no choice has it again.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_REFUSALS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_REFUSALS_H_

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "client/gcode/choose/orders/order_repair.h"

namespace traverse::gcode {

struct Refusals {
  bool any = false;  // something is refused, or all choices but the first

  LinkSet links;                       // within the layer
  std::vector<PathPair> ordered;       // that may not change places
  LinkSet links_to;                    // from the layer before
  bool loops_stay = false;             // loops begin as in the file
  bool lines_stay = false;             // and no line is turned round
  absl::flat_hash_set<uint32_t> stay;  // the same for single paths

  // Travel from a choice of the layer before to one of this layer.
  absl::flat_hash_set<std::pair<uint32_t, uint32_t>> travels;

  // What of the last choice has to be had otherwise: how its paths are placed, its links, its begin
  // and its end.
  bool placed = false;
  bool inside = false;
  bool begin = false;
  bool end = false;
  size_t repairs = 0;  // how often links were had otherwise

  // Refuses the link to place `place` of `order` or, if that is the file's own, one beside it.
  void RefuseLink(const LayerOrder& order, size_t place);

  // Refuses that the path at place `at` of `order` comes before the one at place `before`. False if
  // it has to, as sliced.
  bool RefuseOrder(const LayerOrder& order, uint32_t first, size_t at, size_t before);

  // Refuses travel from a choice of the layer before, and that link between any choices unless it
  // is null.
  void RefuseTravel(uint32_t before, uint32_t choice, const LinkEnds* link);
  bool RefusesTravel(uint32_t before, uint32_t choice, const LinkEnds& link) const {
    return travels.contains({before, choice}) || links_to.contains(link);
  }

  // Refuses that loops of `order` begin elsewhere than in the file or, if none does, that paths are
  // turned round. False if all paths are as in the file.
  bool RefuseStarts(const LayerOrder& order);

  // The same for a single path.
  bool RefusePlaceOf(const Placement& placement);

  bool Refuse(const Placement& placement) const {
    if (placement.as_given()) return false;
    return (placement.closed ? loops_stay : lines_stay) || stay.contains(placement.block);
  }

  // REQUIRES: the layer begins with block `first`.
  bool Refuse(const LayerOrder& order, uint32_t first) const;

  // So many paths around a link may be as sliced next time: 1, 4, 16 and so on.
  size_t Reach();

  bool ask() const { return placed || inside || begin || end; }
  void Forget() { placed = inside = begin = end = false; }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_REFUSALS_H_
