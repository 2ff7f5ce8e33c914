// Which job is sent when: fixed before the first job is sent, so that a slow server does not change
// it.
//
// A client that waits for an answer before it sends the next job asks less of a server just when it
// is slow, and never sees the waiting that others would have ("coordinated omission"). Here each
// job has its time, and its latency counts from that time, whether or not it is sent late.

#ifndef TRAVERSE_CLIENT_LOADGEN_LOAD_PLAN_H_
#define TRAVERSE_CLIENT_LOADGEN_LOAD_PLAN_H_

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace traverse::loadgen {

// Jobs of `layers` layers, with a share of `weight` over the sum of all weights.
struct SizeShare {
  int layers = 1;
  double weight = 1;
};

// "1:70,10:25,400:5": jobs of 1 layer 70 times in 100, and so on; a missing weight is 1.
// InvalidArgument for anything else.
absl::StatusOr<std::vector<SizeShare>> ParseMix(const std::string& text);

enum class Arrivals {
  kEven,     // one every 1 / rate seconds
  kPoisson,  // independent of each other, `rate` a second on average
};

// Chooses the size of each job: positions in a mix, at random by its weights.
class SizeChoice {
 public:
  SizeChoice(const std::vector<SizeShare>& mix, uint64_t seed);
  size_t Next();

 private:
  std::mt19937_64 random_;
  std::vector<double> upto_;  // sums of the weights
};

// The times in [0, duration) at which jobs are sent, in ascending order.
std::vector<absl::Duration> SendTimes(double rate, absl::Duration duration, Arrivals arrivals,
                                      uint64_t seed);

}  // namespace traverse::loadgen

#endif  // TRAVERSE_CLIENT_LOADGEN_LOAD_PLAN_H_
