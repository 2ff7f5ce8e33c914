#include "client/view/scene/layer_paths.h"

namespace traverse::view {
namespace {

// Numbers of these features, after the job's own.
enum OwnFeature { kOuterContour, kInnerContour, kRaster, kContour, kLine };

template <typename Path>
DrawnPath Drawn(const Path& path, size_t feature, bool closed) {
  DrawnPath drawn;
  drawn.feature = feature;
  drawn.closed = closed;
  drawn.points.reserve(static_cast<size_t>(path.points_size()) / 2);
  for (int i = 0; i + 1 < path.points_size(); i += 2) {
    drawn.points.push_back({path.points(i), path.points(i + 1)});
  }
  return drawn;
}

void AddIsland(const v1::Island& island, size_t own, std::vector<DrawnPath>& out) {
  for (int i = 0; i < island.contours_size(); ++i) {
    out.push_back(
        Drawn(island.contours(i), own + (i == 0 ? kOuterContour : kInnerContour), /*closed=*/true));
  }
  for (const v1::OpenPath& raster : island.rasters()) {
    out.push_back(Drawn(raster, own + kRaster, /*closed=*/false));
  }
}

}  // namespace

std::vector<std::string> FeatureNames(const InputJob& job) {
  std::vector<std::string> names = job.features;
  for (const char* own : {"outer contour", "inner contour", "raster", "contour", "line"}) {
    names.emplace_back(own);
  }
  return names;
}

std::vector<DrawnPath> PathsOf(const InputJob& job, size_t i) {
  const v1::Layer& layer = job.layers[i];
  const size_t own = job.features.size();
  std::vector<DrawnPath> out;
  for (const v1::Island& island : layer.islands()) AddIsland(island, own, out);
  const auto* features = i < job.notes.size() ? &job.notes[i].feature : nullptr;
  for (const v1::PlanPath& path : layer.plan().paths()) {
    const bool closed = path.has_contour();
    const size_t index = out.size();
    const size_t feature = features != nullptr && index < features->size()
                               ? (*features)[index]
                               : own + (closed ? kContour : kLine);
    out.push_back(closed ? Drawn(path.contour(), feature, true)
                         : Drawn(path.open_path(), feature, false));
  }
  return out;
}

VisitReader::VisitReader(const v1::Layer& layer) {
  size_t next = 0;
  for (const v1::Island& island : layer.islands()) {
    first_contour_.push_back(next);
    next += static_cast<size_t>(island.contours_size());
    first_raster_.push_back(next);
    next += static_cast<size_t>(island.rasters_size());
  }
}

DrawnVisit VisitReader::Read(const v1::Visit& visit) const {
  DrawnVisit drawn;
  if (visit.path_case() == v1::Visit::kContour) {
    drawn.path = first_contour_[visit.island()] + visit.contour();
  } else if (visit.path_case() == v1::Visit::kRaster) {
    drawn.path = first_raster_[visit.island()] + visit.raster();
  } else {
    drawn.path = visit.plan_path();
  }
  drawn.entry = visit.has_vertex() ? visit.vertex() : (visit.reversed() ? 1 : 0);
  return drawn;
}

}  // namespace traverse::view
