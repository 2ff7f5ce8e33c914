// The parts that benchmarks run on: the DAMAT files beside them, and rows of rings for growth.

#ifndef TRAVERSE_TESTS_BENCH_LAYERS_BENCH_PART_H_
#define TRAVERSE_TESTS_BENCH_LAYERS_BENCH_PART_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "engine/model/plan.h"

namespace traverse::bench {

struct BenchPart {
  std::string name;
  std::vector<Plan> layers;

  // Travel in mm over these layers, by the keys of tests/bench/reference.json; empty if the part is
  // not in it.
  std::map<std::string, double> reference;

  // The proven optimum of each layer, for the starts of the reference's chain; empty if not known.
  std::vector<double> proven_mm;
};

// Every part of tests/bench/instances that reference.json knows, with the layers that it measures,
// in the order of size. `only`: a part of the names; empty for all.
absl::StatusOr<std::vector<BenchPart>> BundledParts(const std::vector<std::string>& only);

// A layer of `contours` contours of `vertices` vertices at random places that do not meet, each
// with a raster across. The same for the same arguments.
Plan RandomRings(int contours, int vertices, uint64_t seed);

}  // namespace traverse::bench

#endif  // TRAVERSE_TESTS_BENCH_LAYERS_BENCH_PART_H_
