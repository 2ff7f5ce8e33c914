// Sends jobs at their times and counts their outcomes.

#ifndef TRAVERSE_CLIENT_LOADGEN_LOAD_RUN_H_
#define TRAVERSE_CLIENT_LOADGEN_LOAD_RUN_H_

#include <grpcpp/channel.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "client/loadgen/latency_histogram.h"
#include "client/loadgen/load_plan.h"

namespace traverse::loadgen {

// One size of a mix, with its bytes.
struct JobKind {
  SizeShare share;
  grpc::ByteBuffer bytes;  // OptimizeBatchRequest
};

struct LoadOptions {
  double rate = 0;    // jobs a second; 0: closed loop, with `in_flight` jobs at all times
  int in_flight = 1;  // of the closed loop
  Arrivals arrivals = Arrivals::kEven;
  absl::Duration warm_up = absl::Seconds(1);  // before the duration: jobs are sent but not counted
  absl::Duration duration = absl::Seconds(10);
  absl::Duration deadline = absl::Seconds(30);  // of each job, from when it is sent
  int max_in_flight = 10'000;  // open loop: more jobs are not sent, and counted as such
  uint64_t seed = 1;
  std::string token;  // bearer token; empty: none
};

// Jobs with one outcome.
struct Tally {
  uint64_t jobs = 0;
  LatencyHistogram latency;    // from when the job was due to be sent to its status
  LatencyHistogram from_sent;  // from when it was sent, without delays of the generator

  void Add(absl::Duration latency_of_job, absl::Duration from_sent_of_job) {
    ++jobs;
    latency.Record(latency_of_job);
    from_sent.Record(from_sent_of_job);
  }
};

struct LoadResult {
  std::vector<Tally> ok;              // by position in the kinds
  std::vector<uint64_t> sent;         // by position in the kinds
  std::map<std::string, Tally> code;  // all outcomes, also OK; INCOMPLETE: OK but answers missing
  std::map<std::string, std::string> example;  // a message for each outcome other than OK
  LatencyHistogram send_lag;                   // how much later than due jobs were sent
  uint64_t not_sent = 0;
  absl::Duration duration;
};

// Runs to the end of the last job. Jobs go to `channels` in turn. REQUIRES: neither list is empty.
LoadResult RunLoad(const LoadOptions& options, const std::vector<JobKind>& kinds,
                   const std::vector<std::shared_ptr<grpc::Channel>>& channels);

}  // namespace traverse::loadgen

#endif  // TRAVERSE_CLIENT_LOADGEN_LOAD_RUN_H_
