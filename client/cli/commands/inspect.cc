#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/cli/command.h"
#include "client/cli/flags/job_flags.h"
#include "client/cli/gcode_output.h"
#include "client/cli/service.h"
#include "client/cli/terminal.h"
#include "client/formats/read_input.h"
#include "client/gcode/gcode_job.h"
#include "client/report/inspection.h"

namespace traverse::cli {
namespace {

// Number of layers listed one by one unless --layers asks for more.
constexpr size_t kRows = 20;

// Appends the contents of one part of the input.
Outcome InspectPart(Service& service, const Flags& flags, const JobFlags& job_flags,
                    InputFile& input, size_t index, std::string& text) {
  const absl::StatusOr<GcodeOptions> gcode = ParseGcodeOptions(flags);
  if (!gcode.ok()) return UsageFault(gcode.status());
  absl::StatusOr<InputJob> job = ReadJob(input, index, *gcode);
  if (!job.ok()) return InputFault(job.status());
  if (absl::Status status = ApplyJobFlags(job_flags, *job); !status.ok()) {
    return UsageFault(status);
  }
  if (job->gcode != nullptr) {
    if (auto totals = AddMeasuredFacts(*job, *gcode); !totals.ok()) {
      return InputFault(totals.status());
    }
  }
  // The service also computes the travel of the given order, so that only one place computes it.
  StrategySpec none{"none", {}};
  none.strategy.set_name("none");
  Expected<report::JobRun> ran = service.Optimize(*job, &none, job_flags, /*quiet=*/true);
  if (Outcome* outcome = std::get_if<Outcome>(&ran)) return *outcome;

  const size_t rows = flags.Has("layers") ? std::numeric_limits<size_t>::max() : kRows;
  if (input.parts.size() > 1) {
    const GcodePart& part = input.container->parts()[input.parts[index]];
    absl::StrAppendFormat(&text, "%splate %d\n", index == 0 ? "" : "\n", part.plate);
  }
  text += report::InspectionText(*job, std::get<report::JobRun>(ran).result, rows);
  return Done();
}

Outcome RunInspect(const Flags& flags) {
  absl::StatusOr<JobFlags> job_flags = ParseJobFlags(flags);
  if (!job_flags.ok()) return UsageFault(job_flags.status());
  Expected<Service> opened = Service::Open(flags);
  if (Outcome* outcome = std::get_if<Outcome>(&opened)) return *outcome;

  const absl::StatusOr<PlateOptions> plates = ParsePlateOptions(flags);
  if (!plates.ok()) return UsageFault(plates.status());
  absl::StatusOr<InputFile> input = OpenInput(flags.operands()[0], *plates);
  if (!input.ok()) return InputFault(input.status());
  std::string text;
  for (size_t i = 0; i < input->parts.size(); ++i) {
    const Outcome outcome =
        InspectPart(std::get<Service>(opened), flags, *job_flags, *input, i, text);
    if (outcome.code != kDone) return outcome;
  }
  Print(stdout, text);
  return Done();
}

}  // namespace

Command InspectCommand() {
  return {.name = "inspect",
          .operands = {"INPUT"},
          .summary = "Describes a file.",
          .flags = Joined(
              {
                  {"layers", "A-B", "list only these layers, counted from 1"},
                  {"travel_speed", "MM_S", "for the idle time (default: the file's, or 20.32)"},
                  PolicyFlag(),
                  AllowFlag(),
                  MachineFlag(),
              },
              PlateFlagTable()),
          .example = "traverse inspect part.damat --layers=1-5",
          .run = RunInspect};
}

}  // namespace traverse::cli
