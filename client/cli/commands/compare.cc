#include "client/report/compare.h"

#include <google/protobuf/util/time_util.h>

#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/cli/command.h"
#include "client/cli/flags/run_flags.h"
#include "client/cli/flags/strategy_spec.h"
#include "client/cli/gcode_output.h"
#include "client/cli/service.h"
#include "client/cli/terminal.h"
#include "client/files/read_file.h"
#include "client/files/write_file.h"
#include "client/formats/read_input.h"
#include "client/report/json.h"
#include "client/report/reductions.h"
#include "client/view/scene/job_scene.h"

namespace traverse::cli {
namespace {

using google::protobuf::util::TimeUtil;

constexpr uint64_t kMaxRepeats = 1000;

// A table of all strategies should not wait two hours for the proof that `exact` looks for. The
// others end by themselves, and are compared by what they find until then: cut short, they show
// little but luck. There is no deadline: on a busy machine a late answer is better than none.
constexpr int64_t kSecondsOfSearch = 60;
constexpr int64_t kSecondsOfProof = 5;
constexpr int64_t kMillisOfProofOfLayer = 500;  // otherwise the first layers use up the time

struct Request : RunFlags {
  std::vector<StrategySpec> strategies;  // empty: all strategies of the service
  uint64_t repeats = 1;
  bool limits_time = false;  // by default
  GcodeOptions gcode;
  PlateOptions plates;
};

absl::StatusOr<Request> ParseRequest(const Flags& flags) {
  auto run = ParseRunFlags(flags);
  if (!run.ok()) return run.status();
  Request request;
  static_cast<RunFlags&>(request) = *std::move(run);
  request.limits_time = !flags.Has("deadline") && !flags.Has("strategies");
  if (flags.Has("strategies")) {
    auto specs = ParseStrategySpecs(flags.Text("strategies"));
    if (!specs.ok()) return specs.status();
    request.strategies = *std::move(specs);
  }
  absl::StatusOr<GcodeOptions> gcode = ParseGcodeOptions(flags);
  if (!gcode.ok()) return gcode.status();
  request.gcode = *std::move(gcode);
  const auto repeats = flags.Integer("repeat", 1, kMaxRepeats);
  if (!repeats.ok()) return repeats.status();
  request.repeats = repeats->value_or(1);
  const auto plates = ParsePlateOptions(flags);
  if (!plates.ok()) return plates.status();
  request.plates = *plates;
  return request;
}

// Lists the service's strategies if the user named none.
Outcome ListAll(Service& service, std::vector<StrategySpec>& specs) {
  if (!specs.empty()) return Done();
  Expected<v1::ListStrategiesResponse> listed = service.ListStrategies();
  if (Outcome* outcome = std::get_if<Outcome>(&listed)) return *outcome;
  for (const v1::StrategyInfo& info : std::get<v1::ListStrategiesResponse>(listed).strategies()) {
    StrategySpec& spec = specs.emplace_back();
    spec.label = info.name();
    spec.strategy.set_name(info.name());
  }
  return Done();
}

void LimitTime(const StrategySpec& spec, v1::JobOptions& options) {
  const bool proves = spec.strategy.name() == "exact";
  *options.mutable_time_limit() =
      TimeUtil::SecondsToDuration(proves ? kSecondsOfProof : kSecondsOfSearch);
  if (!proves || options.has_layer_time_limit()) return;
  *options.mutable_layer_time_limit() = TimeUtil::MillisecondsToDuration(kMillisOfProofOfLayer);
}

// Runs each strategy with each seed.
Outcome RunAll(Service& service, const Request& request, InputJob& job,
               std::vector<report::ComparedStrategy>& out) {
  const uint64_t first_seed = job.options.has_seed() ? job.options.seed() : 1;
  for (const StrategySpec& spec : request.strategies) {
    report::ComparedStrategy& compared = out.emplace_back();
    compared.label = spec.label;
    const v1::JobOptions asked = job.options;
    if (request.limits_time) LimitTime(spec, job.options);
    for (uint64_t i = 0; i < request.repeats; ++i) {
      job.options.set_seed(first_seed + i);
      Expected<report::JobRun> ran = service.Optimize(job, &spec, request.job, request.quiet);
      if (Outcome* outcome = std::get_if<Outcome>(&ran)) return *outcome;
      compared.runs.push_back(std::get<report::JobRun>(std::move(ran)));
    }
    job.options = asked;
  }
  return Done();
}

// Draws and describes the first run of each strategy, with the best one in front. If one of
// them is `none`, the others are compared with it and it has no row of its own.
Outcome ShowViews(Service& service, const Request& request, const InputJob& job,
                  const std::vector<report::ComparedStrategy>& compared) {
  const Expected<report::JobRun> given = RunAsGiven(service, request.job, job);
  if (const Outcome* outcome = std::get_if<Outcome>(&given)) return *outcome;
  const report::CompareBy by = report::CompareByOf(job.options);
  std::vector<view::NamedRun> runs;
  for (const report::ComparedStrategy& strategy : compared) {
    if (strategy.label == "none" && compared.size() > 1) continue;
    runs.push_back({strategy.label, &strategy.runs.front()});
  }
  view::Scene scene = view::JobScene(job, std::get<report::JobRun>(given), runs);
  const auto value = [&](size_t route) { return report::ComparedValue(*runs[route - 1].run, by); };
  for (size_t i = 1; i < scene.routes.size(); ++i) {
    if (value(i) < value(scene.shown)) scene.shown = i;
  }
  const absl::Status status = WriteViews(request.views, scene);
  return status.ok() ? Done() : InputFault(status);
}

Outcome RunCompare(const Flags& flags) {
  absl::StatusOr<Request> request = ParseRequest(flags);
  if (!request.ok()) return UsageFault(request.status());
  Expected<Service> opened = Service::Open(flags);
  if (Outcome* outcome = std::get_if<Outcome>(&opened)) return *outcome;
  Service& service = std::get<Service>(opened);

  absl::StatusOr<InputJob> job = ReadInput(flags.operands()[0], request->gcode, request->plates);
  if (!job.ok()) return InputFault(job.status());
  if (absl::Status status = ApplyJobFlags(request->job, *job); !status.ok()) {
    return UsageFault(status);
  }
  if (absl::Status status = CheckViewLayer(request->views, *job); !status.ok()) {
    return UsageFault(status);
  }
  // A table shows what strategies find, also where nobody would wait for it.
  for (const char* economy : {"least_gain_each", "gain_window"}) {
    job->options.mutable_strategy()->mutable_options()->erase(economy);
  }
  Outcome outcome = ListAll(service, request->strategies);
  if (outcome.code == kDone) outcome = service.Resolve(request->job, *job, request->strategies);
  std::vector<report::ComparedStrategy> compared;
  if (outcome.code == kDone) outcome = RunAll(service, *request, *job, compared);
  if (outcome.code != kDone) return outcome;

  if (!request->json.empty()) {
    const absl::Status status = WriteWholeFile(request->json, report::CompareJson(*job, compared));
    if (!status.ok()) return InputFault(status);
  }
  if (request->views.any()) {
    outcome = ShowViews(service, *request, *job, compared);
    if (outcome.code != kDone) return outcome;
  }
  std::FILE* out = request->json == "-" ? stderr : stdout;
  const report::CompareBy by = report::CompareByOf(job->options);
  Print(out,
        absl::StrFormat("%s: %d layers; %% columns show the %s saved compared with that row\n%s",
                        DisplayName(job->name), job->layers.size(),
                        by == report::CompareBy::kTime ? "time of travel" : "travel",
                        report::CompareTable(compared, StyleFor(out), by)) +
            report::ReductionTable(compared, StyleFor(out)));
  return Done();
}

}  // namespace

Command CompareCommand() {
  return {.name = "compare",
          .operands = {"INPUT"},
          .summary = "Compares strategies on one job.",
          .flags = Joined(
              WithRunFlagTable({
                  {"strategies", "NAME,...", "or NAME:OPTION=VALUE (default: all; exact for 5s)"},
                  {"repeat", "N", "runs of each, one per seed; shows the means"},
                  {"quiet", "", "no progress"},
              }),
              Joined(PlateFlagTable(), {MachineFlag()})),
          .example = "traverse compare part.damat --layers=1-5 --strategies=greedy,ni2opt",
          .run = RunCompare};
}

}  // namespace traverse::cli
