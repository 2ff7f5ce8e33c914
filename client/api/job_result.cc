#include "client/api/job_result.h"

#include <cstdint>
#include <string>

#include "absl/strings/str_format.h"

namespace traverse {
namespace {

// Counts the paths of a layer and ticks off those visited.
class Register {
 public:
  explicit Register(const v1::Layer& layer) : layer_(layer) {
    contours_.resize(static_cast<size_t>(layer.islands_size()));
    rasters_.resize(contours_.size());
    for (size_t i = 0; i < contours_.size(); ++i) {
      const v1::Island& island = layer.islands(static_cast<int>(i));
      contours_[i].resize(static_cast<size_t>(island.contours_size()));
      rasters_[i].resize(static_cast<size_t>(island.rasters_size()));
      left_ += contours_[i].size() + rasters_[i].size();
    }
    plan_.resize(static_cast<size_t>(layer.plan().paths_size()));
    left_ += plan_.size();
  }

  // Null, or the reason why the visit is wrong.
  const char* Tick(const v1::Visit& visit) {
    if (visit.path_case() == v1::Visit::kPlanPath) {
      if (visit.plan_path() >= plan_.size()) return "no such path";
      const v1::PlanPath& path = layer_.plan().paths(static_cast<int>(visit.plan_path()));
      return TickOff(plan_[visit.plan_path()], visit,
                     path.has_contour() ? &path.contour() : nullptr);
    }
    if (!visit.has_island() || visit.island() >= contours_.size()) return "no such island";
    const v1::Island& island = layer_.islands(static_cast<int>(visit.island()));
    if (visit.path_case() == v1::Visit::kContour) {
      if (visit.contour() >= contours_[visit.island()].size()) return "no such contour";
      return TickOff(contours_[visit.island()][visit.contour()], visit,
                     &island.contours(static_cast<int>(visit.contour())));
    }
    if (visit.path_case() != v1::Visit::kRaster) return "no path";
    if (visit.raster() >= rasters_[visit.island()].size()) return "no such raster";
    return TickOff(rasters_[visit.island()][visit.raster()], visit, nullptr);
  }

  size_t left() const { return left_; }

 private:
  const char* TickOff(std::vector<bool>::reference seen, const v1::Visit& visit,
                      const v1::Contour* contour) {
    if (seen) return "a path visited twice";
    seen = true;
    --left_;
    if (contour == nullptr) return visit.has_reversed() ? nullptr : "no direction";
    const uint64_t vertices = static_cast<uint64_t>(contour->points_size()) / 2;
    return visit.has_vertex() && visit.vertex() < vertices ? nullptr : "no such vertex";
  }

  const v1::Layer& layer_;
  std::vector<std::vector<bool>> contours_;  // [island][contour]: visited
  std::vector<std::vector<bool>> rasters_;   // [island][raster]
  std::vector<bool> plan_;                   // [path]
  size_t left_ = 0;
};

}  // namespace

absl::Status CheckVisits(const v1::Layer& layer, const v1::LayerResult& result) {
  Register paths(layer);
  for (int i = 0; i < result.visits_size(); ++i) {
    if (const char* fault = paths.Tick(result.visits(i)); fault != nullptr) {
      return absl::InternalError(absl::StrFormat("visits[%d]: %s", i, fault));
    }
  }
  if (paths.left() == 0) return absl::OkStatus();
  return absl::InternalError(absl::StrFormat("visits: %d paths are missing", paths.left()));
}

}  // namespace traverse
