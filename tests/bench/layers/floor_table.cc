// Whether anything costs more than greedy's chain, however short the time and however busy the
// machine:
//
//   floor_table                  all parts: about twenty minutes
//   floor_table --quick          one part and two deadlines, a test
//   floor_table part2 s4_grille  these parts
//
// Prints, for each strategy, way of asking and number of busy loops beside, the greatest ratio of a
// job's cost to that of greedy's chain, and how many jobs had no answer. Fails if a ratio is above
// 1, or if the command line has no answer. Jobs are the first five layers of a part, with deadlines
// from 50 ms to 2 s.

#include <grpcpp/client_context.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/api/embedded.h"
#include "client/api/optimizer_client.h"
#include "client/formats/read_input.h"
#include "client/optimize_file/job_settings.h"
#include "client/optimize_file/optimize_file.h"

namespace traverse {
namespace {

constexpr size_t kLayers = 5;
constexpr double kRounding = 1e-9;

enum class Asked { kBatch, kStream, kCommandLine };

const char* NameOf(Asked asked) {
  switch (asked) {
    case Asked::kBatch:
      return "batch";
    case Asked::kStream:
      return "stream";
    case Asked::kCommandLine:
      return "command line";
  }
  return "";
}

// Threads that take what they get of the machine.
class BusyLoops {
 public:
  explicit BusyLoops(int count) {
    for (int i = 0; i < count; ++i) {
      threads_.emplace_back([this] {
        while (!stop_) {
        }
      });
    }
  }
  ~BusyLoops() {
    stop_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

// The cost of the job's layers together; unset without an answer.
std::optional<double> BatchCost(EmbeddedService& service, const InputJob& job,
                                absl::Duration deadline) {
  const auto stub = v1::RouteOptimizerService::NewStub(service.channel());
  grpc::ClientContext context;
  context.set_deadline(absl::ToChronoTime(absl::Now() + deadline));
  v1::OptimizeBatchRequest request;
  *request.mutable_options() = job.options;
  request.mutable_layers()->Assign(job.layers.begin(), job.layers.end());
  const auto reader = stub->OptimizeBatch(&context, request);
  double cost = 0;
  v1::OptimizeBatchResponse response;
  while (reader->Read(&response)) cost += response.layer().cost();
  if (!reader->Finish().ok()) return std::nullopt;
  return cost;
}

std::optional<double> CostOf(absl::Span<const v1::LayerResult> layers) {
  double cost = 0;
  for (const v1::LayerResult& layer : layers) cost += layer.cost();
  return cost;
}

std::optional<double> CostOfJob(EmbeddedService& service, const InputJob& job, Asked asked,
                                absl::Duration deadline) {
  if (asked == Asked::kBatch) return BatchCost(service, job, deadline);
  OptimizerClient client(service.channel());
  if (asked == Asked::kStream) {
    const auto result = client.Optimize(job.options, job.layers, {.deadline = deadline});
    return result.ok() ? CostOf(result->layers) : std::nullopt;
  }
  SearchOptions search;
  search.deadline = deadline;
  const auto run = Search(client, job, search);
  return run.ok() ? CostOf(run->result.layers) : std::nullopt;
}

std::optional<InputJob> ReadPart(const std::string& part) {
  for (const char* ending : {".damat", ".damat.xz"}) {
    absl::StatusOr<InputJob> job = ReadInput("tests/bench/instances/" + part + ending);
    if (!job.ok()) continue;
    if (job->layers.size() > kLayers) job->layers.resize(kLayers);
    if (!ApplySettings({}, *job).ok()) return std::nullopt;
    return *std::move(job);
  }
  std::fprintf(stderr, "%s: not read\n", part.c_str());
  return std::nullopt;
}

struct Table {
  std::vector<std::string> parts;
  std::vector<absl::Duration> deadlines;
};

// Prints a row. Returns whether the promises hold.
bool Row(EmbeddedService& service, const std::vector<InputJob>& jobs,
         const std::vector<double>& greedy, const Table& table, const std::string& strategy,
         Asked asked, int busy) {
  double worst = 0;
  int unanswered = 0;
  std::string where;
  for (size_t i = 0; i < jobs.size(); ++i) {
    InputJob job = jobs[i];
    job.options.mutable_strategy()->set_name(strategy);
    for (const absl::Duration deadline : table.deadlines) {
      const std::optional<double> cost = CostOfJob(service, job, asked, deadline);
      if (!cost) ++unanswered;
      if (!cost || *cost / greedy[i] <= worst) continue;
      worst = *cost / greedy[i];
      where = table.parts[i] + " in " + absl::FormatDuration(deadline);
    }
  }
  std::printf("| %s | %s | %d | %.4f | %s | %d |\n", strategy.c_str(), NameOf(asked), busy, worst,
              where.c_str(), unanswered);
  std::fflush(stdout);
  return worst <= 1 + kRounding && (asked != Asked::kCommandLine || unanswered == 0);
}

int Run(const Table& table) {
  auto service = EmbeddedService::Start(2);
  if (!service.ok()) return 2;
  std::vector<InputJob> jobs;
  std::vector<double> greedy;
  for (const std::string& part : table.parts) {
    std::optional<InputJob> job = ReadPart(part);
    if (!job) return 2;
    job->options.mutable_strategy()->set_name("greedy");
    greedy.push_back(
        CostOfJob(**service, *job, Asked::kStream, absl::InfiniteDuration()).value_or(0));
    jobs.push_back(*std::move(job));
  }
  std::printf("| strategy | asked by | busy loops | greatest ratio | where | no answer |\n");
  std::printf("|---|---|---:|---:|---|---:|\n");
  bool holds = true;
  for (const int busy : {0, 4}) {
    const BusyLoops loops(busy);
    for (const char* strategy : {"greedy", "ni2opt", "tabu", "exact", "auto"}) {
      for (const Asked asked : {Asked::kBatch, Asked::kStream, Asked::kCommandLine})
        holds = Row(**service, jobs, greedy, table, strategy, asked, busy) && holds;
    }
  }
  return holds ? 0 : 1;
}

Table TableOf(int argc, char** argv) {
  Table table;
  for (const int ms : {50, 100, 200, 500, 1000, 2000})
    table.deadlines.push_back(absl::Milliseconds(ms));
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--quick") {
      table.deadlines = {absl::Milliseconds(50), absl::Milliseconds(200)};
      table.parts = {"s5_islands40"};
    } else {
      table.parts.push_back(argv[i]);
    }
  }
  if (table.parts.empty()) {
    table.parts = {"part1", "part2", "part3", "s3_bracket", "s4_grille", "s5_islands40", "s7_text"};
  }
  return table;
}

}  // namespace
}  // namespace traverse

int main(int argc, char** argv) { return traverse::Run(traverse::TableOf(argc, argv)); }
