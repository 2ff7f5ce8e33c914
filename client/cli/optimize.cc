#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/cli/command.h"
#include "client/cli/gcode_output.h"
#include "client/cli/run_flags.h"
#include "client/cli/service.h"
#include "client/cli/strategy_spec.h"
#include "client/cli/terminal.h"
#include "client/files/read_file.h"
#include "client/files/write_file.h"
#include "client/formats/detect.h"
#include "client/formats/read_input.h"
#include "client/report/json.h"
#include "client/report/summary.h"
#include "client/view/job_scene.h"

namespace traverse::cli {
namespace {

// What the command line asks for; checked before the file is read.
struct Request : RunFlags {
  std::vector<StrategySpec> strategy;  // one or, for the service's default, none
};

absl::StatusOr<Request> ParseRequest(const Flags& flags) {
  auto run = ParseRunFlags(flags);
  if (!run.ok()) return run.status();
  Request request;
  static_cast<RunFlags&>(request) = *std::move(run);
  if (flags.Has("strategy")) {
    auto specs = ParseStrategySpecs(flags.Text("strategy"));
    if (!specs.ok()) return specs.status();
    if (specs->size() > 1) return absl::InvalidArgumentError("--strategy takes one strategy");
    request.strategy = *std::move(specs);
  }
  return request;
}

// Where the G-code goes; empty for none. A fault for outputs that the format cannot have.
absl::StatusOr<std::string> TargetOf(const Flags& flags, const InputJob& job) {
  if (job.format == InputFormat::kGcode) return GcodeTarget(flags, job.name);
  if (flags.Has("o")) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "-o is for G-code; the routes of %s go to --json=FILE", FormatName(job.format)));
  }
  return std::string();
}

// `auto` looks at a file of G-code twice, the second time with less latitude.
bool IsAskedTwice(const InputJob& job, const StrategySpec* strategy, const JobFlags& flags) {
  const v1::Strategy& named = strategy != nullptr ? strategy->strategy : job.options.strategy();
  return named.name() == "auto" && flags.deadline == absl::InfiniteDuration();
}

// The G-code of `runs`, which begins with one run; a second joins it if that is worth while.
Expected<GcodeRewrite> Rewritten(Service& service, const Request& request, const InputJob& job,
                                 std::vector<report::JobRun>& runs, const GcodeOptions& options) {
  const StrategySpec* strategy = request.strategy.empty() ? nullptr : &request.strategy[0];
  if (IsAskedTwice(job, strategy, request.job)) {
    InputJob narrow;
    narrow.name = job.name;
    narrow.options = job.options;
    narrow.layers = NarrowLayers(job, options);
    Expected<report::JobRun> second =
        service.Optimize(narrow, strategy, request.job, request.quiet);
    if (Outcome* outcome = std::get_if<Outcome>(&second)) return *outcome;
    runs.push_back(std::get<report::JobRun>(std::move(second)));
  }
  std::vector<const report::JobRun*> tries;
  for (const report::JobRun& run : runs) tries.push_back(&run);
  absl::StatusOr<GcodeRewrite> rewrite = RewriteByRuns(job, tries, options);
  if (rewrite.ok()) return *std::move(rewrite);
  return InputFault(absl::FailedPreconditionError(
      absl::StrFormat("%s: left as it is, for the new file would not print the same: %s",
                      DisplayName(job.name), std::string(rewrite.status().message()))));
}

// Draws and describes what became of the job. `rewrite` is null if it is no G-code.
Outcome ShowViews(Service& service, const Request& request, const InputJob& job,
                  const std::vector<report::JobRun>& runs, const GcodeRewrite* rewrite) {
  const view::NamedRun named = {runs[0].result.summary.strategy(), &runs[0]};
  if (rewrite != nullptr) {
    const absl::StatusOr<view::Scene> scene = view::GcodeScene(job, named.label, runs, *rewrite);
    if (!scene.ok()) return InputFault(scene.status());
    const absl::Status status = WriteViews(request.views, *scene);
    return status.ok() ? Done() : InputFault(status);
  }
  const Expected<report::JobRun> given = RunAsGiven(service, request.job, job);
  if (const Outcome* outcome = std::get_if<Outcome>(&given)) return *outcome;
  const absl::Status status =
      WriteViews(request.views, view::JobScene(job, std::get<report::JobRun>(given), {named}));
  return status.ok() ? Done() : InputFault(status);
}

