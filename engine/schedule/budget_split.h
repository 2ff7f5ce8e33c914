// Divides a job's time among its layers, and keeps what greedy needs for each.

#ifndef TRAVERSE_ENGINE_SCHEDULE_BUDGET_SPLIT_H_
#define TRAVERSE_ENGINE_SCHEDULE_BUDGET_SPLIT_H_

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "engine/base/budget.h"
#include "engine/model/plan.h"

namespace traverse {

// How large a layer is.
struct LayerSize {
  size_t paths = 0;
  int64_t points = 0;
};

inline LayerSize SizeOf(const Plan& plan) {
  LayerSize size{plan.paths.size()};
  for (const Path& path : plan.paths) size.points += static_cast<int64_t>(path.points.size());
  return size;
}

// A layer is answered by greedy's route at worst. So the search of all layers ends as long before
// the deadline as greedy needs for those not yet answered, by what such work took in this job.
//
// When a layer begins, it gets a share of the time left for searching: its weight over the weight
// of all layers that have not begun, times the number of threads, because that many layers run at
// once. So time that a layer does not use goes to those after it, time that it overruns is taken
// from all of them, and no layer gets none. While layers may come that were not announced, as much
// is kept for them as for those known. Not thread-safe.
class BudgetSplit {
 public:
  using Clock = Budget::Clock;
  using Seconds = std::chrono::duration<double>;

  // REQUIRES: threads > 0.
  BudgetSplit(std::optional<Clock::time_point> deadline, Clock::time_point now, int threads)
      : deadline_(deadline),
        whole_(deadline ? *deadline - now : Clock::duration()),
        threads_(threads) {
    assert(threads > 0);
  }

  // How much a layer of `paths` paths can gain, without a unit. The time to a good route grows a
  // little faster than the number of paths. A layer that starts from a good route gains less.
  static double Weight(size_t paths, bool from_good_route) {
    constexpr double kGrowth = 1.25;
    constexpr double kGoodRouteShare = 0.25;
    const double weight = std::pow(static_cast<double>(paths) + 1, kGrowth);
    return from_good_route ? kGoodRouteShare * weight : weight;
  }

  // Keeps time for a layer that will be added, and for no further ones.
  void Announce(LayerSize size) {
    announced_ += Weight(size.paths, false);
    unanswered_ += Work(size);
    ++announced_layers_;
  }
  void AnnounceEnd() { more_may_come_ = false; }

  // Adds a layer that will begin, with Weight(size.paths, false).
  void AddLayer(LayerSize size) {
    const double weight = Weight(size.paths, false);
    waiting_ += weight;
    if (announced_layers_ == 0) {
      unanswered_ += Work(size);
    } else {
      announced_ = --announced_layers_ == 0 ? 0 : std::max(0.0, announced_ - weight);
    }
  }

  // Adds something else that will begin, or changes the weight of a layer by `change`.
  void Add(double change) { waiting_ += change; }

  // The time that a layer of this weight may use from `now` on; the largest duration if there is no
  // deadline. REQUIRES: `weight` was added and has not begun.
  Clock::duration Begin(double weight, Clock::time_point now) {
    assert(weight <= waiting_ * (1 + kRounding) + kRounding);
    const double known = std::max(waiting_, weight) + announced_;
    const double all = more_may_come_ ? 2 * known : known;
    const double share = std::min(more_may_come_ ? 0.5 : 1.0, threads_ * weight / all);
    waiting_ = std::max(0.0, waiting_ - weight);
    if (!deadline_) return Clock::duration::max();
    const Clock::duration left = std::max(Clock::duration::zero(), *SearchEnd() - now);
    return std::chrono::duration_cast<Clock::duration>(share * left);
  }

  // Notes that a layer was measured, or given a route by greedy, in this time.
  void NoteTaken(LayerSize size, Clock::duration time) {
    taken_ = kFading * taken_ + Seconds(time);
    worked_ = kFading * worked_ + Work(size);
  }

  // Notes how long a task of the job waited for a thread.
  void NoteWait(Clock::duration time) {
    wait_ = std::max(Seconds(time), kFading * wait_ + (1 - kFading) * Seconds(time));
  }

  // Notes that a layer that was added needs no more time.
  void NoteAnswered(LayerSize size) { unanswered_ = std::max(0.0, unanswered_ - Work(size)); }

  // When every search must end, by what is known now; later layers may search longer.
  std::optional<Clock::time_point> SearchEnd() const {
    if (!deadline_) return std::nullopt;
    // The thread may lose its core when greedy is due.
    constexpr std::chrono::milliseconds kMostLag{10};
    constexpr int kLagShare = 10;
    const Seconds lag = kSafety * wait_ + std::min<Clock::duration>(kMostLag, whole_ / kLagShare);
    const Seconds reserve =
        std::min<Seconds>(lag + TimeOf(unanswered_), std::max(whole_, Clock::duration()));
    return *deadline_ - std::chrono::duration_cast<Clock::duration>(reserve);
  }

  // When greedy must end on a layer of this size, so that it has its time on the other layers too.
  // Where nothing else is left to do its route is still worth a little more than the time that was
  // kept for it.
  std::optional<Clock::time_point> GreedyEnd(LayerSize size) const {
    if (!deadline_) return std::nullopt;
    constexpr std::chrono::milliseconds kMostGrace{10};
    constexpr int kGraceShare = 10;
    const Clock::duration grace = std::clamp<Clock::duration>(whole_ / kGraceShare, {}, kMostGrace);
    const Seconds others = TimeOf(std::max(0.0, unanswered_ - Work(size)));
    return *deadline_ + grace - std::chrono::duration_cast<Clock::duration>(others);
  }

 private:
  static constexpr double kRounding = 1e-6;  // of sums of weights

  // What greedy needs, in points: most is looking for the nearest one.
  static double Work(LayerSize size) {
    constexpr double kPointsOfPath = 8;
    constexpr double kPointsOfLayer = 50;
    return static_cast<double>(size.points) + kPointsOfPath * static_cast<double>(size.paths) +
           kPointsOfLayer;
  }

  static constexpr double kSafety = 2;  // also because greedy follows on measuring

  // What greedy needs for so much work, by what it has taken.
  Seconds TimeOf(double work) const { return kSafety * (taken_ / worked_) * work; }

  // With each layer, earlier ones lose this share of their weight: the machine may become busy.
  static constexpr double kFading = 0.8;

  const std::optional<Clock::time_point> deadline_;
  const Clock::duration whole_;
  const int threads_;
  double waiting_ = 0;    // total weight of the layers that have not begun
  double announced_ = 0;  // of those that have not been added
  int64_t announced_layers_ = 0;
  bool more_may_come_ = true;  // than those announced
  double unanswered_ = 0;      // work
  Seconds taken_{0.25e-6};     // at first what greedy usually takes
  double worked_ = 1;

  Seconds wait_{};  // of tasks, the longest of late
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_BUDGET_SPLIT_H_
