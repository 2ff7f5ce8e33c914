#include <cstdio>
#include <limits>

#include "client/cli/command.h"
#include "client/cli/job_flags.h"
#include "client/cli/service.h"
#include "client/cli/terminal.h"
#include "client/formats/read_input.h"
#include "client/gcode/gcode_job.h"
#include "client/report/inspection.h"

namespace traverse::cli {
namespace {

// Layers listed one by one unless --layers asks for more.
constexpr size_t kRows = 20;

Outcome RunInspect(const Flags& flags) {
  absl::StatusOr<JobFlags> job_flags = ParseJobFlags(flags);
  if (!job_flags.ok()) return UsageFault(job_flags.status());
  Expected<Service> opened = Service::Open(flags);
  if (Outcome* outcome = std::get_if<Outcome>(&opened)) return *outcome;

  absl::StatusOr<InputJob> job = ReadInput(flags.operands()[0], ParseGcodeOptions(flags));
  if (!job.ok()) return InputFault(job.status());
  if (absl::Status status = ApplyJobFlags(*job_flags, *job); !status.ok()) {
    return UsageFault(status);
  }
  if (job->gcode != nullptr) AddMeasuredFacts(*job);
  // The travel of the order given comes from the service too, so that there is one way to count it.
  StrategySpec none{"none", {}};
  none.strategy.set_name("none");
  Expected<report::JobRun> ran =
      std::get<Service>(opened).Optimize(*job, &none, *job_flags, /*quiet=*/true);
  if (Outcome* outcome = std::get_if<Outcome>(&ran)) return *outcome;

  const size_t rows = flags.Has("layers") ? std::numeric_limits<size_t>::max() : kRows;
  Print(stdout, report::InspectionText(*job, std::get<report::JobRun>(ran).result, rows));
  return Done();
}

}  // namespace

Command InspectCommand() {
  Command command;
  command.name = "inspect";
  command.operands = {"INPUT"};
  command.summary = "Says what is in a file.";
  command.flags = {
      {"layers", "A-B", "only these, counted from 1, one by one"},
      {"travel_speed", "MM_S", "for the idle time (default: the file's, or 20.32)"},
      PolicyFlag(),
  };
  command.example = "traverse inspect part.damat --layers=1-5";
  command.run = RunInspect;
  return command;
}

}  // namespace traverse::cli
