#include "tests/bench/layers/bench_part.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <utility>

#include "absl/status/status.h"
#include "client/formats/read_input.h"
#include "client/input/input_job.h"
#include "engine/base/rng.h"
#include "nlohmann/json.hpp"
#include "server/translate/translate.h"
#include "tests/support/source_dir.h"

namespace traverse::bench {
namespace {

// The last of the layers that a reference is for, such as 5 of "1-5".
size_t LastLayer(const std::string& layers) {
  return static_cast<size_t>(std::stoi(layers.substr(layers.find('-') + 1)));
}

absl::StatusOr<BenchPart> LoadPart(const std::string& name, const nlohmann::json& reference) {
  std::string file = std::string(TRAVERSE_SOURCE_DIR "/tests/bench/instances/") + name + ".damat";
  if (!std::filesystem::exists(file)) file += ".xz";
  absl::StatusOr<InputJob> job = ReadInput(file);
  if (!job.ok()) return job.status();
  BenchPart part;
  part.name = name;
  const size_t count = std::min(job->layers.size(), LastLayer(reference["layers"]));
  for (size_t i = 0; i < count; ++i) {
    absl::StatusOr<LabelledLayer> layer = LayerFromProto(job->layers[i], i, false);
    if (!layer.ok()) return layer.status();
    part.layers.push_back(std::move(layer->layer.plan));
  }
  for (const auto& [key, value] : reference.items()) {
    if (value.is_number()) part.reference[key] = value.get<double>();
  }
  if (const auto proven = reference.find("proven_by_layer"); proven != reference.end()) {
    part.proven_mm = proven->get<std::vector<double>>();
  }
  return part;
}

}  // namespace

absl::StatusOr<std::vector<BenchPart>> BundledParts(const std::vector<std::string>& only) {
  std::ifstream file(TRAVERSE_SOURCE_DIR "/tests/bench/reference.json");
  const nlohmann::json references = nlohmann::json::parse(file, nullptr, false);
  if (references.is_discarded()) return absl::DataLossError("tests/bench/reference.json");
  std::vector<BenchPart> parts;
  for (const auto& [name, reference] : references.items()) {
    if (!only.empty() && std::find(only.begin(), only.end(), name) == only.end()) continue;
    absl::StatusOr<BenchPart> part = LoadPart(name, reference);
    if (!part.ok()) return part.status();
    parts.push_back(*std::move(part));
  }
  std::stable_sort(parts.begin(), parts.end(), [](const BenchPart& a, const BenchPart& b) {
    return a.layers[0].paths.size() < b.layers[0].paths.size();
  });
  return parts;
}

Plan RandomRings(int contours, int vertices, uint64_t seed) {
  // A jittered grid: places at random that do not meet, without a search for them.
  const int columns = static_cast<int>(std::ceil(std::sqrt(contours)));
  Rng rng(seed);
  IslandPaths island;
  for (int i = 0; i < contours; ++i) {
    const double radius = 1.5 + 2.5 * rng.Unit();
    const Point center{10.0 * (i % columns) + (10 - 2 * radius) * rng.Unit() + radius,
                       10.0 * (i / columns) + (10 - 2 * radius) * rng.Unit() + radius};
    std::vector<Point> ring;
    for (int v = 0; v < vertices; ++v) {
      const double angle = 2 * std::numbers::pi * v / vertices;
      ring.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
    }
    island.contours.push_back(MakeContour(std::move(ring)));
    island.rasters.push_back(
        MakeOpenPath({center.x - radius / 2, center.y}, {center.x + radius / 2, center.y}));
  }
  return SequentialPlan({std::move(island)});
}

}  // namespace traverse::bench
