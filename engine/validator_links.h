// How the validator reads links: with code of its own, as everything that it checks.

#ifndef TRAVERSE_ENGINE_VALIDATOR_LINKS_H_
#define TRAVERSE_ENGINE_VALIDATOR_LINKS_H_

#include <cstddef>
#include <vector>

#include "engine/model/links.h"

namespace traverse {

// The element for an end of a path, of none, of one for all, or of one for each.
template <typename Element>
Element ElementAt(const std::vector<Element>& elements, int end) {
  if (elements.empty()) return {};
  return elements.size() > 1 ? elements[static_cast<size_t>(end)] : elements.front();
}

// `links` may be null, or none.
inline Departure LeavingAt(const LayerLinks* links, int path, int exit) {
  if (links == nullptr || links->empty()) return {};
  return ElementAt((*links)[static_cast<size_t>(path)].departures, exit);
}

inline LinkSeconds ArrivingAt(const LayerLinks* links, int path, int entry) {
  if (links == nullptr || links->empty()) return {};
  return ElementAt((*links)[static_cast<size_t>(path)].arrivals, entry);
}

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_VALIDATOR_LINKS_H_
