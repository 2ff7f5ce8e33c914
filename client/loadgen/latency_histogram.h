// Counts latencies in buckets whose width grows with the value, as HDR histograms do: any number of
// values in fixed memory, each percentile within 0.8 % of the true one.
//
// Values below 256 ns have a bucket each; above that, each octave [2^k, 2^(k+1)) has 128 equal
// ones.

#ifndef TRAVERSE_CLIENT_LOADGEN_LATENCY_HISTOGRAM_H_
#define TRAVERSE_CLIENT_LOADGEN_LATENCY_HISTOGRAM_H_

#include <cstdint>
#include <vector>

#include "absl/time/time.h"

namespace traverse::loadgen {

class LatencyHistogram {
 public:
  // Negative values count as 0.
  void Record(absl::Duration value);

  uint64_t count() const { return count_; }
  absl::Duration max() const { return absl::Nanoseconds(max_ns_); }
  absl::Duration mean() const;

  // The value that `share` of all values do not exceed: the upper end of its bucket, at most max().
  // The smallest value for share 0; 0 without values. REQUIRES: 0 <= share <= 1.
  absl::Duration Percentile(double share) const;

 private:
  static size_t BucketOf(uint64_t ns);
  static uint64_t UpperEnd(size_t bucket);

  std::vector<uint64_t> buckets_;  // grows to the largest value
  uint64_t count_ = 0;
  int64_t max_ns_ = 0;
  double sum_ns_ = 0;
};

}  // namespace traverse::loadgen

#endif  // TRAVERSE_CLIENT_LOADGEN_LATENCY_HISTOGRAM_H_
