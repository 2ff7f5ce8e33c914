// No loop of the engine goes on for long without asking its budget: it is then that a layer gives
// way to what others wait for, and that it sees its cancellation and its deadline. Whole jobs, so
// that all that is done with a layer counts, on the shapes that are hardest on it.
//
// Time is that of the thread, which a busy machine does not change. With TRAVERSE_SHOW_GAPS=1 the
// stacks of those longer than 20 ms are printed, for addr2line; with TRAVERSE_SHAPE=Hatch that
// shape alone is run.

#include <execinfo.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/engine.h"
#include "engine/strategy/registry.h"
#include "tests/engine/schedule/hard_shapes.h"
#include "tests/support/problems/instances.h"
#include "tests/support/sanitizers.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

volatile double last_ask = 0;  // for the handler of the signal below

void ShowGap(int /*signal*/) {
  if (last_ask == 0 || ThreadSeconds() - last_ask < 0.02) return;
  void* frames[24];
  backtrace_symbols_fd(frames, backtrace(frames, 24), STDERR_FILENO);
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, "--\n", 3);
}

// Prints, each 5 ms of work, where it is if nobody was asked for 20 ms.
void ShowGaps(bool show) {
  if (std::getenv("TRAVERSE_SHOW_GAPS") == nullptr) return;
  signal(SIGPROF, ShowGap);
  const itimerval often{{0, show ? 5000 : 0}, {0, show ? 5000 : 0}};
  setitimer(ITIMER_PROF, &often, nullptr);
}

// Wanted by others all the time, notes how long they wait for an answer, and has the job cancelled
// when its time is up.
class WatchedTurn : public Turn {
 public:
  WatchedTurn() { SetWanted(true); }

  bool GiveWay(const CancelToken* /*cancel*/, std::optional<Clock::time_point> /*end*/) override {
    const double now = ThreadSeconds();
    longest_ = std::max(longest_, now - last_ask);
    if (now - begin_ > limit_ && !cancelled_) {
      cancelled_ = true;
      cancelled_at_ = now;
      cancel_();
    }
    last_ask = ThreadSeconds();
    return false;
  }

  void Begin(double limit, std::function<void()> cancel) {
    limit_ = limit;
    cancel_ = std::move(cancel);
    begin_ = ThreadSeconds();
    last_ask = begin_;
    ShowGaps(true);
  }

  void End() {
    ShowGaps(false);
    if (cancelled_) after_cancel_ = ThreadSeconds() - cancelled_at_;
    last_ask = 0;
  }

  void BeginTask() { last_ask = ThreadSeconds(); }
  void EndTask() { longest_ = std::max(longest_, ThreadSeconds() - last_ask); }

  double longest() const { return longest_; }            // seconds between two asks
  double after_cancel() const { return after_cancel_; }  // seconds until the end, once cancelled

 private:
  double begin_ = 0;
  double limit_ = 0;
  double longest_ = 0;
  bool cancelled_ = false;
  double cancelled_at_ = 0;
  double after_cancel_ = 0;
  std::function<void()> cancel_;
};

// Runs tasks in the thread that says so.
class OneThread : public Executor {
 public:
  void Submit(std::function<void()> task) override { tasks_.push_back(std::move(task)); }
  Turn* turn() override { return &turn_; }

  void Run() {
    while (!tasks_.empty()) {
      std::function<void()> task = std::move(tasks_.front());
      tasks_.pop_front();
      turn_.BeginTask();
      task();
      turn_.EndTask();
    }
  }

  WatchedTurn& watched() { return turn_; }

 private:
  std::deque<std::function<void()>> tasks_;
  WatchedTurn turn_;
};

class Answers : public JobSink {
 public:
  void OnLayer(LayerOutcome outcome) override {
    ++layers;
    invalid += outcome.invalid_route;
  }
  void OnDone() override { done = true; }

  int layers = 0;
  std::string invalid;
  bool done = false;
};

// Bounds for machines that do other things as well: caches are cold after each of those.
constexpr double kPatience = kSanitized ? 10 : 1;
constexpr double kMostGap = 0.04 * kPatience;
constexpr double kMostLargeGap = 0.06 * kPatience;
constexpr double kMostLargeEnd = 0.06 * kPatience;

class Gaps : public ::testing::TestWithParam<std::string> {
 protected:
  // Solves all shapes, in `share` of their largest size, for so many seconds.
  void Run(double share, double seconds, double most_gap, double most_after_cancel) {
    const char* const only = std::getenv("TRAVERSE_SHAPE");
    for (const Shape& shape : HardShapes()) {
      if (only != nullptr && shape.name != only) continue;
      for (const bool timed : {false, true}) {
        const int n = static_cast<int>(share * shape.most);
        Run(shape, timed, n, seconds, most_gap, most_after_cancel);
      }
    }
  }

  void Run(const Shape& shape, bool timed, int n, double seconds, double most_gap,
           double most_after_cancel) {
    RunOne(shape, timed, n, seconds);
    // What the machine did meanwhile (reclaimed memory, say) it does not do again.
    if (longest_ >= most_gap || after_cancel_ >= most_after_cancel) {
      RunOne(shape, timed, n, seconds);
    }
    EXPECT_LT(longest_, most_gap) << shape.name << ", seconds without an ask";
    EXPECT_LT(after_cancel_, most_after_cancel) << shape.name << ", seconds to the end";
  }

 private:
  void RunOne(const Shape& shape, bool timed, int n, double seconds) {
    ASSERT_OK_AND_ASSIGN(std::unique_ptr<Strategy> strategy, MakeStrategy(GetParam(), {}));
    JobSpec spec;
    if (timed) spec.cost = {CostSpec::Kind::kTime, 120, 3000, 0.05, 1};
    OneThread executor;
    Answers answers;
    const std::shared_ptr<Job> job = Job::Start(spec, std::move(strategy), executor, answers);
    for (int i = 0; i < 2; ++i) {
      JobLayer layer;
      layer.plan = shape.make(n);
      job->Add(std::move(layer));
    }
    job->Close();

    executor.watched().Begin(seconds, [&] { job->Cancel(); });
    executor.Run();
    executor.watched().End();

    EXPECT_TRUE(answers.done);
    EXPECT_EQ(answers.invalid, "");
    longest_ = executor.watched().longest();
    after_cancel_ = executor.watched().after_cancel();
    std::printf("%-8s %-14s %-6s %8d: %6.1f ms between asks, %6.1f ms after the cancel\n",
                GetParam().c_str(), shape.name.c_str(), timed ? "time" : "length", n,
                1000 * longest_, 1000 * after_cancel_);
  }

  double longest_ = 0;
  double after_cancel_ = 0;
};

TEST_P(Gaps, AreShort) { Run(0.01, 0.05, kMostGap, kMostGap); }

// Takes minutes: run by hand. What is done at one go on a million paths, such as
// freeing them, takes longer.
TEST_P(Gaps, DISABLED_AreShortInTheLargestLayers) { Run(1, 2, kMostLargeGap, kMostLargeEnd); }

using GapsOfProofs = Gaps;

TEST_P(GapsOfProofs, AreShort) {
  Run({"Clusters", ClusterPlan, 60}, false, 60, 2.5, kMostGap, kMostGap);
}

INSTANTIATE_TEST_SUITE_P(All, GapsOfProofs, ::testing::Values("exact", "auto"));
INSTANTIATE_TEST_SUITE_P(All, Gaps,
                         ::testing::Values("none", "greedy", "ni2opt", "tabu", "exact", "auto"));

}  // namespace
}  // namespace traverse
