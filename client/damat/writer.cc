#include "client/damat/writer.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

#include "absl/container/flat_hash_set.h"
#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/damat/format.h"
#include "client/damat/outer_contour.h"

namespace traverse {
namespace {

using Points = google::protobuf::RepeatedField<double>;

void AppendNumber(double value, std::string& out) {
  char digits[32];  // the longest double has 24
  out.append(digits, std::to_chars(digits, digits + sizeof(digits), value).ptr);
}

void AppendPoint(const Points& points, int i, std::string& out) {
  out += ",X";
  AppendNumber(points[2 * i], out);
  out += ",Y";
  AppendNumber(points[2 * i + 1], out);
}

absl::Status Refusal(const std::string& where, const char* what) {
  return absl::InvalidArgumentError(absl::StrFormat("%s: DAMAT cannot hold %s", where, what));
}

absl::Status CheckPoints(const Points& points, int least, const std::string& where) {
  if (points.size() % 2 == 0 && points.size() >= 2 * least) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s.points: %d numbers, not pairs of at least %d points", where, points.size(), least));
}

// Inserts an id; fails if it is already there.
absl::Status Claim(absl::flat_hash_set<uint64_t>& ids, uint64_t id, const std::string& where) {
  return ids.insert(id).second ? absl::OkStatus() : Refusal(where, "the same id twice");
}

absl::Status AppendContour(const v1::Contour& contour, const std::string& where, std::string& out) {
  if (contour.entries_size() > 0) return Refusal(where, "a limited choice of entries");
  if (absl::Status status = CheckPoints(contour.points(), 1, where); !status.ok()) return status;
  absl::StrAppendFormat(&out, "%c%d", damat::kContour, contour.id());
  const Points& points = contour.points();
  const int n = points.size() / 2;
  for (int i = 0; i < n; ++i) AppendPoint(points, i, out);
  // Readers drop a repeated closing vertex: a vertex meant to be there is written twice.
  if (n > 1 && points[0] == points[2 * n - 2] && points[1] == points[2 * n - 1]) {
    AppendPoint(points, 0, out);
  }
  out += '\n';
  return absl::OkStatus();
}

absl::Status AppendRaster(const v1::OpenPath& raster, const std::string& where, std::string& out) {
  if (raster.one_way()) return Refusal(where, "a one-way path");
  if (absl::Status status = CheckPoints(raster.points(), 2, where); !status.ok()) return status;
  absl::StrAppendFormat(&out, "%c%d", damat::kRaster, raster.id());
  AppendPoint(raster.points(), 0, out);
  AppendPoint(raster.points(), raster.points_size() / 2 - 1, out);
  out += '\n';
  return absl::OkStatus();
}

// The outer contour must be in front, where the API expects it, and the others inside it: otherwise
// reading would change the island, or refuse it.
absl::Status CheckOuter(const v1::Island& island, const std::string& where) {
  if (island.contours_size() < 2) return absl::OkStatus();
  const damat::OuterContour outer = damat::FindOuterContour(island);
  if (outer.index != 0) return Refusal(where, "an outer contour that is not the largest");
  return outer.outside.empty() ? absl::OkStatus()
                               : Refusal(where, "a contour outside the outer one");
}

absl::Status AppendIsland(const v1::Island& island, const std::string& where, std::string& out) {
  absl::StrAppendFormat(&out, "%c%d,%d,%d\n", damat::kIsland, island.id(), island.contours_size(),
                        island.rasters_size());
  if (absl::Status status = CheckOuter(island, where); !status.ok()) return status;
  absl::flat_hash_set<uint64_t> contour_ids, raster_ids;
  for (int i = 0; i < island.contours_size(); ++i) {
    const std::string at = absl::StrFormat("%s.contours[%d]", where, i);
    absl::Status status = Claim(contour_ids, island.contours(i).id(), at);
    if (status.ok()) status = AppendContour(island.contours(i), at, out);
    if (!status.ok()) return status;
  }
  for (int i = 0; i < island.rasters_size(); ++i) {
    const std::string at = absl::StrFormat("%s.rasters[%d]", where, i);
    absl::Status status = Claim(raster_ids, island.rasters(i).id(), at);
    if (status.ok()) status = AppendRaster(island.rasters(i), at, out);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status AppendLayer(const v1::Layer& layer, const std::string& where, std::string& out) {
  if (layer.has_plan()) return Refusal(where, "a plan, only islands");
  if (layer.has_start()) return Refusal(where, "a start of the layer's own");
  if (layer.has_cost()) return Refusal(where, "a cost of the layer's own");
  absl::StrAppendFormat(&out, "%c%d,%d\n", damat::kLayer, layer.id(), layer.islands_size());
  absl::flat_hash_set<uint64_t> ids;
  for (int i = 0; i < layer.islands_size(); ++i) {
    const std::string at = absl::StrFormat("%s.islands[%d]", where, i);
    absl::Status status = Claim(ids, layer.islands(i).id(), at);
    if (status.ok()) status = AppendIsland(layer.islands(i), at, out);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

// Widens `corner` so that it encloses `points`.
void Widen(const Points& points, v1::Point& corner) {
  for (int i = 0; i + 1 < points.size(); i += 2) {
    corner.set_x_mm(std::max(corner.x_mm(), points[i]));
    corner.set_y_mm(std::max(corner.y_mm(), points[i + 1]));
  }
}

v1::Point Envelope(const InputJob& job) {
  if (job.envelope) return *job.envelope;
  v1::Point corner;
  for (const v1::Layer& layer : job.layers) {
    for (const v1::Island& island : layer.islands()) {
      for (const v1::Contour& contour : island.contours()) Widen(contour.points(), corner);
      for (const v1::OpenPath& raster : island.rasters()) Widen(raster.points(), corner);
    }
  }
  return corner;
}

// The thickness of all layers, if they are equally thick and the first one lies on the
// bed.
std::optional<double> ThicknessOf(const InputJob& job) {
  const double first = job.layers.empty() ? 0 : job.layers.front().z_mm();
  if (!(first > 0)) return std::nullopt;
  for (size_t i = 0; i < job.layers.size(); ++i) {
    if (job.layers[i].z_mm() != first * static_cast<double>(i + 1)) return std::nullopt;
  }
  return first;
}

}  // namespace

absl::StatusOr<std::string> WriteDamat(const InputJob& job) {
  std::string out(damat::kTitle);
  out += '\n';
  const v1::Point envelope = Envelope(job);
  out += damat::kEnvelope;
  out += ',';
  AppendNumber(envelope.x_mm(), out);
  out += ',';
  AppendNumber(envelope.y_mm(), out);
  out += '\n';
  if (const std::optional<double> thickness = ThicknessOf(job)) {
    absl::StrAppendFormat(&out, "%s,", damat::kThickness);
    AppendNumber(*thickness, out);
    out += '\n';
  }
  absl::StrAppendFormat(&out, "%s,%d\n", damat::kLayerCount, job.layers.size());
  absl::flat_hash_set<uint64_t> ids;
  for (size_t i = 0; i < job.layers.size(); ++i) {
    const std::string at = absl::StrFormat("layers[%d]", i);
    absl::Status status = Claim(ids, job.layers[i].id(), at);
    if (status.ok()) status = AppendLayer(job.layers[i], at, out);
    if (!status.ok()) return status;
  }
  return out;
}

}  // namespace traverse
