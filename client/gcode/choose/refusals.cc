#include "client/gcode/choose/refusals.h"

#include <algorithm>

namespace traverse::gcode {

void Refusals::RefuseLink(const LayerOrder& order, size_t place) {
  any = true;
  for (const size_t at : {place, place + 1, place - 1}) {
    if (at == 0 || at >= order.size()) continue;  // a place before the first one is very great
    const LinkEnds link{order[at - 1], order[at]};
    const bool own =
        link.from.as_given() && link.to.as_given() && link.from.block + 1 == link.to.block;
    if (own) continue;
    links.insert(link);
    inside = true;
    return;
  }
}

bool Refusals::RefuseOrder(const LayerOrder& order, uint32_t first, size_t at, size_t before) {
  if (at >= before || before >= order.size()) return false;
  const PathPair pair{order[before].block - first, order[at].block - first};
  if (pair.first >= pair.second) return false;
  ordered.push_back(pair);
  any = inside = true;
  return true;
}

void Refusals::RefuseTravel(uint32_t before, uint32_t choice, const LinkEnds* link) {
  any = true;
  travels.emplace(before, choice);
  if (link != nullptr) links_to.insert(*link);
}

bool Refusals::RefuseStarts(const LayerOrder& order) {
  const auto moved = [&order](bool closed) {
    return std::any_of(order.begin(), order.end(), [closed](const Placement& placement) {
      return placement.closed == closed && !placement.as_given();
    });
  };
  const bool loops = moved(true);
  if (!loops && !moved(false)) return false;
  (loops ? loops_stay : lines_stay) = true;
  any = placed = true;
  return true;
}

bool Refusals::RefusePlaceOf(const Placement& placement) {
  if (placement.as_given()) return false;
  stay.insert(placement.block);
  any = placed = true;
  return true;
}

bool Refusals::Refuse(const LayerOrder& order, uint32_t first) const {
  return HasAnyOf(order, links) || BreaksAnyOf(order, first, ordered) ||
         std::any_of(order.begin(), order.end(),
                     [this](const Placement& placement) { return Refuse(placement); });
}

size_t Refusals::Reach() {
  constexpr size_t kMostRepairs = 5;
  return size_t{1} << (2 * std::min(repairs++, kMostRepairs));
}

}  // namespace traverse::gcode
