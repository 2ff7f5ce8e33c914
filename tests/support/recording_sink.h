// Keeps what a job answers.

#ifndef TRAVERSE_TESTS_SUPPORT_RECORDING_SINK_H_
#define TRAVERSE_TESTS_SUPPORT_RECORDING_SINK_H_

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "engine/engine.h"

namespace traverse {

// Checks too that it is told one thing at a time, and nothing after the end.
class RecordingSink : public JobSink {
 public:
  void OnLayer(LayerOutcome outcome) override {
    std::lock_guard<std::mutex> lock(mutex_);
    EXPECT_FALSE(done_);
    outcomes.push_back(std::move(outcome));
    wake_.notify_all();
  }

  void OnChainBound(double lower_bound) override {
    std::lock_guard<std::mutex> lock(mutex_);
    EXPECT_FALSE(done_ || chain_bound.has_value());
    chain_bound = lower_bound;
  }

  void OnDone() override {
    std::lock_guard<std::mutex> lock(mutex_);
    EXPECT_FALSE(done_);
    done_ = true;
    wake_.notify_all();
  }

  // For the end.
  void Wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    wake_.wait(lock, [this] { return done_; });
  }

  // For so many answers, 20 s at most. Returns whether they came.
  bool WaitForAnswers(size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    return wake_.wait_for(lock, std::chrono::seconds(20),
                          [this, count] { return outcomes.size() >= count; });
  }

  std::map<uint64_t, LayerOutcome> ByIndex() {
    std::map<uint64_t, LayerOutcome> result;
    for (const LayerOutcome& outcome : outcomes) result[outcome.index] = outcome;
    return result;
  }

  // Read these after Wait.
  std::vector<LayerOutcome> outcomes;
  std::optional<double> chain_bound;

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
};

}  // namespace traverse

#endif  // TRAVERSE_TESTS_SUPPORT_RECORDING_SINK_H_
