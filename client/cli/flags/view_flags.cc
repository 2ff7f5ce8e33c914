#include "client/cli/flags/view_flags.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <system_error>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/str_format.h"
#include "client/cli/help.h"
#include "client/cli/service.h"
#include "client/files/write_file.h"
#include "client/gcode/parallel.h"
#include "client/view/drawing/picture.h"
#include "client/view/report_page.h"
#include "client/view/scene/scene.h"

namespace traverse::cli {
namespace {

// OK if the folder of `name` exists, so that a file can be made there.
absl::Status CheckFolder(const std::string& flag, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(name).parent_path();
  std::error_code error;
  if (folder.empty() || std::filesystem::is_directory(folder, error)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("--%s=%s: no such folder: %s", flag, name, folder.string()));
}

}  // namespace

std::vector<Flag> ViewFlagTable() {
  return {
      {"report", "FILE.html", "write a page that shows the layers"},
      {"picture", "FILE.svg|png", "draw a layer before and after"},
      {"layer", "N", "layer to draw (default: most saved)"},
  };
}

absl::StatusOr<ViewFlags> ParseViewFlags(const Flags& flags) {
  ViewFlags out;
  out.picture = flags.Text("picture");
  if (flags.Has("picture")) {
    if (!view::PictureFormatOf(out.picture)) {
      return absl::InvalidArgumentError(
          absl::StrFormat("--picture=%s: does not end in .svg or .png", out.picture));
    }
    if (absl::Status status = CheckFolder("picture", out.picture); !status.ok()) return status;
  } else if (flags.Has("layer")) {
    return absl::InvalidArgumentError("--layer needs --picture");
  }
  out.report = flags.Text("report");
  if (flags.Has("report")) {
    // Another name may well be the input's, which the report would replace.
    const std::string lower = absl::AsciiStrToLower(out.report);
    if (!lower.ends_with(".html") && !lower.ends_with(".htm")) {
      return absl::InvalidArgumentError(
          absl::StrFormat("--report=%s: does not end in .html", out.report));
    }
    if (absl::Status status = CheckFolder("report", out.report); !status.ok()) return status;
  }
  const auto layer = flags.Integer("layer", 1, std::numeric_limits<uint32_t>::max());
  if (!layer.ok()) return layer.status();
  out.layer = *layer;
  return out;
}

absl::Status CheckViewLayer(const ViewFlags& flags, const InputJob& job) {
  if (!flags.any()) return absl::OkStatus();
  const size_t first = job.first_layer + 1;
  const size_t last = job.first_layer + job.layers.size();
  if (flags.layer && (*flags.layer < first || *flags.layer > last)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("--layer=%d: not one of the layers %d to %d", *flags.layer, first, last));
  }
  if (job.layers.empty())
    return absl::InvalidArgumentError(absl::StrFormat(
        "--%s: the file has no layers", flags.picture.empty() ? "report" : "picture"));
  return absl::OkStatus();
}

Expected<report::JobRun> RunAsGiven(Service& service, const JobFlags& flags, const InputJob& job) {
  StrategySpec none;
  none.label = "as given";
  none.strategy.set_name("none");
  const bool knows_routes =
      std::any_of(job.layers.begin(), job.layers.end(),
                  [](const v1::Layer& layer) { return !layer.initial_route().empty(); });
  if (!knows_routes) return service.Optimize(job, &none, flags, /*quiet=*/true);
  InputJob as_given = job;
  for (v1::Layer& layer : as_given.layers) layer.clear_initial_route();
  return service.Optimize(as_given, &none, flags, /*quiet=*/true);
}

absl::Status WriteViews(const ViewFlags& flags, const view::Scene& scene) {
  if (!flags.picture.empty()) {
    const size_t layer =
        flags.layer ? *flags.layer - 1 - scene.first_layer : view::LayerWithMostSaved(scene);
    const absl::Status status = WriteWholeFile(
        flags.picture, view::Picture(scene, layer, *view::PictureFormatOf(flags.picture)));
    if (!status.ok()) return status;
  }
  if (flags.report.empty()) return absl::OkStatus();
  return WriteWholeFile(
      flags.report, view::ReportPage(scene, "Made by " + VersionLine(), gcode::DefaultThreads()));
}

}  // namespace traverse::cli
