#include "engine/schedule/end_history.h"

#include <bit>
#include <cmath>

#include "engine/base/rng.h"

namespace traverse {
namespace {

class Fingerprint {
 public:
  void Add(uint64_t value) { state_ = (std::rotl(state_, 23) ^ value) * 0x9e3779b97f4a7c15u; }
  void Add(int value) { Add(static_cast<uint64_t>(static_cast<int64_t>(value))); }
  // 0 and -0 are the same.
  void Add(double value) { Add(std::bit_cast<uint64_t>(value + 0.0)); }

  uint64_t value() {
    uint64_t state = state_;
    return SplitMix64(state);
  }

 private:
  uint64_t state_ = 1;
};

constexpr double kUnitsPerMm = 1e4;

}  // namespace

Point PlanOrigin(const Plan& plan) {
  return plan.paths.empty() || plan.paths[0].points.empty() ? Point{} : plan.paths[0].points[0];
}

uint64_t PlanFingerprint(const Plan& plan) {
  Fingerprint print;
  const Point origin = PlanOrigin(plan);
  for (const Path& path : plan.paths) {
    print.Add(static_cast<int>(path.kind) * 2 + (path.one_way ? 1 : 0));
    print.Add(path.points.size());
    for (const Point& point : path.points) {
      print.Add(std::floor((point.x - origin.x) * kUnitsPerMm + 0.5));
      print.Add(std::floor((point.y - origin.y) * kUnitsPerMm + 0.5));
    }
    for (const int vertex : path.allowed) print.Add(vertex);
  }
  for (const PlanNode& node : plan.nodes) {
    print.Add(static_cast<int>(node.kind));
    print.Add(node.path);
    print.Add(node.children.size());
    for (const int child : node.children) print.Add(child);
    for (const auto& [first, second] : node.before) {
      print.Add(first);
      print.Add(second);
    }
  }
  return print.value();
}

}  // namespace traverse
