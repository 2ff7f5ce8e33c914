// The results of a load run, for people and for scripts.

#ifndef TRAVERSE_CLIENT_LOADGEN_LOAD_REPORT_H_
#define TRAVERSE_CLIENT_LOADGEN_LOAD_REPORT_H_

#include <string>
#include <vector>

#include "client/loadgen/load_plan.h"
#include "client/loadgen/load_run.h"

namespace traverse::loadgen {

// The settings of the run.
struct LoadHeading {
  std::string target;
  std::string strategy;
  LoadOptions options;
  size_t connections = 1;
  std::vector<SizeShare> mix;
};

// A table of latencies by size of job, then by outcome; milliseconds.
std::string LoadTable(const LoadHeading& heading, const LoadResult& result);

// One document, ended by a newline:
//   {"target": , "strategy": , "rate": null in a closed loop, "in_flight": null in an open one,
//    "seconds": , "seed": , "connections": , "sent": , "ok": , "ok_per_second": , "not_sent": ,
//    "send_lag_ms": LATENCY,
//    "sizes": [{"layers": , "sent": , "ok": , "latency_ms": LATENCY}],
//    "codes": {"OK": {"jobs": , "latency_ms": LATENCY, "from_sent_ms": LATENCY}, ...}}
// LATENCY is {"mean": , "p50": , "p90": , "p99": , "p99_9": , "max": }, null without jobs.
std::string LoadJson(const LoadHeading& heading, const LoadResult& result);

}  // namespace traverse::loadgen

#endif  // TRAVERSE_CLIENT_LOADGEN_LOAD_REPORT_H_
