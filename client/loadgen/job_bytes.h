// The jobs to send, as bytes: serialised once, so that the generator uses little of the
// machine.

#ifndef TRAVERSE_CLIENT_LOADGEN_JOB_BYTES_H_
#define TRAVERSE_CLIENT_LOADGEN_JOB_BYTES_H_

#include <grpcpp/support/byte_buffer.h>

#include <cstdint>

#include "absl/types/span.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/plan.pb.h"

namespace traverse::loadgen {

// A layer generated from a seed: `islands` islands on a plate of 200 x 200 mm, each one contour of
// 12 vertices, a hole of 8 and 4 rasters: 28 points, 6 paths.
v1::Layer MadeUpLayer(uint64_t seed, int islands);

// An OptimizeBatchRequest of `layers` layers, taken from `parts` in turn. REQUIRES: `parts` is not
// empty.
grpc::ByteBuffer JobBytes(const v1::JobOptions& options, absl::Span<const v1::Layer> parts,
                          int layers);

}  // namespace traverse::loadgen

#endif  // TRAVERSE_CLIENT_LOADGEN_JOB_BYTES_H_
