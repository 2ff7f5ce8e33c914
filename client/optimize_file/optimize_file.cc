#include "client/optimize_file/optimize_file.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <optional>
#include <utility>

#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/files/read_file.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/parallel.h"

namespace traverse {
namespace {

// Searches for what was asked for; the others are what Crossings::kKeep would ask for.
constexpr size_t kOwnSearches = 2;

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

// `auto` searches a file of G-code twice, the second time with less freedom.
bool IsAskedTwice(const InputJob& job, const SearchOptions& options) {
  const v1::Strategy& named = options.strategy ? *options.strategy : job.options.strategy();
  return named.name() == "auto";
}

// How many times as long as the searches of a file up to search `number`, from 0, takes what
// follows, beside SecondsBehind: the other searches, which are two or, with `fewer` crossings,
// four, and what makes their orders better.
double StagesBehind(size_t number, bool fewer) {
  constexpr std::array<double, 4> kSearches = {1, 0.45, 1, 0.45};
  constexpr double kBetterOrders = 1;  // beside all searches
  const auto sum = [&](size_t count) {
    return std::accumulate(kSearches.begin(), kSearches.begin() + count, 0.0);
  };
  const double all = sum(fewer ? 4 : 2);
  const double begun = sum(number + 1);
  return (all - begun + kBetterOrders * all) / begun;
}

// The layers of `job` again, with plans of less freedom.
InputJob NarrowJob(const InputJob& job, const GcodeOptions& options, const JobResult& found) {
  InputJob narrow;
  narrow.name = job.name;
  narrow.options = job.options;
  narrow.layers = NarrowLayers(job, options, found.layers);
  return narrow;
}

// The layers of `job` with crossings at the price of Crossings::kKeep. At a higher price, orders
// that cross few walls make long detours, which Policy::kSafe forbids.
InputJob JobWithUsualCrossings(const InputJob& job) {
  InputJob usual;
  usual.name = job.name;
  usual.options = job.options;
  usual.gcode = job.gcode;
  usual.first_layer = job.first_layer;
  (*usual.options.mutable_strategy()->mutable_options())["bound"] = "false";
  usual.layers = job.layers;
  for (v1::Layer& layer : usual.layers) {
    if (!layer.cost().has_time()) continue;
    layer.mutable_cost()->mutable_time()->set_crossing_seconds(gcode::kKeepCrossingSeconds);
  }
  return usual;
}

// Adds a search of `job` to those made, unless its time is over: then the earlier results have to
// do.
absl::Status SearchAgain(OptimizerClient& client, const InputJob& job, SearchOptions search,
                         bool fewer, bool may_be_late, std::vector<report::JobRun>& runs) {
  if (absl::Now() >= search.finish_by) return absl::OkStatus();
  for (const report::JobRun& run : runs) search.seconds_before += run.wall_seconds;
  search.stages_behind = StagesBehind(runs.size(), fewer);
  search.deadline = absl::InfiniteDuration();  // it is part of finish_by, and nothing may be late
  absl::StatusOr<report::JobRun> run = Search(client, job, search);
  const bool late = absl::IsDeadlineExceeded(run.status()) && may_be_late;
  if (!run.ok()) return late ? absl::OkStatus() : run.status();
  runs.push_back(*std::move(run));
  return absl::OkStatus();
}

// Adds both searches that Crossings::kKeep would make.
absl::Status SearchAsUsual(OptimizerClient& client, const InputJob& job,
                           const OptimizeFileOptions& options, const SearchOptions& search,
                           bool may_be_late, std::vector<report::JobRun>& runs) {
  const InputJob usual = JobWithUsualCrossings(job);
  const size_t before = runs.size();
  absl::Status first = SearchAgain(client, usual, search, true, may_be_late, runs);
  if (!first.ok() || runs.size() == before) return first;
  GcodeOptions keep = options.gcode;
  keep.crossings = gcode::Crossings::kKeep;
  return SearchAgain(client, NarrowJob(usual, keep, runs.back().result), search, true, may_be_late,
                     runs);
}

// The file of `job`, each layer rewritten by the best of `runs`. They answer the layers selected in
// `job`; the others stay as they are.
absl::StatusOr<GcodeRewrite> RewriteByRuns(const InputJob& job,
                                           const std::vector<report::JobRun>& runs,
                                           const GcodeOptions& options, bool forecast_fast,
                                           std::optional<gcode::PolishLimit> polish) {
  std::vector<gcode::FileOrder> tries;
  for (const report::JobRun& run : runs) {
    gcode::FileOrder& orders = tries.emplace_back(job.gcode->layers.size());
    for (size_t i = 0; i < run.result.layers.size(); ++i) {
      const size_t layer = job.first_layer + i;
      orders[layer] = OrderOf(*job.gcode, layer, run.result.layers[i]);
    }
  }
  RewriteOptions rewrite;
  static_cast<gcode::Liberties&>(rewrite) = options;
  rewrite.version = TRAVERSE_VERSION;
  rewrite.threads = gcode::ThreadsFor(job.gcode->text.size());
  rewrite.polish = std::move(polish);
  rewrite.usual_tries = runs.size() > kOwnSearches ? runs.size() - kOwnSearches : 0;
  rewrite.hidden = job.hidden;
  rewrite.forecast_fast = forecast_fast;
  return RewriteGcode(*job.gcode, tries, rewrite);
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

// What making orders better and writing them takes for the paths of `job`, though the searches may
// have been done at once. Of 90 forecasts of nine files four are off by more than a factor of two.
double SecondsBehind(const InputJob& job) {
  constexpr double kProcessorSecondsPerPath = 0.55e-3;
  double paths = 0;
  for (const v1::Layer& layer : job.layers) paths += layer.plan().paths_size();
  const int threads = job.gcode ? gcode::ThreadsFor(job.gcode->text.size()) : 1;
  return kProcessorSecondsPerPath * paths / threads;
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
  if (options.progress.on_search) options.progress.on_search(job.layers.size());
  if (options.progress.on_work) {
    options.progress.on_work({WorkOf(job), options.seconds_before, options.stages_behind,
                              options.stages_behind > 0 ? SecondsBehind(job) : 0});
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
  search.finish_by = options.finish_by - WritingTime(job.gcode->text.size(), options.reading,
                                                     options.finish_by - absl::Now());
  if (absl::Now() >= search.finish_by) {
    return SearchFault(absl::DeadlineExceededError("no time is left for a search"));
  }
  OptimizedFile made;
  const bool twice = IsAskedTwice(job, options);
  const bool fewer = options.gcode.crossings == gcode::Crossings::kFewer;
  search.stages_behind = twice ? StagesBehind(0, fewer) : 0;
  absl::StatusOr<report::JobRun> first = Search(client, job, search);
  search.finish_by = std::min(search.finish_by, due);
  if (!first.ok()) return SearchFault(first.status());
  made.runs.push_back(*std::move(first));
  if (twice) {
    const bool may_be_late = search.finish_by != absl::InfiniteFuture();
    absl::Status again = SearchAgain(client, NarrowJob(job, options.gcode, made.runs[0].result),
                                     search, fewer, may_be_late, made.runs);
    if (again.ok() && fewer) {
      again = SearchAsUsual(client, job, options, search, may_be_late, made.runs);
    }
    if (!again.ok()) return SearchFault(again);
  }
  // A caller who names a quicker strategy does not want further searches.
  std::optional<gcode::PolishLimit> polish;
  if (twice) polish = {search.finish_by, options.cancel};
  absl::StatusOr<GcodeRewrite> rewrite = RewriteByRuns(
      job, made.runs, options.gcode, options.forecast_fast && twice, std::move(polish));
  const absl::Status in_time = job.gcode->limit.status();
  if (!in_time.ok()) return SearchFault(in_time);
  if (!rewrite.ok()) {
    return FileFault{FileStage::kWrite,
                     absl::FailedPreconditionError(absl::StrFormat(
                         "%s: left unchanged, because the new file would not print the same: %s",
                         DisplayName(job.name), std::string(rewrite.status().message())))};
  }
  if (options.cancel.stop_requested()) return SearchFault(absl::CancelledError("cancelled"));
  made.rewrite = *std::move(rewrite);
  if (options.restate_times && made.rewrite.layers_changed > 0) {
    made.times = ScaleOf(made.rewrite);
    made.rewrite.text = gcode::RestateOptimised(made.rewrite.text, *made.times);
  }
  return made;
}

absl::Duration WritingTime(size_t bytes, absl::Duration reading, absl::Duration left) {
  constexpr absl::Duration kLeast = absl::Milliseconds(100);
  constexpr double kSecondsPerByte = 0.25e-6;
  constexpr double kReadings = 4;  // files of many small layers take up to ten
  const absl::Duration idle = kLeast + absl::Seconds(kSecondsPerByte * static_cast<double>(bytes));
  return std::max(idle, std::min(kReadings * reading, left / 2));
}

}  // namespace traverse
