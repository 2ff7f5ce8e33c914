#include "server/translate/translate_route.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "engine/base/rest.h"
#include "engine/model/route_fault.h"
#include "server/translate/translate_check.h"

namespace traverse {
namespace {

// How visits name the paths of a layer. Plan::paths holds island by island the contours, then the
// rasters.
class PathNames {
 public:
  PathNames(const v1::Layer& layer, Rest& rest) : layer_(layer) {
    first_path_.reserve(static_cast<size_t>(layer.islands_size()));
    int paths = 0;
    for (const v1::Island& island : layer.islands()) {
      rest(8);
      first_path_.push_back(paths);
      paths += island.contours_size() + island.rasters_size();
    }
  }

  // The path that `visit` names.
  absl::StatusOr<int> PathOf(const v1::Visit& visit, const FieldPath& place) const {
    if (layer_.has_plan()) return PathOfPlan(visit, place);
    if (!visit.has_island()) return Fault(place.text() + ".island", "not set");
    if (visit.island() >= first_path_.size()) {
      return Fault(place.text() + ".island",
                   absl::StrCat(visit.island(), ", but the layer has ", first_path_.size()));
    }
    const int first = first_path_[visit.island()];
    const v1::Island& island = layer_.islands(static_cast<int>(visit.island()));
    switch (visit.path_case()) {
      case v1::Visit::kContour:
        return InList(visit.contour(), island.contours_size(), first, place, "contour");
      case v1::Visit::kRaster:
        return InList(visit.raster(), island.rasters_size(), first + island.contours_size(), place,
                      "raster");
      case v1::Visit::kPlanPath:
        return Fault(place.text() + ".plan_path", "set, but the layer has islands");
      case v1::Visit::PATH_NOT_SET:
        break;
    }
    return Fault(place.text(), "set contour or raster");
  }

  // As in `raster 2 of island 1`.
  std::string NameOf(int path) const {
    if (layer_.has_plan()) return absl::StrCat("plan_path ", path);
    const auto next = std::upper_bound(first_path_.begin(), first_path_.end(), path);
    const int island = static_cast<int>(next - first_path_.begin()) - 1;
    const int position = path - first_path_[static_cast<size_t>(island)];
    const int contours = layer_.islands(island).contours_size();
    return position < contours
               ? absl::StrCat("contour ", position, " of island ", island)
               : absl::StrCat("raster ", position - contours, " of island ", island);
  }

 private:
  absl::StatusOr<int> PathOfPlan(const v1::Visit& visit, const FieldPath& place) const {
    constexpr const char* kIsPlan = "set, but the layer has a plan";
    if (visit.has_island()) return Fault(place.text() + ".island", kIsPlan);
    switch (visit.path_case()) {
      case v1::Visit::kPlanPath:
        return InList(visit.plan_path(), layer_.plan().paths_size(), 0, place, "plan_path");
      case v1::Visit::kContour:
        return Fault(place.text() + ".contour", kIsPlan);
      case v1::Visit::kRaster:
        return Fault(place.text() + ".raster", kIsPlan);
      case v1::Visit::PATH_NOT_SET:
        break;
    }
    return Fault(place.text(), "set plan_path");
  }

  static absl::StatusOr<int> InList(uint32_t position, int size, int first, const FieldPath& place,
                                    const char* field) {
    if (position < static_cast<uint32_t>(size)) return first + static_cast<int>(position);
    return Fault(absl::StrCat(place.text(), ".", field),
                 absl::StrCat(position, ", but there are ", size));
  }