Outcome RunOptimize(const Flags& flags) {
  absl::StatusOr<Request> request = ParseRequest(flags);
  if (!request.ok()) return UsageFault(request.status());
  Expected<Service> opened = Service::Open(flags);
  if (Outcome* outcome = std::get_if<Outcome>(&opened)) return *outcome;
  Service& service = std::get<Service>(opened);

  absl::StatusOr<InputJob> job = ReadInput(flags.operands()[0], ParseGcodeOptions(flags));
  if (!job.ok()) return InputFault(job.status());
  const absl::StatusOr<std::string> target = TargetOf(flags, *job);
  if (!target.ok()) return UsageFault(target.status());
  if (absl::Status status = ApplyJobFlags(request->job, *job); !status.ok()) {
    return UsageFault(status);
  }
  if (absl::Status status = CheckViewLayer(request->views, *job); !status.ok()) {
    return UsageFault(status);
  }
  if (Outcome outcome = service.Resolve(request->job, *job, request->strategy);
      outcome.code != kDone) {
    return outcome;
  }
  const StrategySpec* strategy = request->strategy.empty() ? nullptr : &request->strategy[0];
  Expected<report::JobRun> ran = service.Optimize(*job, strategy, request->job, request->quiet);
  if (Outcome* outcome = std::get_if<Outcome>(&ran)) return *outcome;
  std::vector<report::JobRun> runs;
  runs.push_back(std::get<report::JobRun>(std::move(ran)));

  std::optional<GcodeRewrite> rewrite;
  if (job->gcode != nullptr && (!target->empty() || request->views.any())) {
    Expected<GcodeRewrite> made =
        Rewritten(service, *request, *job, runs, ParseGcodeOptions(flags));
    if (Outcome* outcome = std::get_if<Outcome>(&made)) return *outcome;
    rewrite = std::get<GcodeRewrite>(std::move(made));
  }
  if (!request->json.empty()) {
    const absl::Status status = WriteWholeFile(
        request->json, report::RoutesJson(*job, runs[0], rewrite ? &*rewrite : nullptr));
    if (!status.ok()) return InputFault(status);
  }
  if (request->views.any()) {
    const Outcome outcome = ShowViews(service, *request, *job, runs, rewrite ? &*rewrite : nullptr);
    if (outcome.code != kDone) return outcome;
  }
  std::string summary = report::OptimizeSummary(*job, runs[0]);
  if (!target->empty()) {
    summary += GcodeSummary(*rewrite);
    const absl::Status status = WriteGcode(*rewrite, *job, *target);
    if (!status.ok()) return InputFault(status);
  }
  if (!request->quiet) {
    // Standard output is the document's or the G-code's where that was asked for there.
    Print(request->json == "-" || *target == "-" ? stderr : stdout, summary);
  }
  return Done();
}

}  // namespace

Command OptimizeCommand() {
  Command command;
  command.name = "optimize";
  command.operands = {"INPUT"};
  command.summary = "Shortens the travel of a job.";
  command.flags = WithRunFlagTable({
      {"o", "OUTPUT", "G-code (default: INPUT; with --json none)"},
      {"strategy", "NAME", "see `traverse strategies`; or NAME:OPTION=VALUE"},
      {"quiet", "", "no progress, no summary"},
  });
  command.example = "traverse optimize part.gcode -o shorter.gcode --policy=balanced";
  command.run = RunOptimize;
  return command;
}

}  // namespace traverse::cli
