#include "engine/strategy/options/framework_options.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace traverse {

std::vector<OptionSpec> FrameworkOptionSpecs(const char* of) {
  using Type = OptionSpec::Type;
  const auto said = [&](OptionSpec spec) {
    spec.description = absl::StrCat(of, spec.description);
    return spec;
  };
  return {
      said(OptionSpec{
          "representation",
          Type::kChoice,
          "bbcp",
          0,
          0,
          {"sp", "nrp", "bbcp"},
          "The points of a contour in the preliminary sequence: spaced points (sp), points near "
          "the ends of the island's rasters (nrp), or the center of its bounding box (bbcp)."}),
      said(NumberOption("spacing_mm", Type::kDouble, "2.5", 0, 1000,
                        "Least distance between spaced points of a contour (Dp), in mm.")),
      said(NumberOption("neighbors", Type::kInt, "2", 1, 100,
                        "Contours that the growing circle around a contour must meet.")),
      said(NumberOption(
          "first_radius_mm", Type::kDouble, "0", 0, 1000,
          "First radius of that circle, in mm; 0: the shorter side of the bounding box.")),
      said(NumberOption("radius_step_mm", Type::kDouble, "5", 0.001, 1000,
                        "Step by which the circle grows, in mm.")),
      said(SwitchOption("trace", "false",
                        "Return the neighborhoods, the preliminary sequence and the visible points "
                        "as statistics trace_*, by path number."))};
}

FrameworkOptions FrameworkOptionsFrom(const StrategyOptions& values) {
  FrameworkOptions options;
  options.representation = RepresentationNamed(values.Choice("representation"));
  options.spacing_mm = values.Double("spacing_mm");
  options.neighborhood.neighbors = static_cast<int>(values.Int("neighbors"));
  options.neighborhood.first_radius_mm = values.Double("first_radius_mm");
  options.neighborhood.step_mm = values.Double("radius_step_mm");
  options.trace = values.Bool("trace");
  return options;
}

void DescribeFramework(const FrameworkResult& result, const FrameworkOptions& options,
                       std::map<std::string, double>& statistics) {
  statistics["points_entries"] = result.points.entries;
  statistics["points_island_analysis"] = result.points.island_analysis;
  statistics["points_sp"] = result.points.spaced;
  statistics["points_bbcp"] = result.points.box_center;
  statistics["points_vp"] = result.points.visible;
  if (options.representation == Representation::kNearRasterPoints) {
    statistics["points_nrp"] = result.points.near_raster;
  }
  for (const auto& [a, b] : result.trace.neighbors) {
    statistics[absl::StrFormat("trace_neighbors_%d_%d", a, b)] = 1;
  }
  for (size_t k = 0; k < result.trace.sequence.size(); ++k) {
    statistics[absl::StrFormat("trace_sequence_%03d", k)] = result.trace.sequence[k];
  }
  for (const auto& [path, vertex] : result.trace.visible) {
    statistics[absl::StrFormat("trace_visible_%d_%d", path, vertex)] = 1;
  }
  for (int step = 0; step < 3; ++step) {
    statistics[absl::StrCat("step", step + 2, "_seconds")] = result.step_seconds[step];
  }
}

OptionSpec NumberOption(const char* name, OptionSpec::Type type, const char* default_value,
                        double minimum, double maximum, const char* description) {
  return OptionSpec{name, type, default_value, minimum, maximum, {}, description};
}

OptionSpec SwitchOption(const char* name, const char* default_value, const char* description) {
  return OptionSpec{name, OptionSpec::Type::kBool, default_value, 0, 0, {}, description};
}

}  // namespace traverse
