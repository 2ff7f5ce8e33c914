// Bounds against what is proven: the optima of parts 1 to 3, layers 1 to 5, in
// tests/bench/reference.json (proven_by_layer), which come from an implementation that is not ours.

#include <gtest/gtest.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "absl/time/time.h"
#include "engine/engine.h"
#include "engine/strategy/registry.h"
#include "tests/bench/layers/bench_part.h"
#include "tests/support/test_executor.h"

namespace traverse::bench {
namespace {

constexpr double kReferenceRounding = 1e-6;  // mm; the file has six decimals

class Outcomes : public JobSink {
 public:
  void OnLayer(LayerOutcome outcome) override { by_index_[outcome.index] = std::move(outcome); }
  void OnDone() override {
    std::lock_guard<std::mutex> lock(mutex_);
    done_ = true;
    wake_.notify_all();
  }
  std::map<uint64_t, LayerOutcome> Take() {
    std::unique_lock<std::mutex> lock(mutex_);
    wake_.wait(lock, [this] { return done_; });
    return std::move(by_index_);
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::map<uint64_t, LayerOutcome> by_index_;
};

// `starts`: of each layer; empty: where the layer before ended, the first at (0, 0).
std::map<uint64_t, LayerOutcome> Solve(const BenchPart& part, const std::vector<Point>& starts,
                                       const std::string& strategy,
                                       const std::map<std::string, std::string>& options,
                                       absl::Duration layer_time_limit = absl::InfiniteDuration()) {
  TestExecutor executor(1);
  Outcomes outcomes;
  JobSpec spec;
  spec.layer_time_limit = layer_time_limit;
  const auto job = Job::Start(spec, *MakeStrategy(strategy, options), executor, outcomes);
  for (size_t i = 0; i < part.layers.size(); ++i) {
    JobLayer layer{part.layers[i], {}, {}};
    if (!starts.empty()) layer.start = starts[i];
    job->Add(std::move(layer));
  }
  job->Close();
  return outcomes.Take();
}

class ReferenceBounds : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    auto parts = BundledParts({GetParam()});
    ASSERT_TRUE(parts.ok());
    part_ = std::move(parts->front());
    ASSERT_EQ(part_.proven_mm.size(), part_.layers.size());
    proofs_ = Solve(part_, {}, "exact", {});
    for (const auto& [index, outcome] : proofs_) starts_.push_back(outcome.start);
  }

  void ExpectNoneAbove(const std::map<uint64_t, LayerOutcome>& outcomes) const {
    ASSERT_EQ(outcomes.size(), part_.layers.size());
    for (const auto& [index, outcome] : outcomes) {
      SCOPED_TRACE(index);
      EXPECT_LE(outcome.lower_bound.value_or(0), part_.proven_mm[index] + kReferenceRounding);
      EXPECT_GE(outcome.cost, part_.proven_mm[index] - kReferenceRounding);
    }
  }

  BenchPart part_;
  std::map<uint64_t, LayerOutcome> proofs_;
  std::vector<Point> starts_;  // of the proven chain, which the reference's values are for
};

TEST_P(ReferenceBounds, AreNeverAboveTheProvenOptimum) {
  // The chain of exact is that of the reference, so its lengths are the proven ones.
  for (const auto& [index, outcome] : proofs_) {
    SCOPED_TRACE(index);
    EXPECT_EQ(outcome.stop, StopReason::kOptimal);
    EXPECT_NEAR(outcome.cost, part_.proven_mm[index], kReferenceRounding);
    EXPECT_NEAR(outcome.lower_bound.value_or(0), part_.proven_mm[index], kReferenceRounding);
  }

  const std::map<std::string, std::string> framework = {{"model", "framework"},
                                                        {"time_limit", "0.1"}};
  for (const auto& [strategy, options] :
       std::vector<std::pair<std::string, std::map<std::string, std::string>>>{
           {"auto", {}},
           {"tabu", {{"diversifications", "20"}, {"bound", "true"}}},
           {"exact", framework}}) {
    SCOPED_TRACE(strategy);
    const std::map<uint64_t, LayerOutcome> outcomes = Solve(part_, starts_, strategy, options);
    ExpectNoneAbove(outcomes);
    for (const auto& [index, outcome] : outcomes) {
      EXPECT_GT(outcome.lower_bound.value_or(0), 0.5 * outcome.cost) << "layer " << index;
    }
  }

  // Proofs that are cut short at many places.
  for (const int limit_ms : {1, 5, 20, 50, 100}) {
    SCOPED_TRACE(limit_ms);
    ExpectNoneAbove(Solve(part_, starts_, "exact", {}, absl::Milliseconds(limit_ms)));
  }
}

INSTANTIATE_TEST_SUITE_P(Parts, ReferenceBounds, ::testing::Values("part1", "part2", "part3"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace traverse::bench
