#include "server/translate/translate_result.h"

#include <algorithm>

#include "engine/strategy/registry.h"
#include "server/version.h"

namespace traverse {
namespace {

// ListStrategiesResponse.capabilities: sorted; no word is ever renamed or removed.
// proto/VERSIONS.md says what each one means, and since which version.
constexpr const char* kCapabilities[] = {"chain_bound", "initial_route", "partial_answers"};

void SetPoint(Point point, v1::Point& message) {
  message.set_x_mm(point.x);
  message.set_y_mm(point.y);
}

void SetTravel(const TravelSplit& travel, v1::Travel& message) {
  message.set_contours_mm(travel.contours_mm);
  message.set_rasters_mm(travel.rasters_mm);
  message.set_links_mm(travel.links_mm);
  message.set_total_mm(travel.total_mm());
}

// For each path of a layer of islands its position in its island's list of its kind.
// Plan::paths holds island by island the contours, then the rasters.
std::vector<uint32_t> PositionsInIslands(const Plan& plan) {
  std::vector<uint32_t> positions(plan.paths.size());
  for (size_t p = 0; p < plan.paths.size(); ++p) {
    const bool continues = p > 0 && plan.paths[p].island == plan.paths[p - 1].island &&
                           plan.paths[p].kind == plan.paths[p - 1].kind;
    positions[p] = continues ? positions[p - 1] + 1 : 0;
  }
  return positions;
}

void SetVisits(const LayerOutcome& outcome, v1::LayerResult& result) {
  const Plan& plan = outcome.plan;
  const bool islands = !plan.paths.empty() && plan.paths[0].island >= 0;
  std::vector<uint32_t> positions;
  if (islands) positions = PositionsInIslands(plan);
  result.mutable_visits()->Reserve(static_cast<int>(outcome.route.size()));
  for (const Visit& visit : outcome.route) {
    v1::Visit& message = *result.add_visits();
    const auto p = static_cast<size_t>(visit.path);
    const Path& path = plan.paths[p];
    const bool contour = path.kind == Path::Kind::kContour;
    if (!islands) {
      message.set_plan_path(static_cast<uint32_t>(p));
    } else {
      message.set_island(static_cast<uint32_t>(path.island));
      if (contour) {
        message.set_contour(positions[p]);
      } else {
        message.set_raster(positions[p]);
      }
    }
    if (contour) {
      message.set_vertex(static_cast<uint32_t>(visit.entry));
    } else {
      message.set_reversed(visit.entry == 1);
    }
  }
}

v1::OptionType ToProto(OptionSpec::Type type) {
  switch (type) {
    case OptionSpec::Type::kBool:
      return v1::OPTION_TYPE_BOOL;
    case OptionSpec::Type::kInt:
      return v1::OPTION_TYPE_INT;
    case OptionSpec::Type::kDouble:
      return v1::OPTION_TYPE_DOUBLE;
    case OptionSpec::Type::kChoice:
      return v1::OPTION_TYPE_CHOICE;
  }
  return v1::OPTION_TYPE_UNSPECIFIED;
}

void SetOption(const OptionSpec& spec, v1::OptionInfo& info) {
  info.set_name(spec.name);
  info.set_type(ToProto(spec.type));
  info.set_default_value(spec.default_value);
  if (spec.type == OptionSpec::Type::kInt || spec.type == OptionSpec::Type::kDouble) {
    info.set_minimum(spec.minimum);
    info.set_maximum(spec.maximum);
  }
  for (const std::string& value : spec.values) info.add_values(value);
  info.set_description(spec.description);
}

}  // namespace

double Gap(double cost, double lower_bound) {
  return cost > 0 ? std::max(0.0, (cost - lower_bound) / cost) : 0;
}

v1::StopReason ToProto(StopReason reason) {
  switch (reason) {
    case StopReason::kOptimal:
      return v1::STOP_REASON_OPTIMAL;
    case StopReason::kLocalOptimum:
      return v1::STOP_REASON_LOCAL_OPTIMUM;
    case StopReason::kIterationLimit:
      return v1::STOP_REASON_ITERATION_LIMIT;
    case StopReason::kTimeLimit:
      return v1::STOP_REASON_TIME_LIMIT;
    case StopReason::kCancelled:
      return v1::STOP_REASON_CANCELLED;
  }
  return v1::STOP_REASON_UNSPECIFIED;
}

const char* StopReasonName(StopReason reason) {
  switch (reason) {
    case StopReason::kOptimal:
      return "OPTIMAL";
    case StopReason::kLocalOptimum:
      return "LOCAL_OPTIMUM";
    case StopReason::kIterationLimit:
      return "ITERATION_LIMIT";
    case StopReason::kTimeLimit:
      return "TIME_LIMIT";
    case StopReason::kCancelled:
      return "CANCELLED";
  }
  return "UNSPECIFIED";
}

void ToProto(const LayerOutcome& outcome, uint64_t id, const std::string& strategy_name,
             v1::LayerResult& result) {
  result.set_index(outcome.index);
  result.set_id(id);
  SetPoint(outcome.start, *result.mutable_start());
  SetPoint(outcome.end, *result.mutable_end());
  SetVisits(outcome, result);
  SetTravel(outcome.given, *result.mutable_given());
  SetTravel(outcome.travel, *result.mutable_travel());
  result.set_cost_given(outcome.cost_given);
  result.set_cost(outcome.cost);
  if (outcome.lower_bound) {
    result.set_lower_bound(*outcome.lower_bound);
    result.set_gap(Gap(outcome.cost, *outcome.lower_bound));
  }
  result.set_strategy(strategy_name);
  result.set_stop_reason(ToProto(outcome.stop));
  result.set_solve_seconds(outcome.solve_seconds);
  result.set_cleaning_mm(outcome.cleaning_mm);
  result.set_cleaning_given_mm(outcome.cleaning_given_mm);
  result.set_crossings_given(static_cast<uint64_t>(outcome.moves_given.crossings));
  result.set_crossings(static_cast<uint64_t>(outcome.moves.crossings));
  result.set_retractions_given(static_cast<uint64_t>(outcome.moves_given.retractions));
  result.set_retractions(static_cast<uint64_t>(outcome.moves.retractions));
  for (const Detour& detour : outcome.detours) {
    v1::Detour& message = *result.add_detours();
    message.set_visit(static_cast<uint32_t>(detour.visit));
    for (const Point& point : detour.points) {
      message.add_points(point.x);
      message.add_points(point.y);
    }
  }
  result.mutable_statistics()->insert(outcome.statistics.begin(), outcome.statistics.end());
}

void JobTotals::Add(const LayerOutcome& outcome) {
  ++layers_;
  given_ += outcome.given;
  travel_ += outcome.travel;
  cleaning_given_mm_ += outcome.cleaning_given_mm;
  cleaning_mm_ += outcome.cleaning_mm;
  cost_given_ += outcome.cost_given;
  cost_ += outcome.cost;
  moves_given_ += outcome.moves_given;
  moves_ += outcome.moves;
  if (outcome.lower_bound) {
    ++bounded_layers_;
    lower_bound_ += *outcome.lower_bound;
  }
  compute_seconds_ += outcome.solve_seconds;
  ++stops_[static_cast<size_t>(outcome.stop)];
  if (!outcome.invalid_route.empty()) ++invalid_routes_;
}

void JobTotals::ToProto(double idle_speed_mm_s, v1::JobSummary& summary) const {
  summary.set_layers(layers_);
  SetTravel(given_, *summary.mutable_given());
  SetTravel(travel_, *summary.mutable_travel());
  summary.set_cleaning_given_mm(cleaning_given_mm_);
  summary.set_cleaning_mm(cleaning_mm_);
  summary.set_cost_given(cost_given_);
  summary.set_cost(cost_);
  summary.set_crossings_given(static_cast<uint64_t>(moves_given_.crossings));
  summary.set_crossings(static_cast<uint64_t>(moves_.crossings));
  summary.set_retractions_given(static_cast<uint64_t>(moves_given_.retractions));
  summary.set_retractions(static_cast<uint64_t>(moves_.retractions));
  if (bounded_layers_ == layers_) summary.set_lower_bound(lower_bound_);
  if (chain_lower_bound_) summary.set_chain_lower_bound(*chain_lower_bound_);
  summary.set_idle_seconds_given(given_mm() / idle_speed_mm_s);
  summary.set_idle_seconds(travel_mm() / idle_speed_mm_s);
  for (size_t reason = 0; reason < kReasons; ++reason) {
    if (stops_[reason] == 0) continue;
    v1::StopCount& count = *summary.add_stops();
    count.set_stop_reason(traverse::ToProto(static_cast<StopReason>(reason)));
    count.set_layers(stops_[reason]);
  }
  summary.set_compute_seconds(compute_seconds_);
}

void ListStrategies(v1::ListStrategiesResponse& response) {
  for (const StrategyEntry& entry : Strategies()) {
    v1::StrategyInfo& info = *response.add_strategies();
    info.set_name(entry.name);
    info.set_summary(entry.summary);
    info.set_lower_bound(entry.lower_bound);
    for (const OptionSpec& spec : entry.options) SetOption(spec, *info.add_options());
  }
  response.set_default_strategy(DefaultStrategyName());
  response.set_server_version(kVersion);
  for (const char* const word : kCapabilities) response.add_capabilities(word);
}

}  // namespace traverse