  const v1::Layer& layer_;
  std::vector<int> first_path_;  // [island]
};

absl::StatusOr<int> EntryOf(const v1::Visit& visit, const Path& path, const FieldPath& place) {
  const bool contour = path.kind == Path::Kind::kContour;
  switch (visit.entry_case()) {
    case v1::Visit::kVertex:
      if (!contour) return Fault(place.text() + ".vertex", "set, but the path is open");
      if (visit.vertex() < path.points.size()) return static_cast<int>(visit.vertex());
      return Fault(place.text() + ".vertex", absl::StrCat(visit.vertex(), " is not a vertex of a ",
                                                          "contour of ", path.points.size()));
    case v1::Visit::kReversed:
      if (contour) return Fault(place.text() + ".reversed", "set, but the path is a contour");
      return visit.reversed() ? 1 : 0;
    case v1::Visit::ENTRY_NOT_SET:
      break;
  }
  return Fault(place.text() + (contour ? ".vertex" : ".reversed"), "not set");
}

// The first visits of the message, and why the one behind them is none, if it is not.
struct ReadVisits {
  Route route;
  absl::Status end;
};

ReadVisits ReadRoute(const v1::Layer& message, const Plan& plan, const PathNames& names,
                     const FieldPath& place, Rest& rest) {
  // If there are more visits than paths, one of the first ones is repeated.
  const int most = static_cast<int>(plan.paths.size()) + 1;
  const int size = std::min(message.initial_route_size(), most);
  ReadVisits read;
  read.route.reserve(static_cast<size_t>(size));
  for (int i = 0; i < size; ++i) {
    rest(kStepsOfMessage);
    const v1::Visit& visit = message.initial_route(i);
    const FieldPath at(&place, "initial_route", static_cast<uint64_t>(i));
    read.end = CheckKnownAt(visit, at);
    if (!read.end.ok()) break;
    const absl::StatusOr<int> path = names.PathOf(visit, at);
    read.end = path.status();
    if (!path.ok()) break;
    const absl::StatusOr<int> entry = EntryOf(visit, plan.paths[static_cast<size_t>(*path)], at);
    read.end = entry.status();
    if (!entry.ok()) break;
    read.route.push_back({*path, *entry});
  }
  return read;
}

// `route` is what was read, `layer` the position of the layer.
absl::Status StatusOf(const RouteFault& fault, const Plan& plan, const Route& route,
                      const PathNames& names, const FieldPath& layer) {
  const std::string list = layer.text() + ".initial_route";
  if (fault.kind == RouteFault::Kind::kMissing) {
    return Fault(list, names.NameOf(fault.other) + " is not visited");
  }
  const std::string place = absl::StrCat(list, "[", fault.visit, "]");
  const Visit& visit = route[fault.visit];
  if (fault.kind == RouteFault::Kind::kEntry) {
    // Others are no entries of any path: EntryOf.
    return plan.paths[static_cast<size_t>(visit.path)].kind == Path::Kind::kOpen
               ? Fault(place + ".reversed", "the path is one-way")
               : Fault(place + ".vertex",
                       absl::StrCat(visit.entry, " is not among the contour's entries"));
  }
  const std::string name = names.NameOf(visit.path);
  if (fault.kind == RouteFault::Kind::kRepeated) {
    const auto first = std::find_if(route.begin(), route.end(),
                                    [&](const Visit& other) { return other.path == visit.path; });
    return Fault(place, absl::StrCat(name, " is visited before, by initial_route[",
                                     first - route.begin(), "]"));
  }
  return Fault(place, absl::StrCat(name, " comes too early: ", names.NameOf(fault.other),
                                   " must come before it"));
}

}  // namespace

absl::Status SetInitialRoute(const v1::Layer& message, const FieldPath& place, Budget* budget,
                             JobLayer& layer) {
  if (message.initial_route().empty()) return absl::OkStatus();
  Rest rest(budget);
  const PathNames names(message, rest);
  ReadVisits read = ReadRoute(message, layer.plan, names, place, rest);
  const std::optional<RouteFault> fault = FindRouteFault(layer.plan, read.route, budget);
  // What ends too soon because it could not be read further is at fault there.
  const bool is_cut = fault && fault->kind == RouteFault::Kind::kMissing && !read.end.ok();
  if (fault && !is_cut) return StatusOf(*fault, layer.plan, read.route, names, place);
  layer.initial_route = std::move(read.route);
  return read.end;
}

}  // namespace traverse
