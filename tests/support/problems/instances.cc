#include "tests/support/problems/instances.h"

#include <utility>

#include "engine/base/rng.h"

namespace traverse::testing {
namespace {

Path Square(Point corner, double side) {
  return MakeContour({corner,
                      {corner.x + side, corner.y},
                      {corner.x + side, corner.y + side},
                      {corner.x, corner.y + side}});
}

}  // namespace

Plan AnyOrderPlan(std::vector<Path> paths) {
  Plan plan{std::move(paths), {PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}}}};
  for (int p = 0; p < static_cast<int>(plan.paths.size()); ++p) {
    plan.nodes[0].children.push_back(p + 1);
    plan.nodes.push_back(PlanNode{PlanNode::Kind::kPath, p, {}, {}});
  }
  return plan;
}

Plan FlatPlan(int paths) {
  std::vector<Path> contours;
  for (int p = 0; p < paths; ++p) contours.push_back(MakeContour({{static_cast<double>(p), 0}}));
  return AnyOrderPlan(std::move(contours));
}

Plan ClusterPlan(int n) {
  Rng rng(4);
  std::vector<Path> paths;
  for (int i = 0; i < n; ++i) {
    const Point corner{300 * rng.Unit(), 300 * rng.Unit()};
    std::vector<Point> points;
    for (int k = 0; k < 5; ++k) {
      points.push_back({corner.x + 40 * rng.Unit(), corner.y + 40 * rng.Unit()});
    }
    paths.push_back(MakeContour(std::move(points)));
  }
  return AnyOrderPlan(std::move(paths));
}

std::vector<IslandPaths> SquareGrid(int columns, int rows) {
  std::vector<IslandPaths> islands;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Point corner{4.0 * column, 4.0 * row};
      islands.push_back(
          {{Square(corner, 1)},
           {MakeOpenPath({corner.x + 0.25, corner.y + 0.5}, {corner.x + 0.75, corner.y + 0.5})}});
    }
  }
  return islands;
}

std::vector<IslandPaths> PlateWithHoles() {
  return {{{Square({0, 0}, 20), Square({3, 3}, 2), Square({15, 3}, 2), Square({15, 15}, 2),
            Square({3, 15}, 2)},
           {MakeOpenPath({1, 1}, {19, 2}), MakeOpenPath({1, 10}, {19, 11}),
            MakeOpenPath({1, 18}, {19, 19})}}};
}

}  // namespace traverse::testing
