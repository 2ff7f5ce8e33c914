// Improves the order that a search found for a layer, before it is written.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_MERGED_ORDERS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_MERGED_ORDERS_H_

#include <optional>
#include <vector>

#include "client/gcode/choose/known_travels.h"
#include "client/gcode/choose/order_merge.h"
#include "client/gcode/choose/order_polish.h"
#include "client/gcode/choose/order_repair.h"
#include "client/gcode/choose/rested_row.h"
#include "client/gcode/plan/layer_freedom.h"
#include "client/gcode/plan/policy.h"
#include "client/gcode/plan/travel_model.h"

namespace traverse::gcode {

// Rules for an order besides the file's own.
struct MergeRules {
  Policy policy = Policy::kSafe;
  Crossings crossings = Crossings::kKeep;
  bool as_many_retractions = false;  // each pushes a little more or less than it pulls

  // If set, small changes improve the orders too (order_polish.h): what may change in the layer,
  // and for how long. Either both are set or none.
  std::optional<LayerFreedom> freedom = {};
  std::optional<PolishLimit> polish = {};

  // Pairs of paths that the verifier refused the other way round; beyond those of `freedom`, which
  // has them too.
  std::vector<PathPair> ordered = {};

  // Links that the verifier refused; the file's own count as allowed all the same. May be null.
  const LinkSet* refused = nullptr;
};

// The rules by which orders of `layer` are merged under `policy`, with what else `allow` allows;
// with small changes if `polish` says for how long.
MergeRules RulesUnder(const GcodeFile& file, const Layer& layer, Policy policy,
                      const Allowance& allow, const std::optional<PolishLimit>& polish);

// `found`, improved with runs of the file's own order, and brought within the limits of `rules` as
// far as estimates tell (order_merge.h): in a few ways, of which only the best stays where it
// begins and ends with the same paths as the file. Where IsFree(policy) it is also tried with its
// paths in the order of the file.
std::vector<LayerOrder> MergedOrders(KnownTravels& travels, const LayerOrder& found,
                                     const MergeRules& rules);

// `order` with the pairs of `rules` as sliced and without the links that they refuse, or as few of
// them as can be had by changes around each; for a layer of freedom `freedom`. With greater
// `reach`, more paths around each are as sliced at the most. Unset if all of them stay.
std::optional<LayerOrder> RepairedOrder(KnownTravels& travels, const LayerOrder& order,
                                        const MergeRules& rules, const LayerFreedom& freedom,
                                        size_t reach);

// `order`, one of MergedOrders, improved once more in two ways so that it retracts less. Its first
// and last path stay. REQUIRES: rules.freedom, rules.polish.
std::vector<LayerOrder> SparingOrders(KnownTravels& travels, const LayerOrder& order,
                                      const MergeRules& rules);

// The turns of `orders` that may be chosen where islands must rest, for a layer of freedom
// `freedom`. `islands` as IslandTurns takes them; for `rest_seconds` they rest at the most;
// `moments`: when each path begins and ends in the file's own order. Of the result `given_times`
// and the travel to the layer are left to be set.
TurnedLayer TurnedOrders(KnownTravels& travels, const TravelModel& travel,
                         const std::vector<LayerOrder>& orders, const MergeRules& rules,
                         const LayerFreedom& freedom,
                         const std::vector<std::vector<uint32_t>>& islands, double rest_seconds,
                         const std::vector<double>& moments);

// `order`, improved within `units`: [path] what has to stay together. REQUIRES: rules.freedom,
// rules.polish.
LayerOrder SettledWithin(KnownTravels& travels, const LayerOrder& order, const MergeRules& rules,
                         const std::vector<uint32_t>& units);

// `orders`, in which whole objects have changed places, improved within each of them.
// REQUIRES: rules.freedom, rules.polish.
std::vector<LayerOrder> SettledOrders(KnownTravels& travels, std::vector<LayerOrder> orders,
                                      const MergeRules& rules);

// `order` improved with kicks (order_polish.h), which take long: for the one that was chosen. Its
// first and last path stay. REQUIRES: rules.freedom, rules.polish.
LayerOrder KickedOrder(KnownTravels& travels, const LayerOrder& order, const MergeRules& rules);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_MERGED_ORDERS_H_
