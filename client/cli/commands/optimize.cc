#include <cstdio>
#include <map>
#include <optional>
#include <string>
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
#include "client/formats/detect.h"
#include "client/formats/read_input.h"
#include "client/report/json.h"
#include "client/report/summary.h"
#include "client/view/scene/job_scene.h"
#include "client/warm_start/start_from.h"

namespace traverse::cli {
namespace {

// What the command line asks for; checked before the file is read.
struct Request : RunFlags {
  std::vector<StrategySpec> strategy;  // one strategy, or none for the service's default
  RewriteFlags rewrite;
  PlateOptions plates;
  std::optional<std::vector<EarlierLayer>> start_from;
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
  auto plates = ParsePlateOptions(flags);
  if (!plates.ok()) return plates.status();
  request.plates = *plates;
  absl::StatusOr<GcodeOptions> gcode = ParseGcodeOptions(flags);
  if (!gcode.ok()) return gcode.status();
  request.rewrite = {*std::move(gcode), flags.Switch("restate_times")};
  return request;
}

// Where the G-code goes. Fails for outputs that the format cannot have.
absl::StatusOr<GcodeTarget> TargetOf(const Flags& flags, const InputFile& input) {
  if (input.format == InputFormat::kGcode) return FindGcodeTarget(flags, input);
  for (const char* flag : {"o", "container"}) {
    if (!flags.Has(flag)) continue;
    return absl::InvalidArgumentError(
        absl::StrFormat("%s is for G-code; the routes of %s go to --json=FILE",
                        flag[1] == 0 ? "-o" : "--container", FormatName(input.format)));
  }
  return GcodeTarget{};
}

// The results of the job: its run and, if the file is written or drawn, the new text.
struct Optimized {
  report::JobRun run;
  std::optional<GcodeRewrite> rewrite;
  std::optional<gcode::TimeScale> times;
};

Expected<Optimized> Optimize(Service& service, const Request& request, const InputJob& job,
                             bool rewrite) {
  const StrategySpec* strategy = request.strategy.empty() ? nullptr : &request.strategy[0];
  if (rewrite) {
    Expected<OptimizedFile> file =
        service.Rewrite(job, strategy, request.job, request.rewrite, request.quiet);
    if (Outcome* outcome = std::get_if<Outcome>(&file)) return *outcome;
    auto& [run, text, times] = std::get<OptimizedFile>(file);
    return Optimized{std::move(run), std::move(text), times};
  }
  Expected<report::JobRun> run = service.Optimize(job, strategy, request.job, request.quiet);
  if (Outcome* outcome = std::get_if<Outcome>(&run)) return *outcome;
  return Optimized{std::get<report::JobRun>(std::move(run)), std::nullopt, std::nullopt};
}

// Draws and describes the results of the job. `rewrite` is null if it is not G-code.
Outcome ShowViews(Service& service, const Request& request, const InputJob& job,
                  const report::JobRun& run, const GcodeRewrite* rewrite) {
  const view::NamedRun named = {run.result.summary.strategy(), &run};
  if (rewrite != nullptr) {
    const absl::StatusOr<view::Scene> scene = view::GcodeScene(job, named.label, run, *rewrite);
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

// Writes the documents that are asked for besides the G-code.
Outcome WriteDocuments(Service& service, const Request& request, const InputJob& job,
                       const Optimized& made) {
  const GcodeRewrite* rewrite = made.rewrite ? &*made.rewrite : nullptr;
  if (!request.json.empty()) {
    const absl::Status status =
        WriteWholeFile(request.json, report::RoutesJson(job, made.run, rewrite));
    if (!status.ok()) return InputFault(status);
  }
  return request.views.any() ? ShowViews(service, request, job, made.run, rewrite) : Done();
}

std::string WarmStartLine(const WarmStart& warm, size_t layers) {
  return absl::StrFormat("began with known routes of %d of %d layers (%d of %d paths in them)\n",
                         warm.layers, layers, warm.known, warm.paths);
}

// The results of one part of the input.
struct DonePart {
  std::string summary;
  NewPart part;
  bool changed = false;
};

// `request` is a copy because this sets the strategy for each job.
Expected<DonePart> OptimizePart(Service& service, Request request, InputFile& input, size_t index,
                                bool written) {
  absl::StatusOr<InputJob> job = ReadJob(input, index, request.rewrite.gcode);
  if (!job.ok()) return InputFault(job.status());
  if (absl::Status status = ApplyJobFlags(request.job, *job); !status.ok()) {
    return UsageFault(status);
  }
  if (absl::Status status = CheckViewLayer(request.views, *job); !status.ok()) {
    return UsageFault(status);
  }
  if (Outcome outcome = service.Resolve(request.job, *job, request.strategy);
      outcome.code != kDone) {
    return outcome;
  }
  std::optional<WarmStart> warm;
  if (request.start_from) warm = StartFrom(*request.start_from, *job);
  const bool rewritten = job->gcode != nullptr && (written || request.views.any());
  Expected<Optimized> optimized = Optimize(service, request, *job, rewritten);
  if (Outcome* outcome = std::get_if<Outcome>(&optimized)) return *outcome;
  Optimized& made = std::get<Optimized>(optimized);
  if (Outcome outcome = WriteDocuments(service, request, *job, made); outcome.code != kDone) {
    return outcome;
  }
  DonePart done;
  if (input.parts.size() > 1) {
    const uint32_t plate = input.container->parts()[input.parts[index]].plate;
    done.summary = absl::StrFormat("plate %d: ", plate);
  }
  if (warm) done.summary += WarmStartLine(*warm, job->layers.size());
  const gcode::Forecast* forecast = made.rewrite ? &made.rewrite->forecast : nullptr;
  done.summary += report::OptimizeSummary(*job, made.run, forecast);
  if (made.rewrite) done.summary += GcodeSummary(*made.rewrite);
  if (!written) return done;
  done.changed = made.rewrite->layers_changed > 0;
  done.part = {std::move(made.rewrite->text), made.times};
  return done;
}

// Optimises all parts of the input, then makes the file from them.
Expected<std::string> OptimizeParts(Service& service, const Request& request, InputFile& input,
                                    const GcodeTarget& target) {
  const bool kept = input.container && target.kind == input.kind();
  std::string summary;
  std::map<size_t, NewPart> parts;
  bool changed = false;
  for (size_t i = 0; i < input.parts.size(); ++i) {
    Expected<DonePart> part = OptimizePart(service, request, input, i, !target.name.empty());
    if (Outcome* outcome = std::get_if<Outcome>(&part)) return *outcome;
    DonePart& done = std::get<DonePart>(part);
    summary += done.summary;
    changed = changed || done.changed;
    // A container that is kept keeps the old text of a part without gain.
    if (done.changed || !kept) parts[input.parts[i]] = std::move(done.part);
  }
  if (target.name.empty()) return summary;
  const absl::Status status = WriteGcode(input, parts, changed, target);
  if (!status.ok()) return InputFault(status);
  return summary;
}

Outcome RunOptimize(const Flags& flags) {
  absl::StatusOr<Request> request = ParseRequest(flags);
  if (!request.ok()) return UsageFault(request.status());
  Expected<Service> opened = Service::Open(flags);
  if (Outcome* outcome = std::get_if<Outcome>(&opened)) return *outcome;

  if (flags.Has("start_from")) {
    if (flags.Text("start_from") == "-" && flags.operands()[0] == "-")
      return UsageFault("only one of INPUT and --start_from can be standard input");
    const absl::StatusOr<std::string> text = ReadWholeFile(flags.Text("start_from"));
    if (!text.ok()) return InputFault(text.status());
    auto earlier = ReadEarlierRoutes(*text, flags.Text("start_from"));
    if (!earlier.ok()) return InputFault(earlier.status());
    request->start_from = *std::move(earlier);
  }
  absl::StatusOr<InputFile> input = OpenInput(flags.operands()[0], request->plates);
  if (!input.ok()) return InputFault(input.status());
  const absl::StatusOr<GcodeTarget> target = TargetOf(flags, *input);
  if (!target.ok()) return UsageFault(target.status());
  const bool one = !request->json.empty() || request->views.any() || request->start_from ||
                   target->kind != input->kind();
  if (absl::Status status = CheckOnePlate(*input); one && !status.ok()) return InputFault(status);

  const Expected<std::string> done =
      OptimizeParts(std::get<Service>(opened), *request, *input, *target);
  if (const Outcome* outcome = std::get_if<Outcome>(&done)) return *outcome;
  if (!request->quiet) {
    // Messages leave standard output to the document or the G-code if one goes there.
    Print(request->json == "-" || target->name == "-" ? stderr : stdout,
          std::get<std::string>(done));
  }
  return Done();
}

Flag RestateTimesFlag() {
  return {.name = "restate_times",
          .value = "",
          .help = "renew print times in M73, headers and metadata",
          .topic = kSlicedTopic};
}

}  // namespace

Command OptimizeCommand() {
  return {
      .name = "optimize",
      .operands = {"INPUT"},
      .summary = "Shortens the travel of a job.",
      .flags = Joined(WithRunFlagTable({
                          {"o", "OUTPUT", "G-code (default: INPUT; with --json none)"},
                          {"quiet", "", "no progress, no summary"},
                          {"strategy", "NAME", "see `traverse strategies`; or NAME:OPTION=VALUE"},
                          {"start_from", "FILE", "begin with the routes of an earlier --json"},
                      }),
                      Joined(ContainerFlagTable(), {MachineFlag(), RestateTimesFlag()})),
      .example = "traverse optimize part.gcode -o shorter.gcode --policy=balanced",
      .run = RunOptimize};
}

}  // namespace traverse::cli
