// What may change in a layer, path by path and pair by pair: what its plan says as a tree.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_LAYER_FREEDOM_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_LAYER_FREEDOM_H_

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace traverse {

struct GcodeFile;

namespace gcode {

enum class Policy : uint8_t;
struct Allowance;
struct Layer;

struct PathRule {
  bool pinned = false;   // stays where and as it is
  bool contour = false;  // closed; else an open path
  bool one_way = false;
  std::vector<uint32_t> entries;  // contour: where it may begin; empty for anywhere

  // The same of a contour of so many vertices, one by one: how many places, and the k-th of them.
  size_t StartCount(size_t vertices) const { return entries.empty() ? vertices : entries.size(); }
  uint32_t Start(size_t k) const { return entries.empty() ? static_cast<uint32_t>(k) : entries[k]; }
};

struct LayerFreedom {
  std::vector<PathRule> rules;   // [path]
  std::vector<uint32_t> group;   // [path] which it does not leave; they ascend
  std::vector<bool> goes_on;     // [path] comes directly behind the path before it
  std::vector<uint32_t> island;  // [path] the region of touching paths that it lies in
  std::vector<std::pair<uint32_t, uint32_t>> ordered;  // the first of them comes before the second
};

// What the plan of a layer allows, without the plan.
LayerFreedom FreedomOf(const GcodeFile& file, const Layer& layer, Policy policy,
                       const Allowance& allow);

}  // namespace gcode
}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_LAYER_FREEDOM_H_
