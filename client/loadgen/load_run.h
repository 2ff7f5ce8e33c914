// Sends jobs at their times and counts what becomes of them.

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

// One size of a mix, as it is sent.
struct JobKind {
  SizeShare share;
  grpc::ByteBuffer bytes;  // OptimizeBatchRequest
};

struct LoadOptions {
  double rate = 0;    // jobs a second; 0: closed loop, `in_flight` jobs at all times
  int in_flight = 1;  // of the closed loop
  Arrivals arrivals = Arrivals::kEven;
  absl::Duration warm_up = absl::Seconds(1);  // before the duration: sent, and not counted
  absl::Duration duration = absl::Seconds(10);
  absl::Duration deadline = absl::Seconds(30);  // of each job, from when it is sent
  int max_in_flight = 10'000;  // open loop: jobs beyond are not sent, and counted as that
  uint64_t seed = 1;
  std::string token;  // bearer token; empty: none
};

// Jobs of one outcome.
struct Tally {
  uint64_t jobs = 0;
  LatencyHistogram latency;    // from the time the job was meant to be sent to its status
  LatencyHistogram from_sent;  // from when it was sent: without the delays of the generator

  void Add(absl::Duration latency_of_job, absl::Duration from_sent_of_job) {
    ++jobs;
    latency.Record(latency_of_job);
    from_sent.Record(from_sent_of_job);
  }
};

struct LoadResult {
  std::vector<Tally> ok;              // by position in the kinds
  std::vector<uint64_t> sent;         // by position in the kinds
  std::map<std::string, Tally> code;  // all outcomes, OK too; INCOMPLETE: OK with answers missing
  std::map<std::string, std::string> example;  // a message of each outcome but OK
  LatencyHistogram send_lag;                   // how much later than meant jobs were sent
  uint64_t not_sent = 0;
  absl::Duration duration;
};

// Runs to the end of the last job. Jobs go to `channels` in turn. REQUIRES: neither list is empty.
LoadResult RunLoad(const LoadOptions& options, const std::vector<JobKind>& kinds,
                   const std::vector<std::shared_ptr<grpc::Channel>>& channels);

}  // namespace traverse::loadgen

#endif  // TRAVERSE_CLIENT_LOADGEN_LOAD_RUN_H_
