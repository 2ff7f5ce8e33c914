#include "tests/bench/layers/bench_run.h"

#include <sys/resource.h>

#include <algorithm>
#include <condition_variable>
#include <ctime>
#include <memory>
#include <mutex>
#include <utility>

#include "engine/engine.h"
#include "engine/strategy/registry.h"
#include "server/jobs/worker_pool.h"

namespace traverse::bench {
namespace {

double CpuSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class SumSink : public JobSink {
 public:
  explicit SumSink(BenchResult& result) : result_(result) {}

  void OnLayer(LayerOutcome outcome) override {
    ++result_.layers;
    result_.invalid += !outcome.invalid_route.empty();
    result_.travel_mm += outcome.cost;
    result_.layer_mm.push_back(outcome.cost);
    all_bounded_ = all_bounded_ && outcome.lower_bound.has_value();
    result_.bound_mm += outcome.lower_bound.value_or(0);
  }

  void OnDone() override {
    std::lock_guard<std::mutex> lock(mutex_);
    done_ = true;
    wake_.notify_all();
  }

  void Wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    wake_.wait(lock, [this] { return done_; });
    if (!all_bounded_) result_.bound_mm = 0;
  }

 private:
  BenchResult& result_;
  bool all_bounded_ = true;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
};

}  // namespace

BenchResult Run(const std::vector<Plan>& layers, const BenchJob& job) {
  BenchResult result;
  auto strategy = MakeStrategy(job.strategy, job.options);
  if (!strategy.ok()) return result;
  WorkerPool pool(job.threads);
  std::vector<JobLayer> work;
  for (const Plan& plan : layers) work.push_back({plan, {}, {}, /*more_follows=*/true});

  const Stopwatch watch;
  const double cpu_before = CpuSeconds();
  JobSpec spec;
  spec.seed = job.seed;
  spec.layer_time_limit = job.layer_time_limit;
  if (job.deadline != absl::InfiniteDuration()) {
    spec.deadline = Budget::Clock::now() + absl::ToChronoNanoseconds(job.deadline);
  }
  SumSink sink(result);
  const auto queue = pool.NewQueue("bench");
  const auto running = Job::Start(spec, *std::move(strategy), *queue, sink);
  for (JobLayer& layer : work) running->Add(std::move(layer));
  running->Close();
  sink.Wait();
  result.wall_seconds = watch.Seconds();
  result.cpu_seconds = CpuSeconds() - cpu_before;
  return result;
}

BenchResult MedianRun(const std::vector<Plan>& layers, BenchJob job, int count) {
  std::vector<BenchResult> results;
  for (int i = 0; i < count; ++i) {
    job.seed = static_cast<uint64_t>(i) + 1;
    results.push_back(Run(layers, job));
  }
  const auto middle = results.begin() + count / 2;
  std::nth_element(
      results.begin(), middle, results.end(),
      [](const BenchResult& a, const BenchResult& b) { return a.travel_mm < b.travel_mm; });
  return *middle;
}

double PeakMemoryMb() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace traverse::bench
