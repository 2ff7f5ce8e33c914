// From the engine to traverse.v1: what a caller gets back.

#ifndef TRAVERSE_SERVER_TRANSLATE_TRANSLATE_RESULT_H_
#define TRAVERSE_SERVER_TRANSLATE_TRANSLATE_RESULT_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/engine.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {

// Fills `result` from the answer for a layer. `id` is Layer.id.
void ToProto(const LayerOutcome& outcome, uint64_t id, const std::string& strategy_name,
             v1::LayerResult& result);

// The totals of a job so far. A value; not thread-safe.
class JobTotals {
 public:
  void Add(const LayerOutcome& outcome);
  void SetChainBound(double lower_bound) { chain_lower_bound_ = lower_bound; }

  uint64_t layers() const { return layers_; }
  double compute_seconds() const { return compute_seconds_; }

  // Travel including the moves to the cleaning point, in mm.
  double given_mm() const { return given_.total_mm() + cleaning_given_mm_; }
  double travel_mm() const { return travel_.total_mm() + cleaning_mm_; }

  uint64_t invalid_routes() const { return invalid_routes_; }

  // Number of layers that stopped for `reason`.
  uint64_t stops(StopReason reason) const { return stops_[static_cast<size_t>(reason)]; }

  // Fills everything except the job's id, strategy and wall time.
  void ToProto(double idle_speed_mm_s, v1::JobSummary& summary) const;

 private:
  static constexpr size_t kReasons = 5;

  uint64_t layers_ = 0;
  uint64_t bounded_layers_ = 0;  // those with a lower bound
  uint64_t invalid_routes_ = 0;
  TravelSplit given_;
  TravelSplit travel_;
  double cleaning_given_mm_ = 0;
  double cleaning_mm_ = 0;
  double cost_given_ = 0;
  double cost_ = 0;
  MoveCounts moves_given_;
  MoveCounts moves_;
  double lower_bound_ = 0;
  std::optional<double> chain_lower_bound_;
  double compute_seconds_ = 0;
  std::array<uint64_t, kReasons> stops_{};
};

// The API's value for a reason of the engine.
v1::StopReason ToProto(StopReason reason);

// The label in metrics, such as LOCAL_OPTIMUM.
const char* StopReasonName(StopReason reason);

// (cost - bound) / cost, 0 where the cost is 0; never negative.
double Gap(double cost, double lower_bound);

// The strategies of this build, and what else it can do.
void ListStrategies(v1::ListStrategiesResponse& response);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_TRANSLATE_TRANSLATE_RESULT_H_
