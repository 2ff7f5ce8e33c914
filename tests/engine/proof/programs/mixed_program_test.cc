#include "engine/proof/programs/mixed_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <optional>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/base/turn.h"

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

// Notes the longest time of the thread between two asks, and cancels at an ask of that number.
class Asks : public Turn {
 public:
  Asks() { SetWanted(true); }
  bool GiveWay(const CancelToken* /*cancel*/, std::optional<Clock::time_point> /*end*/) override {
    const double now = ThreadSeconds();
    if (asks_ > 0) longest_ = std::max(longest_, now - last_);
    if (++asks_ == cancel_at) {
      cancel.Cancel();
      cancelled_ = now;
    }
    last_ = ThreadSeconds();
    return false;
  }
  int asks() const { return asks_; }
  // As shares of all the time until now: machines differ in speed.
  double longest() const { return longest_ / (ThreadSeconds() - begin_); }
  double since_cancelled() const {
    const double now = ThreadSeconds();
    return (now - cancelled_) / (now - begin_);
  }

  int cancel_at = 0;
  CancelToken cancel;

 private:
  static double ThreadSeconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  const double begin_ = ThreadSeconds();
  int asks_ = 0;
  double last_ = 0;
  double longest_ = 0;
  double cancelled_ = 0;
};

// Each step before the first linear programme copies a large matrix several times.
TEST(MixedProgram, AsksBetweenTheStepsOfItsSetUp) {
  Rng rng(3);
  RandomProgram random;
  Fill(random, rng, 40, 10);
  for (int cancel_at = 1; cancel_at <= 4; ++cancel_at) {
    SCOPED_TRACE(cancel_at);
    Asks asks;
    asks.cancel_at = cancel_at;
    Budget budget(&asks.cancel, std::nullopt, &asks);

    const MixedProgram::Result result = random.program.Solve({}, random.inside, budget);

    EXPECT_EQ(asks.asks(), cancel_at);  // Cbc would ask again
    EXPECT_EQ(result.values, random.inside);
  }
}

// Gomory's cuts of all columns that are no whole numbers would take several times as long.
TEST(MixedProgram, AsksOftenWhileItCuts) {
  constexpr int kColumns = 5000;
  Rng rng(5);
  MixedProgram program;
  for (int c = 0; c < kColumns; ++c) program.AddBinary(-rng.Between(5, 20));
  for (int r = 0; r < 2500; ++r) {
    MixedProgram::Entries row;
    const int first = rng.Between(0, kColumns - 40);
    for (int k = 0; k < 5; ++k) row.Add(first + 8 * k + rng.Between(0, 7), 1);
    program.AddRow(-MixedProgram::kInfinity, 2, row);
  }
  constexpr double kMost = 0.04;  // 0.105 with all columns, 0.011 with few
  double longest = 1;
  for (int tries = 0; tries < 3 && longest > kMost; ++tries) {
    Asks asks;
    asks.cancel_at = 4700;  // after the first cuts
    Budget budget(&asks.cancel, std::nullopt, &asks);

    program.Solve({}, std::vector<double>(kColumns), budget);

    EXPECT_GE(asks.asks(), asks.cancel_at);
    longest = std::min(longest, asks.longest());
  }

  EXPECT_LT(longest, kMost);
}

// To stop, Cbc would begin programmes that it needs no more, with a factorization of each.
TEST(MixedProgram, EndsSoonOnceItIsCancelled) {
  constexpr int kColumns = 12'000;
  constexpr double kMost = 0.1;  // 0.35 if it begins them, 0.025 if not
  Rng rng(5);
  MixedProgram program;
  for (int c = 0; c < kColumns; ++c) program.AddBinary(-rng.Between(5, 20));
  for (int r = 0; r < 8 * kColumns; ++r) {
    MixedProgram::Entries row;
    const int first = rng.Between(0, kColumns - 40);
    for (int k = 0; k < 5; ++k) row.Add(first + 8 * k + rng.Between(0, 7), 1);
    program.AddRow(-MixedProgram::kInfinity, 2, row);
  }
  double least = 1;
  for (const int cancel_at : {1000, 2000, 4000}) {
    Asks asks;
    asks.cancel_at = cancel_at;
    Budget budget(&asks.cancel, std::nullopt, &asks);

    const auto result = program.Solve({}, std::vector<double>(kColumns), budget);

    EXPECT_FALSE(result.complete);
    EXPECT_GE(asks.asks(), cancel_at);
    least = std::min(least, asks.since_cancelled());
  }

  EXPECT_LT(least, kMost);
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
