#include "engine/weller/tabu/swap_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/weller/tabu/swap_table.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

// Rules that forbid about half of all links.
struct RandomRules {
  RandomRules(const Plan& plan, uint64_t seed) : relation(static_cast<int>(plan.paths.size()) + 1) {
    Rng rng(seed);
    for (int a = 0; a < relation.node_count(); ++a) {
      if (a + 1 < relation.node_count()) rules.node_of.push_back(a);
      for (int b = 0; b < a; ++b) {
        if (rng.Below(2) == 0) relation.Link(a, b);
      }
    }
    rules.start_node = static_cast<int>(plan.paths.size());
    rules.linked = &relation;
    rules.penalty_mm = 10;
  }

  SymmetricRelation relation;
  LinkRules rules;
};

double Recomputed(const LayerProblem& problem, const LinkRules& rules, const SwapSequence& state) {
  const double penalty = TravelCost(problem.cost).OfLength(rules.penalty_mm);
  return RouteCost(problem, state.Unload()) + state.PenalizedLinks() * penalty;
}

SwapMove RandomSwap(const SwapSequence& state, Rng& rng) {
  const auto& nodes = state.tree().movable_nodes();
  const int node = nodes[rng.Below(uint32_t(nodes.size()))];
  const int i = rng.Between(0, state.tree().child_count(node) - 2);
  return state.Evaluate(node, i, rng.Between(i + 1, state.tree().child_count(node) - 1));
}

TEST(SwapSequence, DeltaEqualsRecomputedCost) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 12, .max_vertices = 9});
    const RandomRules random(owned.plan(), seed);
    SwapSequence state(owned.problem, random.rules);
    if (state.tree().movable_nodes().empty()) continue;
    EXPECT_NEAR(state.cost(), Recomputed(owned.problem, random.rules, state), 1e-9);
    Rng rng(seed);
    for (int step = 0; step < 20; ++step) {
      const SwapMove move = RandomSwap(state, rng);
      const double predicted = state.cost() + move.delta;
      const int violations = state.tree().violations() + move.violations;

      state.Apply(move);

      EXPECT_DOUBLE_EQ(state.cost(), predicted);
      EXPECT_EQ(state.tree().violations(), violations);
      EXPECT_NEAR(state.cost(), Recomputed(owned.problem, random.rules, state), 1e-6);
    }
  }
}

TEST(SwapSequence, TwoSwapsOfTheSameChildrenRestoreTheOrder) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 12});
    const LinkRules rules;
    SwapSequence state(owned.problem, rules);
    if (state.tree().movable_nodes().empty()) continue;
    const std::vector<int> order = state.tree().Paths();
    Rng rng(seed);
    const SwapMove move = RandomSwap(state, rng);

    state.Apply(move);
    state.Apply(state.Evaluate(move.node, move.i, move.j));

    EXPECT_EQ(state.tree().Paths(), order);
  }
}

TEST(SwapSequence, ChoosesTheBestEntries) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 6});
    const LinkRules rules;
    SwapSequence state(owned.problem, rules);
    Rng rng(seed);

    state.Shuffle(rng);

    EXPECT_NEAR(state.cost(), testing::BestEntries(owned.problem, state.tree().Paths()).cost, 1e-9);
    const Route route = state.Unload();
    state.Load(GivenRoute(owned.plan()));
    state.Load(route);
    EXPECT_EQ(state.Unload(), route);
  }
}

// Four points on a line, visited 0 2 1 3: swapping 2 and 1 saves 2 mm of 5.
TEST(SwapSequence, OfPointsOnALine) {
  const OwnedProblem owned(testing::FlatPlan(4));
  const LinkRules rules;
  SwapSequence state(owned.problem, rules);
  state.Load({{0, 0}, {2, 0}, {1, 0}, {3, 0}});

  const SwapMove move = state.Evaluate(0, 1, 2);

  EXPECT_DOUBLE_EQ(state.cost(), 5);
  EXPECT_DOUBLE_EQ(move.delta, -2);
}

