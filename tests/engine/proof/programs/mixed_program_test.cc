#include "engine/proof/programs/mixed_program.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"

namespace traverse {
namespace {

// Costs and rows of whole numbers, `values` among the solutions if `feasible`.
struct RandomProgram {
  MixedProgram program;
  std::vector<double> costs;
  std::vector<double> inside;
};

void Fill(RandomProgram& random, Rng& rng, int columns, int rows) {
  for (int c = 0; c < columns; ++c) {
    random.costs.push_back(rng.Between(-20, 20));
    random.program.AddBinary(random.costs.back());
    random.inside.push_back(rng.Between(0, 1));
  }
  for (int r = 0; r < rows; ++r) {
    MixedProgram::Entries row;
    double sum = 0;
    for (int c = 0; c < columns; ++c) {
      const double value = rng.Between(-5, 9);
      row.Add(c, value);
      sum += value * random.inside[static_cast<size_t>(c)];
    }
    random.program.AddRow(sum - rng.Between(0, 6), sum + rng.Between(0, 6), row);
  }
}

double BestByTrying(const RandomProgram& random) {
  double best = MixedProgram::kInfinity;
  const size_t columns = random.costs.size();
  std::vector<double> values(columns);
  for (size_t bits = 0; bits < (size_t{1} << columns); ++bits) {
    double cost = 0;
    for (size_t c = 0; c < columns; ++c) {
      values[c] = static_cast<double>(bits >> c & 1);
      cost += values[c] * random.costs[c];
    }
    if (cost < best && random.program.IsSolution(values)) best = cost;
  }
  return best;
}

TEST(MixedProgram, FindsTheBestSolution) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    RandomProgram random;
    Fill(random, rng, rng.Between(1, 12), rng.Between(1, 4));
    const double best = BestByTrying(random);
    for (const bool with_known : {false, true}) {
      Budget budget;

      const MixedProgram::Result result =
          random.program.Solve({}, with_known ? random.inside : std::vector<double>(), budget);

      EXPECT_TRUE(result.complete);
      EXPECT_TRUE(random.program.IsSolution(result.values));
      EXPECT_NEAR(result.value, best, 1e-6);
      EXPECT_LE(result.bound.value_or(best), best + 1e-6);
    }
  }
}

TEST(MixedProgram, KnowsWhenThereIsNoSolution) {
  MixedProgram program;
  MixedProgram::Entries row;
  for (int c = 0; c < 3; ++c) row.Add(program.AddBinary(1), 2);
  program.AddRow(3, 3, row);
  Budget budget;

  const MixedProgram::Result result = program.Solve({}, {}, budget);

  EXPECT_TRUE(result.complete);
  EXPECT_TRUE(result.values.empty());
}

TEST(MixedProgram, ReturnsWhatIsKnownWhenTheBudgetIsOver) {
  Rng rng(3);
  RandomProgram random;
  Fill(random, rng, 10, 2);
  CancelToken cancel;
  cancel.Cancel();
  Budget budget(&cancel);

  const MixedProgram::Result result = random.program.Solve({}, random.inside, budget);

  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.values, random.inside);
}

// Cbc keeps some of its state in static variables: models must not share any of it.
TEST(MixedProgram, IsSolvedByManyThreads) {
  std::vector<std::thread> threads;
  std::vector<double> found(4);
  for (size_t t = 0; t < found.size(); ++t) {
    threads.emplace_back([t, &found] {
      Rng rng(7);
      RandomProgram random;
      Fill(random, rng, 24, 3);
      Budget budget;
      found[t] = random.program.Solve({}, {}, budget).value;
    });
  }
  for (std::thread& thread : threads) thread.join();

  for (const double value : found) EXPECT_DOUBLE_EQ(value, found[0]);
}

}  // namespace
}  // namespace traverse
