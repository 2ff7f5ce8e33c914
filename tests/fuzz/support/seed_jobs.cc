#include "tests/fuzz/support/seed_jobs.h"

#include <google/protobuf/text_format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/fuzz/support/proto_mutator.h"

namespace traverse::fuzz {
namespace {

const char* const kJobs[] = {
    R"(options { strategy { name: "ni2opt" options { key: "point_release" value: "false" } } seed: 7 }
       layers { id: 1 z_mm: 0.2
         islands { contours { id: 1 points: [0, 0, 10, 0, 10, 10, 0, 10] }
                   contours { id: 2 points: [2, 2, 4, 2, 4, 4] entries: [0, 2] }
                   rasters { id: 1 points: [1, 1, 9, 1] } rasters { points: [9, 2, 1, 2] one_way: true } }
         islands { contours { points: [30, 0, 40, 0, 40, 10] } rasters { points: [31, 1, 39, 1] } } }
       layers { id: 2 islands { contours { points: [5, 5, 6, 6, 5, 7] } } start { x_mm: 3 y_mm: 4 } })",
    R"(options { job_id: "fuzz" strategy { name: "greedy" } deposition: DEPOSITION_INTERLEAVED
                 start { x_mm: 1 y_mm: 2 } result_order: RESULT_ORDER_BUILD idle_speed_mm_s: 30
                 cleaning { point { x_mm: 50 y_mm: 60 } every_layers: 2 layers_since_cleaning: 1 }
                 cost { time { speed_mm_s: 130 accel_mm_s2: 1250 retraction_seconds: 0.1
                               retraction_threshold_mm: 2 } }
                 time_limit { seconds: 1 } layer_time_limit { nanos: 20000000 } }
       layers { islands { rasters { points: [0, 0, 1, 1, 2, 0] } rasters { points: [5, 0, 5, 9] } } }
       layers { } layers { cost { length { } } islands { contours { points: [7, 7] } } })",
    R"(options { strategy { name: "none" } cost { length { } } }
       layers { plan { paths { contour { points: [0, 0, 1, 0, 1, 1] } }
                       paths { open_path { points: [5, 5, 6, 6] } }
                       paths { open_path { points: [8, 5, 9, 6] one_way: true } }
                       paths { contour { points: [3, 3, 4, 3, 4, 4] entries: [1] } }
                       nodes { in_order { children: [1, 2] } } nodes { path: 0 }
                       nodes { any_order { children: [3, 4, 5] before { first: 0 second: 2 }
                                           before { first: 1 second: 2 } } }
                       nodes { path: 1 } nodes { path: 2 } nodes { path: 3 } }
                initial_route { plan_path: 0 vertex: 2 } initial_route { plan_path: 1 reversed: true }
                initial_route { plan_path: 2 reversed: false } initial_route { plan_path: 3 vertex: 1 } })",
    R"(options { strategy { name: "auto" } time_limit { nanos: 50000000 } }
       layers { islands { contours { points: [0, 0, 3, 0, 3, 3] } contours { points: [1, 1, 2, 1, 2, 2] }
                          rasters { points: [0, 1, 3, 1] } } })",
    R"(options { strategy { name: "tabu" } time_limit { nanos: 50000000 } }
       layers { islands { contours { points: [0, 0, 3, 0, 3, 3] } contours { points: [9, 1, 8, 1, 8, 2] } } })",
    R"(options { strategy { name: "exact" } time_limit { nanos: 50000000 } }
       layers { islands { rasters { points: [0, 0, 3, 0] } rasters { points: [9, 1, 8, 1] } }
                initial_route { island: 0 raster: 1 reversed: true }
                initial_route { island: 0 raster: 0 reversed: true } })",
};

std::vector<v1::OptimizeBatchRequest> ParseJobs() {
  std::vector<v1::OptimizeBatchRequest> jobs;
  for (const char* text : kJobs) {
    if (!google::protobuf::TextFormat::ParseFromString(text, &jobs.emplace_back())) std::abort();
  }
  return jobs;
}

// Jobs grow by copying; past this size one begins anew.
constexpr size_t kMaxJobBytes = 4096;

}  // namespace

const v1::OptimizeBatchRequest& SeedJob(std::mt19937& random) {
  static const std::vector<v1::OptimizeBatchRequest> jobs = ParseJobs();
  return jobs[random() % jobs.size()];
}

size_t MutateJob(uint8_t* data, size_t size, size_t max_size, unsigned int seed) {
  std::mt19937 random(seed);
  v1::OptimizeBatchRequest job;
  if (size == 0 || size > kMaxJobBytes || !job.ParseFromArray(data, static_cast<int>(size))) {
    job = SeedJob(random);
  }
  const auto changes = 1 + random() % 4;
  for (uint64_t i = 0; i < changes; ++i) MutateMessage(job, SeedJob(random), random);
  std::string bytes = job.SerializePartialAsString();
  // One in some is damaged below the level of messages.
  if (!bytes.empty() && random() % 16 == 0) {
    bytes[random() % bytes.size()] = static_cast<char>(random());
  }
  bytes.resize(std::min(bytes.size(), max_size));
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}

}  // namespace traverse::fuzz
