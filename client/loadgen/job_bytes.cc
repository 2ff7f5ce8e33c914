#include "client/loadgen/job_bytes.h"

#include <grpcpp/support/slice.h>

#include <cassert>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::loadgen {
namespace {

constexpr double kPlateMm = 200;
constexpr double kRadiusMm = 3;
constexpr double kHoleRadiusMm = 1;

void AddCircle(double x, double y, double radius, int vertices, v1::Island& island) {
  v1::Contour& contour = *island.add_contours();
  for (int i = 0; i < vertices; ++i) {
    const double angle = 2 * std::numbers::pi * i / vertices;
    contour.add_points(x + radius * std::cos(angle));
    contour.add_points(y + radius * std::sin(angle));
  }
}

}  // namespace

v1::Layer MadeUpLayer(uint64_t seed, int islands) {
  std::mt19937_64 random(seed);
  const auto place = [&random] {
    return static_cast<double>(random() >> 11) * 0x1.0p-53 * kPlateMm;
  };
  v1::Layer layer;
  layer.set_id(seed);
  for (int i = 0; i < islands; ++i) {
    const double x = place();
    const double y = place();
    v1::Island& island = *layer.add_islands();
    AddCircle(x, y, kRadiusMm, 12, island);
    AddCircle(x, y, kHoleRadiusMm, 8, island);
    for (const double offset : {-2.0, -1.5, 1.5, 2.0}) {
      v1::OpenPath& raster = *island.add_rasters();
      const double half = std::sqrt(kRadiusMm * kRadiusMm - offset * offset);
      for (const double value : {x - half, y + offset, x + half, y + offset}) {
        raster.add_points(value);
      }
    }
  }
  return layer;
}

grpc::ByteBuffer JobBytes(const v1::JobOptions& options, absl::Span<const v1::Layer> parts,
                          int layers) {
  assert(!parts.empty());
  v1::OptimizeBatchRequest request;
  *request.mutable_options() = options;
  for (int i = 0; i < layers; ++i) {
    *request.add_layers() = parts[static_cast<size_t>(i) % parts.size()];
  }
  const grpc::Slice slice(request.SerializeAsString());
  return grpc::ByteBuffer(&slice, 1);
}

}  // namespace traverse::loadgen