// Of many entries those nearest to either neighbor are tried.
TEST(SwapSequence, PlacesAPathOfManyEntriesAtThoseNearestToItsNeighbors) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const auto point = [&rng](double size) {
      return Point{size * (rng.Unit() - 0.5), size * (rng.Unit() - 0.5)};
    };
    std::vector<Point> many;
    for (int k = 0; k < 30; ++k) many.push_back(point(10));
    const Point before = point(60);
    const Point after = point(60);
    const OwnedProblem owned(testing::AnyOrderPlan(
        {MakeContour({before}), MakeContour(std::vector<Point>(many)), MakeContour({after})}));
    const LinkRules rules;
    const SwapSequence state(owned.problem, rules);
    const auto nearest = [&many](Point to) {
      return *std::min_element(many.begin(), many.end(), [to](Point a, Point b) {
        return Distance(a, to) < Distance(b, to);
      });
    };
    const auto cost = [&](Point at) { return Distance(before, at) + Distance(at, after); };
    const int node = state.tree().child_at(0, 1);

    const double placed = state.PlacedCost(node, state.entry_before(node), state.entry_after(node));

    EXPECT_DOUBLE_EQ(placed, std::min(cost(nearest(before)), cost(nearest(after))));
  }
}

TEST(SwapSequence, EntersAPathAnewAtTheBestOfItsOtherVertices) {
  Rng rng(1);
  std::vector<Path> squares;
  for (int i = 0; i < 8; ++i) {
    std::vector<Point> points;
    for (int k = 0; k < 5; ++k) points.push_back({20 * rng.Unit(), 20 * rng.Unit()});
    squares.push_back(MakeContour(std::move(points)));
  }
  const OwnedProblem owned(testing::AnyOrderPlan(std::move(squares)));
  const LinkRules rules;
  SwapSequence state(owned.problem, rules);
  state.Shuffle(rng, false);
  const Route route = state.Unload();
  for (size_t at = 0; at < route.size(); ++at) {
    const int leaf = state.tree().child_at(0, static_cast<int>(at));
    double best = std::numeric_limits<double>::infinity();
    for (int entry = 0; entry < 5; ++entry) {
      Route other = route;
      other[at].entry = entry;
      if (entry != route[at].entry) best = std::min(best, RouteCost(owned.problem, other));
    }

    const std::optional<SwapMove> move = state.EvaluateReentry(leaf);

    ASSERT_TRUE(move.has_value());
    EXPECT_NEAR(state.cost() + move->delta, best, 1e-9);
    state.Apply(*move);
    EXPECT_NEAR(RouteCost(owned.problem, state.Unload()), best, 1e-9);
    state.Load(route);
  }
}

// With the penalty of figure 4.3: the link 0-1 is against the neighborhood.
TEST(SwapSequence, CountsPenalties) {
  const OwnedProblem owned(testing::FlatPlan(3));
  SymmetricRelation relation(3);
  relation.Link(1, 2);
  const LinkRules rules{.node_of = {0, 1, 2}, .linked = &relation};

  SwapSequence state(owned.problem, rules);

  EXPECT_EQ(state.PenalizedLinks(), 1);
  EXPECT_DOUBLE_EQ(state.cost(), 102);
}

TEST(SwapTable, AgreesWithEvaluationAfterEverySwap) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 12, .max_vertices = 9});
    const RandomRules random(owned.plan(), seed);
    SwapSequence state(owned.problem, random.rules);
    std::vector<SwapTable> tables;
    for (const int node : state.tree().movable_nodes()) tables.emplace_back(state, node);
    if (tables.empty()) continue;
    Rng rng(seed);
    for (int step = 0; step < 20; ++step) {
      for (SwapTable& table : tables) {
        table.Update(step);
        for (int i = 0; i < state.tree().child_count(table.node()); ++i) {
          table.ForRow(i, [&](int j, double delta) {
            EXPECT_NEAR(delta, state.Evaluate(table.node(), i, j).delta, 1e-9);
          });
        }
      }
      if (step % 7 == 6) {
        state.Shuffle(rng);
      } else {
        state.Apply(RandomSwap(state, rng));
      }
    }
  }
}

}  // namespace
}  // namespace traverse
