#include <cstdio>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/cli/command.h"
#include "client/cli/job_flags.h"
#include "client/cli/service.h"
#include "client/cli/strategy_spec.h"
#include "client/cli/terminal.h"
#include "client/files/write_file.h"
#include "client/formats/detect.h"
#include "client/formats/read_input.h"
#include "client/report/json.h"
#include "client/report/summary.h"

namespace traverse::cli {
namespace {

// What the command line asks for; checked before the file is read.
struct Request {
  JobFlags job;
  std::vector<StrategySpec> strategy;  // one or, for the service's default, none
  std::string json;                    // empty: none
  bool quiet = false;
};

absl::StatusOr<Request> ParseRequest(const Flags& flags) {
  Request request;
  auto job = ParseJobFlags(flags);
  if (!job.ok()) return job.status();
  request.job = *std::move(job);
  if (flags.Has("strategy")) {
    auto specs = ParseStrategySpecs(flags.Text("strategy"));
    if (!specs.ok()) return specs.status();
    if (specs->size() > 1) return absl::InvalidArgumentError("--strategy takes one strategy");
    request.strategy = *std::move(specs);
  }
  request.json = flags.Text("json");
  request.quiet = flags.Switch("quiet");
  return request;
}

// What this format cannot have; before any work.
absl::Status CheckOutputs(const Flags& flags, const InputJob& job) {
  if (job.format == InputFormat::kGcode && (flags.Has("o") || !flags.Has("json"))) {
    return absl::InvalidArgumentError("G-code is not written by this version: use --json=FILE");
  }
  if (flags.Has("o")) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "-o is for G-code; the routes of %s go to --json=FILE", FormatName(job.format)));
  }
  return absl::OkStatus();
}

Outcome RunOptimize(const Flags& flags) {
  absl::StatusOr<Request> request = ParseRequest(flags);
  if (!request.ok()) return UsageFault(request.status());
  Expected<Service> opened = Service::Open(flags);
  if (Outcome* outcome = std::get_if<Outcome>(&opened)) return *outcome;
  Service& service = std::get<Service>(opened);

  absl::StatusOr<InputJob> job = ReadInput(flags.operands()[0], ParseGcodeOptions(flags));
  if (!job.ok()) return InputFault(job.status());
  if (absl::Status status = CheckOutputs(flags, *job); !status.ok()) return UsageFault(status);
  if (absl::Status status = ApplyJobFlags(request->job, *job); !status.ok()) {
    return UsageFault(status);
  }
  if (Outcome outcome = service.Resolve(request->job, *job, request->strategy);
      outcome.code != kDone) {
    return outcome;
  }
  const StrategySpec* strategy = request->strategy.empty() ? nullptr : &request->strategy[0];
  Expected<report::JobRun> ran = service.Optimize(*job, strategy, request->job, request->quiet);
  if (Outcome* outcome = std::get_if<Outcome>(&ran)) return *outcome;
  const report::JobRun& run = std::get<report::JobRun>(ran);

  if (!request->json.empty()) {
    const absl::Status status = WriteWholeFile(request->json, report::RoutesJson(*job, run));
    if (!status.ok()) return InputFault(status);
  }
  if (!request->quiet) {
    // Standard output is the document's where it was asked for there.
    Print(request->json == "-" ? stderr : stdout, report::OptimizeSummary(*job, run));
  }
  return Done();
}

}  // namespace

Command OptimizeCommand() {
  Command command;
  command.name = "optimize";
  command.operands = {"INPUT"};
  command.summary = "Shortens the travel of a job.";
  command.flags = {
      {"o", "OUTPUT", "the G-code to write (default: INPUT itself)"},
      {"strategy", "NAME[:OPTION=VALUE]",
       "see `traverse strategies` (default: the service's best)"},
      {"json", "FILE", "writes the routes; - is standard output"},
      {"quiet", "", "no progress, no summary"},
  };
  for (auto table : {JobFlagTable(), ServiceFlagTable()}) {
    command.flags.insert(command.flags.end(), table.begin(), table.end());
  }
  command.examples = {"traverse optimize part.damat --layers=1-5 --json=routes.json"};
  command.run = RunOptimize;
  return command;
}

}  // namespace traverse::cli
