#include "client/optimize_file/optimize_file.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <optional>
#include <thread>
#include <utility>

#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/files/read_file.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/parallel.h"

namespace traverse {
namespace {

// What makes the orders of a search better takes about so many times as long as the search, beside
// SecondsBehind.
constexpr double kBetterOrders = 1;

// The strategy to search with. If the caller names the strategy that the file states, the options
// that the file sets remain, except those that the caller sets.
v1::Strategy StrategyFor(const InputJob& job, const SearchOptions& options) {
  const v1::Strategy& own = job.options.strategy();
  if (!options.strategy || options.strategy->name() != own.name()) {
    return options.strategy.value_or(own);
  }
  v1::Strategy both = own;
  for (const auto& [name, value] : options.strategy->options()) {
    (*both.mutable_options())[name] = value;
  }
  return both;
}

// A caller who names a quicker strategy than `auto` does not want further searches.
bool IsThorough(const InputJob& job, const SearchOptions& options) {
  return StrategyFor(job, options).name() == "auto";
}

// The file of `job`, its layers rewritten by `run`. It answers the layers selected in `job`; the
// others stay as they are.
absl::StatusOr<GcodeRewrite> RewriteByRun(const InputJob& job, const report::JobRun& run,
                                          const OptimizeFileOptions& options, bool thorough,
                                          absl::Time finish_by) {
  gcode::FileOrder found(job.gcode->layers.size());
  for (size_t i = 0; i < run.result.layers.size(); ++i) {
    const size_t layer = job.first_layer + i;
    found[layer] = OrderOf(*job.gcode, layer, run.result.layers[i]);
  }
  RewriteOptions rewrite;
  static_cast<gcode::Liberties&>(rewrite) = options.gcode;
  rewrite.version = TRAVERSE_VERSION;
  rewrite.threads = gcode::ThreadsFor(job.gcode->text.size());
  if (thorough) rewrite.polish = gcode::PolishLimit{gcode::WorkLimit(finish_by, options.cancel)};
  rewrite.hidden = job.hidden;
  rewrite.forecast_fast = options.forecast_fast && thorough;
  return RewriteGcode(*job.gcode, found, rewrite);
}

// How the estimate changed, as far as the line in the file can say it.
gcode::TimeScale ScaleOf(const GcodeRewrite& rewrite) {
  const auto ratio = [](double before, double after) { return before > 0 ? after / before : 1; };
  return gcode::RoundScale({ratio(rewrite.before.seconds, rewrite.after.seconds),
                            ratio(rewrite.first_before.seconds, rewrite.first_after.seconds)});
}

// Limits the search of `asked` so that its answers come back within `time`.
void LimitTime(absl::Duration time, v1::JobOptions& asked) {
  constexpr double kOfReturn = 0.1;
  constexpr absl::Duration kMostOfReturn = absl::Milliseconds(500);
  constexpr absl::Duration kLeast = absl::Microseconds(1);
  constexpr absl::Duration kMost = absl::Hours(24 * 365);
  time = std::clamp(time - std::min(time * kOfReturn, kMostOfReturn), kLeast, kMost);
  google::protobuf::Duration& limit = *asked.mutable_time_limit();
  const absl::Duration own = absl::Seconds(limit.seconds()) + absl::Nanoseconds(limit.nanos());
  if (own > absl::ZeroDuration() && own <= time) return;
  limit.set_seconds(absl::ToInt64Seconds(time));
  limit.set_nanos(static_cast<int32_t>(
      absl::ToInt64Nanoseconds(time - absl::Seconds(absl::ToInt64Seconds(time)))));
}

// A layer's search takes as long as its paths and their points are many.
std::vector<double> WorkOf(const InputJob& job) {
  std::vector<double> work;
  for (const v1::Layer& layer : job.layers) {
    double sum = 1;
    for (const v1::PlanPath& path : layer.plan().paths()) {
      sum += 1 + path.contour().points_size() / 2 + path.open_path().points_size() / 2;
    }
    for (const v1::Island& island : layer.islands()) {
      for (const v1::Contour& contour : island.contours()) sum += 1 + contour.points_size() / 2;
      for (const v1::OpenPath& raster : island.rasters()) sum += 1 + raster.points_size() / 2;
    }
    work.push_back(sum);
  }
  return work;
}

// What making orders better and writing them takes for the paths of `job`, though the search may
// have been done at once.
double SecondsBehind(const InputJob& job, double load) {
  constexpr double kProcessorSecondsPerPath = 0.55e-3;
  double paths = 0;
  for (const v1::Layer& layer : job.layers) paths += layer.plan().paths_size();
  const int threads = job.gcode ? gcode::ThreadsFor(job.gcode->text.size()) : 1;
  return load * kProcessorSecondsPerPath * paths / threads;
}

using Answers = std::vector<std::optional<v1::LayerResult>>;  // [layer]

size_t Missed(const Answers& answers) {
  return static_cast<size_t>(std::count(answers.begin(), answers.end(), std::nullopt));
}

// Whether what came before the call failed is worth keeping: the service has become silent, was
// lost or is full, and the caller has said how long to wait.
bool MayStandIn(const absl::Status& status, const SearchOptions& options) {
  const bool is_limited = options.deadline != absl::InfiniteDuration();
  return options.stand_in && is_limited &&
         (absl::IsDeadlineExceeded(status) || absl::IsUnavailable(status) ||
          absl::IsResourceExhausted(status));
}

// The job with the answers that there are, and greedy's for the other layers.
absl::StatusOr<JobResult> FinishByGreedy(const InputJob& job, v1::JobOptions asked,
                                         const SearchOptions& options, const Answers& answers) {
  absl::StatusOr<OptimizerClient*> client = options.stand_in();
  if (!client.ok()) return client.status();
  const v1::Strategy wanted = asked.strategy();
  asked.mutable_strategy()->Clear();
  asked.mutable_strategy()->set_name("greedy");
  asked.clear_time_limit();
  CallOptions call;
  call.cancel = options.cancel;
  call.on_layer = options.progress.on_layer;
  call.known = answers;
  absl::StatusOr<JobResult> result = (*client)->Optimize(asked, job.layers, call);
  if (result.ok() && !wanted.name().empty()) result->summary.set_strategy(wanted.name());
  return result;
}

FileFault SearchFault(absl::Status status) { return {FileStage::kSearch, std::move(status)}; }

}  // namespace

absl::StatusOr<report::JobRun> Search(OptimizerClient& client, const InputJob& job,
                                      const SearchOptions& options) {
  v1::JobOptions asked = job.options;
  *asked.mutable_strategy() = StrategyFor(job, options);
  if (options.progress.on_search) {
    SearchWork work{WorkOf(job)};
    if (options.improves_orders) {
      work.stages_behind = kBetterOrders;
      work.seconds_behind = SecondsBehind(job, options.load);
    }
    options.progress.on_search(work);
  }
  const absl::Time began = absl::Now();
  CallOptions call;
  if (options.deadline != absl::InfiniteDuration()) LimitTime(options.deadline, asked);
  call.deadline = std::min(options.deadline + SearchOptions::kPatience, options.finish_by - began);
  call.cancel = options.cancel;
  Answers answers(job.layers.size());
  call.on_layer = [&](const v1::LayerResult& layer) {
    if (options.stand_in) answers[layer.index()] = layer;
    if (options.progress.on_layer) options.progress.on_layer(layer);
  };
  report::JobRun run;
  run.seed = asked.has_seed() ? asked.seed() : 1;
  absl::StatusOr<JobResult> result = client.Optimize(asked, job.layers, call);
  if (const size_t missed = Missed(answers);
      MayStandIn(result.status(), options) && missed < answers.size()) {
    run.missed_layers = missed;
    run.missed_because = result.status();
    result = FinishByGreedy(job, asked, options, answers);
  }
  if (!result.ok()) return result.status();
  run.result = *std::move(result);
  run.wall_seconds = absl::ToDoubleSeconds(absl::Now() - began);
  return run;
}

FileResult<OptimizedFile> OptimizeFile(OptimizerClient& client, const InputJob& job,
                                       const OptimizeFileOptions& options) {
  assert(job.gcode != nullptr);
  SearchOptions search = options;
  const absl::Time due = absl::Now() + options.deadline;
  search.finish_by =
      options.finish_by - WritingTime(job.gcode->text.size(), options.load, options.reading,
                                      options.finish_by - absl::Now());
  if (absl::Now() >= search.finish_by) {
    return SearchFault(absl::DeadlineExceededError("no time is left for a search"));
  }
  const bool thorough = IsThorough(job, options);
  search.improves_orders = thorough;
  absl::StatusOr<report::JobRun> run = Search(client, job, search);
  if (!run.ok()) return SearchFault(run.status());
  absl::StatusOr<GcodeRewrite> rewrite =
      RewriteByRun(job, *run, options, thorough, std::min(search.finish_by, due));
  const absl::Status in_time = job.gcode->limit.status();
  if (!in_time.ok()) return SearchFault(in_time);
  if (!rewrite.ok()) {
    return FileFault{FileStage::kWrite,
                     absl::FailedPreconditionError(absl::StrFormat(
                         "%s: left unchanged, because the new file would not print the same: %s",
                         DisplayName(job.name), std::string(rewrite.status().message())))};
  }
  if (options.cancel.stop_requested()) return SearchFault(absl::CancelledError("cancelled"));
  OptimizedFile made{*std::move(run), *std::move(rewrite)};
  if (options.restate_times && made.rewrite.layers_changed > 0) {
    made.times = ScaleOf(made.rewrite);
    made.rewrite.text = gcode::RestateOptimised(made.rewrite.text, *made.times);
  }
  return made;
}

double ProcessorLoad() {
  double of_last_minute = 0;
  if (getloadavg(&of_last_minute, 1) != 1) return 1;
  return std::max(1.0, of_last_minute / std::max(1u, std::thread::hardware_concurrency()));
}

absl::Duration WritingTime(size_t bytes, double load, absl::Duration reading, absl::Duration left) {
  constexpr absl::Duration kLeast = absl::Milliseconds(100);
  constexpr double kSecondsPerByte = 0.25e-6;
  constexpr double kReadings = 4;  // files of many small layers take up to ten
  const absl::Duration idle = kLeast + absl::Seconds(kSecondsPerByte * static_cast<double>(bytes));
  // Reading alone does not tell: a thread that has just woken gets a processor sooner than one that
  // has searched for long. Nor does the load of the last minute while more and more come: those who
  // came in front of us come once more.
  const absl::Duration busy = (2 * load - 1) * idle;
  return std::max(idle, std::min(std::max(busy, kReadings * reading), left / 2));
}

}  // namespace traverse
