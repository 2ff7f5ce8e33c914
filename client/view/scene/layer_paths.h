// The paths of a layer, for drawing.

#ifndef TRAVERSE_CLIENT_VIEW_SCENE_LAYER_PATHS_H_
#define TRAVERSE_CLIENT_VIEW_SCENE_LAYER_PATHS_H_

#include <string>
#include <vector>

#include "client/input/input_job.h"
#include "client/view/scene/scene.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::view {

// The names to which DrawnPath::feature refers: the job's own features, followed by those of layers
// of islands and of plans without notes.
std::vector<std::string> FeatureNames(const InputJob& job);

// The paths of layer `i`: of a plan in its order; of islands one island after another, contours
// first.
std::vector<DrawnPath> PathsOf(const InputJob& job, size_t i);

// Reads visits as indices into PathsOf(job, i).
class VisitReader {
 public:
  explicit VisitReader(const v1::Layer& layer);

  DrawnVisit Read(const v1::Visit& visit) const;

 private:
  std::vector<size_t> first_contour_;  // [island] index of its first contour, of its first raster
  std::vector<size_t> first_raster_;
};

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_SCENE_LAYER_PATHS_H_
