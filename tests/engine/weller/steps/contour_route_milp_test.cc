// The layered graph of step 3 against the programme that the thesis has for it.

#include <gtest/gtest.h>

#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/proof/programs/mixed_program.h"
#include "engine/weller/steps/contour_route.h"
#include "tests/engine/weller/milp/milp_problems.h"
#include "tests/support/problems/instances.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

// Thesis 4.8-4.13, the columns of pairs of positions that do not follow each other left out.
double StepThreeByMilp(const Plan& plan, const std::vector<int>& order,
                       const std::vector<std::vector<int>>& vertices, Point start,
                       const TravelCost& travel) {
  MixedProgram program;
  std::vector<int> last_ranks = {program.AddBinary(0, true)};
  std::vector<Point> last_points = {start};
  for (size_t k = 0; k < order.size(); ++k) {
    std::vector<int> ranks;
    std::vector<Point> points;
    MixedProgram::Entries one;  // (4.9)
    for (const int vertex : vertices[k]) {
      points.push_back(
          plan.paths[static_cast<size_t>(order[k])].points[static_cast<size_t>(vertex)]);
      ranks.push_back(program.AddBinary(0));
      one.Add(ranks.back(), 1);
    }
    program.AddRow(1, 1, one);
    MixedProgram::Entries one_link;                                 // (4.12)
    std::vector<MixedProgram::Entries> of_last(last_ranks.size());  // (4.11)
    std::vector<MixedProgram::Entries> of_next(ranks.size());       // (4.11)
    for (size_t p = 0; p < last_ranks.size(); ++p) {
      for (size_t q = 0; q < ranks.size(); ++q) {
        const int link = program.AddBinary(travel(last_points[p], points[q]));
        MixedProgram::Entries both;  // (4.10)
        both.Add(link, 1);
        both.Add(last_ranks[p], -1);
        both.Add(ranks[q], -1);
        program.AddRow(-1, MixedProgram::kInfinity, both);
        one_link.Add(link, 1);
        of_last[p].Add(link, 1);
        of_next[q].Add(link, 1);
      }
    }
    program.AddRow(1, 1, one_link);
    for (size_t p = 0; p < last_ranks.size(); ++p) {
      of_last[p].Add(last_ranks[p], -1);
      program.AddRow(-MixedProgram::kInfinity, 0, of_last[p]);
    }
    for (size_t q = 0; q < ranks.size(); ++q) {
      of_next[q].Add(ranks[q], -1);
      program.AddRow(-MixedProgram::kInfinity, 0, of_next[q]);
    }
    last_ranks = ranks;
    last_points = points;
  }
  Budget budget;
  return program.Solve({}, {}, budget).value;
}

TEST(ChooseContourPoints, IsTheOptimumOfTheThesisModel) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const OwnedProblem owned = ContourProblem(rng, rng.Between(1, 6));
    const Plan& plan = owned.plan();
    std::vector<int> order;
    for (size_t i = 0; i < plan.paths.size(); ++i) order.push_back(static_cast<int>(i));
    const TravelCost travel(owned.problem.cost);
    const auto vertices = VisiblePointsAlong(plan, order, owned.problem.start, 2.5);

    const Route chosen = ChooseContourPoints(plan, order, vertices, owned.problem.start, travel);

    const double cost = RouteCost(owned.problem, chosen);
    EXPECT_NEAR(cost, StepThreeByMilp(plan, order, vertices, owned.problem.start, travel),
                kMilpTolerance * (1 + cost));
  }
}

}  // namespace
}  // namespace traverse
