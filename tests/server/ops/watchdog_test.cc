#include "server/ops/watchdog.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/jobs/worker_pool.h"
#include "server/service_core.h"

namespace traverse {
namespace {

constexpr absl::Duration kLimit = absl::Milliseconds(200);

void Nap() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

TEST(Watchdog, ReportsAJobWhoseTaskIsStuckOnceAndForgetsItWhenItGoesOn) {
  WorkerPool pool(2);
  std::mutex mutex;
  std::vector<std::string> jobs;
  Watchdog watchdog(pool, kLimit, [&](const SilentTask& task) {
    std::lock_guard<std::mutex> lock(mutex);
    jobs.push_back(task.caller + "/" + task.job);
  });
  std::atomic<bool> end{false};
  const auto queue = pool.NewQueue("caller");
  queue->set_job("job-7");
  queue->Submit([&end] {
    while (!end) Nap();
  });
  while (watchdog.silent() == 0) Nap();
  std::this_thread::sleep_for(absl::ToChronoMilliseconds(kLimit));

  EXPECT_EQ(watchdog.silent(), 1);
  {
    std::lock_guard<std::mutex> lock(mutex);
    EXPECT_EQ(jobs, std::vector<std::string>{"caller/job-7"});
  }
  end = true;
  while (watchdog.silent() > 0) Nap();
}

TEST(Watchdog, AStuckWorkerMakesTheServerUnhealthy) {
  ServiceOptions options;
  options.log = false;
  options.watchdog = kLimit;
  ServiceCore core(options);
  EXPECT_TRUE(core.healthy());
  std::atomic<bool> end{false};
  core.pool.NewQueue("caller")->Submit([&end] {
    while (!end) Nap();
  });
  while (core.healthy()) Nap();

  EXPECT_NE(core.MetricsText().find("traverse_workers_silent 1"), std::string::npos);
  end = true;
  while (!core.healthy()) Nap();
}

}  // namespace
}  // namespace traverse
