// Proofs against an integer programme for the whole layer that has nothing in common with them: a
// flow through positions, solved by Cbc.
//
//   y[p,e,k]        path p is done at position k, entered at e
//   z[p,e,q,f,k]    and path q follows it, entered at f
//   sum over q, f of z[p,e,q,f,k] = y[p,e,k],  sum over p, e of z[p,e,q,f,k] = y[q,f,k+1]
//   each path once; where i comes before j: sum k y[i,.,k] + 1 <= sum k y[j,.,k]

#include <gtest/gtest.h>

#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/proof/programs/mixed_program.h"
#include "engine/proof/walks/plan_stages.h"
#include "engine/proof/walks/stage_model.h"
#include "engine/proof/walks/stage_proof.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

struct Way {  // a path with an entry, at a position
  Visit visit;
  int column = 0;
};

class LayerProgram {
 public:
  explicit LayerProgram(const LayerProblem& problem)
      : problem_(problem), once_(problem.plan->paths.size()), places_(once_.size()) {
    const std::deque<PlanStage> stages = *StagesOf(*problem.plan, 100);
    for (const PlanStage& stage : stages) AddStage(stage);
    for (const auto& row : once_) program_.AddRow(1, 1, row);
  }

  double Solve() const {
    Budget budget;
    return program_.Solve({}, {}, budget).value;
  }

 private:
  const Path& path(int index) const { return problem_.plan->paths[static_cast<size_t>(index)]; }

  std::vector<int> EntriesOf(int index) const {
    if (path(index).kind == Path::Kind::kOpen) {
      return path(index).one_way ? std::vector<int>{0} : std::vector<int>{0, 1};
    }
    if (!path(index).allowed.empty()) return path(index).allowed;
    std::vector<int> all;
    for (size_t v = 0; v < path(index).points.size(); ++v) all.push_back(static_cast<int>(v));
    return all;
  }

  double Move(Point from, Point to) const { return testing::MoveCost(problem_.cost, from, to); }

  void AddStage(const PlanStage& stage) {
    for (size_t k = 0; k < stage.paths.size(); ++k) {
      const bool very_last = position_ + 1 == static_cast<int>(once_.size());
      std::vector<Way> ways;
      for (const int index : stage.paths) {
        for (const int entry : EntriesOf(index)) {
          double cost = 0;
          if (position_ == 0) cost += Move(problem_.start, EnterPoint(path(index), entry));
          if (very_last && problem_.finish) {
            cost += Move(ExitPoint(path(index), entry), *problem_.finish);
          }
          ways.push_back({{index, entry}, program_.AddBinary(cost)});
          once_[static_cast<size_t>(index)].Add(ways.back().column, 1);
          places_[static_cast<size_t>(index)].emplace_back(ways.back().column, position_);
        }
      }
      if (position_ == 0) {
        MixedProgram::Entries one;
        for (const Way& way : ways) one.Add(way.column, 1);
        program_.AddRow(1, 1, one);
      } else {
        Join(ways);
      }
      last_ = std::move(ways);
      ++position_;
    }
    for (const auto& [i, j] : stage.before) {
      MixedProgram::Entries row;
      for (const auto& [column, k] : places_[static_cast<size_t>(stage.paths[size_t(j)])]) {
        row.Add(column, k);
      }
      for (const auto& [column, k] : places_[static_cast<size_t>(stage.paths[size_t(i)])]) {
        row.Add(column, -k);
      }
      program_.AddRow(1, MixedProgram::kInfinity, row);
    }
  }

  void Join(const std::vector<Way>& ways) {
    std::vector<MixedProgram::Entries> in(ways.size());
    for (const Way& from : last_) {
      MixedProgram::Entries out;
      for (size_t w = 0; w < ways.size(); ++w) {
        if (ways[w].visit.path == from.visit.path) continue;
        const int move =
            program_.AddBinary(Move(ExitPoint(path(from.visit.path), from.visit.entry),
                                    EnterPoint(path(ways[w].visit.path), ways[w].visit.entry)));
        out.Add(move, 1);
        in[w].Add(move, 1);
      }
      out.Add(from.column, -1);
      program_.AddRow(0, 0, out);
    }
    for (size_t w = 0; w < ways.size(); ++w) {
      in[w].Add(ways[w].column, -1);
      program_.AddRow(0, 0, in[w]);
    }
  }

  const LayerProblem& problem_;
  MixedProgram program_;
  std::vector<MixedProgram::Entries> once_;               // [path]
  std::vector<std::vector<std::pair<int, int>>> places_;  // [path] columns and their positions
  std::vector<Way> last_;
  int position_ = 0;
};

StageProof Prove(const LayerProblem& problem) {
  const StageModel model = *StageModel::Build(problem, 1 << 20);
  Budget budget;
  return ProveByStages(model, model.WalkOf(GivenRoute(*problem.plan)), {}, budget);
}

TEST(LayerMilp, AgreesWithProofs) {
  using testing::PlanShape;
  for (const PlanShape shape :
       {PlanShape::kFlatContours, PlanShape::kSequential, PlanShape::kFlatBefore}) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
      SCOPED_TRACE(absl::StrCat("shape ", static_cast<int>(shape), ", seed ", seed));
      // One stage is harder for the flow than two.
      const int most = shape == PlanShape::kSequential ? 9 : 6;
      const OwnedProblem owned = testing::RandomProblem(
          seed, {.shape = shape, .min_paths = 4, .max_paths = most, .max_vertices = 3});

      const StageProof proof = Prove(owned.problem);

      const double best = LayerProgram(owned.problem).Solve();
      EXPECT_TRUE(proof.proven);
      EXPECT_NEAR(proof.cost, best, 1e-6 * (1 + best));
      EXPECT_NEAR(proof.lower_bound, best, 1e-6 * (1 + best));
    }
  }
}

// Squares in a row: many routes of the same length, and points that coincide.
TEST(LayerMilp, AgreesWithProofsWhereManyRoutesAreBest) {
  for (const int columns : {2, 3, 4}) {
    SCOPED_TRACE(columns);
    const OwnedProblem owned(SequentialPlan(testing::SquareGrid(columns, 1)));

    const StageProof proof = Prove(owned.problem);

    EXPECT_TRUE(proof.proven);
    EXPECT_NEAR(proof.cost, LayerProgram(owned.problem).Solve(), 1e-6);
  }
}

TEST(LayerMilp, ProofsAgreeWithBruteForceUpToEightPaths) {
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned =
        testing::RandomProblem(seed, {.shape = testing::PlanShape::kFlatBefore,
                                      .min_paths = 8,
                                      .max_paths = 8,
                                      .max_vertices = 3});
    const double best = testing::BruteForce(owned.problem).cost;

    EXPECT_NEAR(Prove(owned.problem).cost, best, 1e-6 * (1 + best));
  }
}

}  // namespace
}  // namespace traverse
