#include "client/loadgen/latency_histogram.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace traverse::loadgen {
namespace {

constexpr int kBits = 7;                               // of precision
constexpr uint64_t kPerOctave = uint64_t{1} << kBits;  // buckets

}  // namespace

size_t LatencyHistogram::BucketOf(uint64_t ns) {
  const auto width = static_cast<int>(std::bit_width(ns));
  if (width <= kBits + 1) return ns;
  const int shift = width - 1 - kBits;
  return static_cast<size_t>(static_cast<uint64_t>(shift) * kPerOctave + (ns >> shift));
}

uint64_t LatencyHistogram::UpperEnd(size_t bucket) {
  if (bucket < 2 * kPerOctave) return bucket;
  const uint64_t shift = bucket / kPerOctave - 1;
  const uint64_t top = bucket - shift * kPerOctave;
  return ((top + 1) << shift) - 1;
}

void LatencyHistogram::Record(absl::Duration value) {
  const int64_t ns = std::max<int64_t>(0, absl::ToInt64Nanoseconds(value));
  const size_t bucket = BucketOf(static_cast<uint64_t>(ns));
  if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
  ++buckets_[bucket];
  ++count_;
  max_ns_ = std::max(max_ns_, ns);
  sum_ns_ += static_cast<double>(ns);
}

absl::Duration LatencyHistogram::mean() const {
  return count_ == 0 ? absl::ZeroDuration()
                     : absl::Nanoseconds(sum_ns_ / static_cast<double>(count_));
}

absl::Duration LatencyHistogram::Percentile(double share) const {
  assert(share >= 0 && share <= 1);
  const auto rank = std::max<uint64_t>(
      1, static_cast<uint64_t>(std::ceil(share * static_cast<double>(count_) - 1e-9)));
  uint64_t seen = 0;
  for (size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
    seen += buckets_[bucket];
    if (seen >= rank) {
      return absl::Nanoseconds(std::min(static_cast<int64_t>(UpperEnd(bucket)), max_ns_));
    }
  }
  return absl::ZeroDuration();
}

}  // namespace traverse::loadgen
