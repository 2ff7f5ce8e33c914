#include "tests/engine/schedule/hard_shapes.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "engine/base/rng.h"
#include "tests/support/problems/instances.h"

namespace traverse::testing {
namespace {

PlanNode Leaf(int path) { return PlanNode{PlanNode::Kind::kPath, path, {}, {}}; }

Path Dot(double x, double y) { return MakeContour({{x, y}}); }

// `n` contours of one point, all over the plate.
Plan Dots(int n) {
  Rng rng(1);
  std::vector<Path> paths;
  for (int i = 0; i < n; ++i) paths.push_back(Dot(300 * rng.Unit(), 300 * rng.Unit()));
  return AnyOrderPlan(std::move(paths));
}

Plan EqualDots(int n) {
  return AnyOrderPlan(std::vector<Path>(static_cast<size_t>(n), Dot(100, 100)));
}

Plan DotsOnALine(int n) {
  std::vector<Path> paths;
  for (int i = 0; i < n; ++i)
    paths.push_back(Dot(1e-3 * static_cast<double>(i * int64_t{7919} % n), 50));
  return AnyOrderPlan(std::move(paths));
}

// Contours of `each` vertices on circles, `n` vertices in all, in sequential deposition.
Plan Circles(int n, int each) {
  Rng rng(2);
  std::vector<IslandPaths> islands;
  for (int left = n; left > 0; left -= each) {
    Path path;
    path.kind = Path::Kind::kContour;
    const double x = 300 * rng.Unit(), y = 300 * rng.Unit();
    for (int i = 0; i < each; ++i) {
      const double angle = 2 * M_PI * i / each;
      path.points.push_back({x + 40 * std::cos(angle), y + 40 * std::sin(angle)});
    }
    islands.push_back({{std::move(path)}, {}});
  }
  return SequentialPlan(std::move(islands));
}

// One island of one contour and `n` rasters.
Plan Hatch(int n) {
  IslandPaths island;
  Path outline;
  outline.kind = Path::Kind::kContour;
  outline.points = {{0, 0}, {0.01 * n, 0}, {0.01 * n, 100}, {0, 100}};
  island.contours.push_back(std::move(outline));
  for (int i = 0; i < n; ++i) {
    Path raster;
    raster.kind = Path::Kind::kOpen;
    raster.points = {{0.01 * i, 1}, {0.01 * i, 99}};
    island.rasters.push_back(std::move(raster));
  }
  return SequentialPlan({std::move(island)});
}

// `n` nodes in columns of 90, one within the other, with two dots in each column's last.
Plan DeepNodes(int n) {
  constexpr int kDepth = 90;
  Rng rng(3);
  Plan plan;
  plan.nodes.push_back({PlanNode::Kind::kAnyOrder, 0, {}, {}});
  while (static_cast<int>(plan.nodes.size()) < n) {
    plan.nodes[0].children.push_back(static_cast<int>(plan.nodes.size()));
    for (int d = 0; d < kDepth; ++d) {
      const int next = static_cast<int>(plan.nodes.size()) + 1;
      const auto kind = d % 2 == 0 ? PlanNode::Kind::kAnyOrder : PlanNode::Kind::kInOrder;
      plan.nodes.push_back({kind, 0, {next}, {}});
    }
    plan.nodes.back().kind = PlanNode::Kind::kAnyOrder;
    plan.nodes.back().children.push_back(static_cast<int>(plan.nodes.size()) + 1);
    for (int i = 0; i < 2; ++i) {
      plan.nodes.push_back(Leaf(static_cast<int>(plan.paths.size())));
      plan.paths.push_back(Dot(300 * rng.Unit(), 300 * rng.Unit()));
    }
  }
  return plan;
}

// Half of `n` dots before a node without paths, and that before the others.
Plan Barrier(int n) {
  Plan plan = Dots(n);
  plan.nodes.push_back({PlanNode::Kind::kInOrder, 0, {}, {}});
  plan.nodes[0].children.push_back(static_cast<int>(plan.nodes.size()) - 1);
  for (int i = 0; i < n; ++i) {
    plan.nodes[0].before.push_back(i < n / 2 ? std::pair(i, n) : std::pair(n, i));
  }
  return plan;
}

// Eight times two dots, each pair with `n` / 8 nodes without paths in a chain of pairs.
Plan EmptyChains(int n) {
  Plan plan = Dots(16);
  plan.nodes.assign(1, {PlanNode::Kind::kAnyOrder, 0, {}, {}});
  for (int part = 0; part < 8; ++part) {
    const size_t node = plan.nodes.size();
    plan.nodes[0].children.push_back(static_cast<int>(node));
    plan.nodes.push_back({PlanNode::Kind::kAnyOrder, 0, {}, {}});
    for (int i = 0; i < n / 8; ++i) {
      plan.nodes[node].children.push_back(static_cast<int>(plan.nodes.size()));
      if (i > 0) plan.nodes[node].before.emplace_back(i - 1, i);
      plan.nodes.push_back(i == 0           ? Leaf(2 * part)
                           : i == n / 8 - 1 ? Leaf(2 * part + 1)
                                            : PlanNode{PlanNode::Kind::kInOrder, 0, {}, {}});
    }
  }
  return plan;
}

// Dots in the order that they are in: as many stages, of one each.
Plan FixedOrder(int n) {
  Plan plan = Dots(n);
  plan.nodes[0].kind = PlanNode::Kind::kInOrder;
  return plan;
}

// Dots by twos: the twos in one kind of order, and the dots of each in another.
Plan Twos(int n, PlanNode::Kind outer, PlanNode::Kind inner) {
  Plan plan = Dots(n / 2 * 2);
  plan.nodes.assign(1, {outer, 0, {}, {}});
  for (int i = 0; i < n / 2; ++i) {
    const int node = static_cast<int>(plan.nodes.size());
    plan.nodes[0].children.push_back(node);
    plan.nodes.push_back({inner, 0, {node + 1, node + 2}, {}});
    plan.nodes.push_back(Leaf(2 * i));
    plan.nodes.push_back(Leaf(2 * i + 1));
  }
  return plan;
}

// Dots each of which comes before the next one.
Plan ChainOfPairs(int n) {
  Plan plan = Dots(n);
  for (int i = 1; i < n; ++i) plan.nodes[0].before.emplace_back(i - 1, i);
  return plan;
}

// Fours of dots in order, of any order of two twos of any order: each has gates before it.
Plan BlocksInOrder(int n) {
  Plan plan = Dots(n / 4 * 4);
  plan.nodes.assign(1, {PlanNode::Kind::kInOrder, 0, {}, {}});
  const auto add = [&](int parent, PlanNode node) {
    const int index = static_cast<int>(plan.nodes.size());
    plan.nodes[static_cast<size_t>(parent)].children.push_back(index);
    plan.nodes.push_back(std::move(node));
    return index;
  };
  for (int i = 0; i + 4 <= n; i += 4) {
    const int four = add(0, {PlanNode::Kind::kAnyOrder, 0, {}, {}});
    for (int two = 0; two < 2; ++two) {
      const int block = add(four, {PlanNode::Kind::kAnyOrder, 0, {}, {}});
      for (int dot = 0; dot < 2; ++dot) add(block, Leaf(i + 2 * two + dot));
    }
  }
  return plan;
}

}  // namespace

const std::vector<Shape>& HardShapes() {
  static const auto* const shapes = new std::vector<Shape>{
      {"Dots", Dots, 1'000'000},
      {"EqualDots", EqualDots, 1'000'000},
      {"DotsOnALine", DotsOnALine, 1'000'000},
      {"OneContour", [](int n) { return Circles(n, n); }, 1'000'000},
      {"LargeContours", [](int n) { return Circles(n, n / 10); }, 1'000'000},
      {"SmallContours", [](int n) { return Circles(n, 20); }, 1'000'000},
      {"Hatch", Hatch, 450'000},
      {"DeepNodes", DeepNodes, 1'000'000},
      {"Barrier", Barrier, 1'000'000},
      {"EmptyChains", EmptyChains, 1'000'000},
      {"FixedOrder", FixedOrder, 1'000'000},
      {"TwosInOrder",
       [](int n) { return Twos(n, PlanNode::Kind::kInOrder, PlanNode::Kind::kAnyOrder); },
       1'000'000},
      {"BlocksOfTwo",
       [](int n) { return Twos(n, PlanNode::Kind::kAnyOrder, PlanNode::Kind::kInOrder); },
       1'000'000},
      {"ChainOfPairs", ChainOfPairs, 1'000'000},
      {"BlocksInOrder", BlocksInOrder, 1'000'000},
  };
  return *shapes;
}

}  // namespace traverse::testing
