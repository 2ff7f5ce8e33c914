#include "client/gcode/choose/island_orders.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

namespace traverse::gcode {
namespace {

// An island within a group.
using Part = std::pair<uint32_t, uint32_t>;

class PartOrders {
 public:
  PartOrders(const LayerOrder& given, const LayerOrder& found, const IslandParts& parts)
      : first_block_(given.front().block),
        found_(found),
        parts_(parts),
        given_(SequenceOf(given)),
        sequence_(SequenceOf(found)) {}

  // The parts of `found`, from the first one of `given` in each group on; or backwards from there.
  LayerOrder GoneRound(bool backwards) const {
    std::vector<Part> sequence = sequence_;
    for (auto begin = sequence.begin(); begin != sequence.end();) {
      const uint32_t group = begin->first;
      const auto end = std::find_if(begin, sequence.end(),
                                    [group](const Part& part) { return part.first != group; });
      if (backwards) std::reverse(begin, end);
      const auto at = static_cast<size_t>(begin - sequence.begin());
      std::rotate(begin, std::find(begin, end, given_[at]), end);
      begin = end;
    }
    return InSequence(sequence);
  }

  LayerOrder AsGiven() const { return InSequence(given_); }

 private:
  Part PartOf(const Placement& placement) const {
    const size_t path = placement.block - first_block_;
    return {parts_.group[path], parts_.island[path]};
  }

  // In which `order` comes to them first.
  std::vector<Part> SequenceOf(const LayerOrder& order) const {
    std::map<Part, size_t> known;
    std::vector<Part> sequence;
    for (const Placement& placement : order) {
      const Part part = PartOf(placement);
      if (known.try_emplace(part, sequence.size()).second) sequence.push_back(part);
    }
    return sequence;
  }

  LayerOrder InSequence(const std::vector<Part>& sequence) const {
    std::map<Part, size_t> place;
    for (size_t i = 0; i < sequence.size(); ++i) place[sequence[i]] = i;
    std::vector<std::pair<size_t, Placement>> placed;
    placed.reserve(found_.size());
    for (const Placement& placement : found_) {
      placed.emplace_back(place[PartOf(placement)], placement);
    }
    std::stable_sort(placed.begin(), placed.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    LayerOrder order;
    order.reserve(placed.size());
    for (const auto& [at, placement] : placed) order.push_back(placement);
    return order;
  }

  const uint32_t first_block_;
  const LayerOrder& found_;
  const IslandParts& parts_;
  const std::vector<Part> given_;
  const std::vector<Part> sequence_;
};

}  // namespace

std::vector<LayerOrder> IslandOrders(const LayerOrder& given, const LayerOrder& found,
                                     const IslandParts& parts) {
  const auto [least, greatest] = std::minmax_element(parts.island.begin(), parts.island.end());
  if (parts.island.empty() || *least == *greatest) return {};
  const PartOrders orders(given, found, parts);
  std::vector<LayerOrder> all;
  for (LayerOrder& order :
       std::vector{orders.GoneRound(false), orders.GoneRound(true), orders.AsGiven()}) {
    if (std::find(all.begin(), all.end(), order) == all.end()) all.push_back(std::move(order));
  }
  return all;
}

std::vector<uint32_t> IslandGroups(const IslandParts& parts) {
  std::map<Part, uint32_t> numbers;
  std::vector<uint32_t> groups;
  for (size_t path = 0; path < parts.island.size(); ++path) {
    const Part part{parts.group[path], parts.island[path]};
    groups.push_back(
        numbers.try_emplace(part, static_cast<uint32_t>(numbers.size())).first->second);
  }
  return groups;
}

}  // namespace traverse::gcode
