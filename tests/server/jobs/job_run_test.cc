#include "server/jobs/job_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "server/jobs/worker_pool.h"
#include "tests/server/jobs/fake_port.h"
#include "tests/support/problems/instances.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST_F(JobRunTest, DeliversAllLayersThenTheSummaryThenEnds) {
  port_.run().Start({}, {}, Slow(0), *queue_);
  for (uint64_t i = 0; i < 100; ++i) port_.run().Add(Layer(1000 + i));
  port_.run().Push();
  port_.run().Close();

  ASSERT_TRUE(port_.WaitForFinish());
  const std::vector<std::string> messages = port_.messages();
  ASSERT_EQ(messages.size(), 101u);
  for (size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(messages[i], std::to_string(i) + ":" + std::to_string(1000 + i));
  }
  EXPECT_EQ(messages.back(), "summary");
  EXPECT_TRUE(port_.status().ok());
  EXPECT_EQ(port_.finishes(), 1);
}

TEST_F(JobRunTest, BuildOrderSortsLayersThatDoNotWaitForEachOther) {
  port_.run().Start({.window = {}, .build_order = true}, {}, Slow(0), *queue_);
  for (uint64_t i = 0; i < 200; ++i) {
    LabelledLayer layer = Layer(i);
    layer.layer.start = Point{1, 1};
    port_.run().Add(std::move(layer));
  }
  port_.run().Push();
  port_.run().Close();

  ASSERT_TRUE(port_.WaitForFinish());
  const std::vector<std::string> messages = port_.messages();
  ASSERT_EQ(messages.size(), 201u);
  for (size_t i = 0; i < 200; ++i) {
    EXPECT_EQ(messages[i], std::to_string(i) + ":" + std::to_string(i));
  }
}

TEST_F(JobRunTest, StalledReaderHoldsUpItsJobInABoundedWindow) {
  port_.Stall(true);
  port_.run().Start({.window = {.layers = 8, .points = 1000}, .build_order = false}, {}, Slow(0),
                    *queue_);
  for (uint64_t i = 0; i < 100; ++i) port_.run().Add(Layer(i));
  port_.run().Push();
  port_.run().Close();
  EXPECT_FALSE(port_.run().AskForRoom());

  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(port_.encoded(), 8);
  EXPECT_EQ(port_.messages().size(), 1u);
  EXPECT_EQ(pool_.waiting(), 0);

  port_.Stall(false);
  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.messages().size(), 101u);
  EXPECT_GE(port_.rooms(), 1);
}

TEST_F(JobRunTest, WindowCountsPoints) {
  port_.Stall(true);
  port_.run().Start({.window = {.layers = 100, .points = 20}, .build_order = false}, {}, Slow(0),
                    *queue_);
  for (uint64_t i = 0; i < 20; ++i) port_.run().Add(Layer(i));
  port_.run().Push();

  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(port_.encoded(), 10);

  port_.Stall(false);
  port_.run().Close();
  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.encoded(), 20);
}

TEST_F(JobRunTest, WrittenLayersLeaveTheWindow) {
  port_.run().Start({.window = {.layers = 100, .points = 20}, .build_order = false}, {}, Slow(0),
                    *queue_);
  for (uint64_t i = 0; i < 20; ++i) port_.run().Add(Layer(i));
  port_.run().Push();
  for (int i = 0; i < 500 && port_.messages().size() < 20; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_EQ(port_.messages().size(), 20u);

  port_.Stall(true);
  for (uint64_t i = 20; i < 40; ++i) port_.run().Add(Layer(i));
  port_.run().Push();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(port_.encoded(), 30);

  port_.Stall(false);
  port_.run().Close();
  ASSERT_TRUE(port_.WaitForFinish());
}

}  // namespace
}  // namespace traverse
