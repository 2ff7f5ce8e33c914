// The first stage of a layer: measures the given order, and predicts where the layer will end.

#ifndef TRAVERSE_ENGINE_SCHEDULE_LAYER_PREPARER_H_
#define TRAVERSE_ENGINE_SCHEDULE_LAYER_PREPARER_H_

#include <memory>

#include "engine/model/point.h"
#include "engine/schedule/chain_layer.h"
#include "engine/schedule/end_history.h"
#include "engine/schedule/layer_solver.h"

namespace traverse {

// Goes through the layers in build order and tracks where the head is after each. Not thread-safe:
// one layer at a time.
class LayerPreparer {
 public:
  // `start`: of the job. Keeps, but does not own, `solver`.
  LayerPreparer(Point start, const LayerSolver& solver)
      : solver_(solver), given_at_(start), greedy_at_(start), predicted_at_(start) {}

  // Sets what ChainLayer says that prepare sets, except the entries in the route history.
  void Prepare(ChainLayer& layer);

  // Notes that a layer ended at `end`, relative to its origin.
  void Learn(uint64_t shape, uint64_t key, Point end) { history_.Learn(shape, key, end); }

 private:
  void TellGivenOf(ChainLayer& layer, Budget& turns);
  GreedyLayer FollowGreedy(const ChainLayer& layer) const;
  Point PredictEnd(const ChainLayer& layer) const;

  const LayerSolver& solver_;
  Point given_at_;          // where the head is in the given order
  LinkSeconds given_left_;  // and what it took to leave the path before
  Point greedy_at_;         // and in greedy's
  Point predicted_at_;      // where the head will probably be in the order that is found
  std::shared_ptr<AnchoredRoutes> anchored_;
  EndHistory history_;
  bool learned_ = false;  // a layer repeated one whose end was learned
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_PREPARER_H_
