#include <optional>

#include "absl/strings/str_format.h"
#include "client/cli/command.h"
#include "client/cli/job_flags.h"
#include "client/damat/writer.h"
#include "client/files/write_file.h"
#include "client/formats/api_format.h"
#include "client/formats/detect.h"
#include "client/formats/read_input.h"

namespace traverse::cli {
namespace {

absl::StatusOr<std::string> WriteAs(InputFormat format, const InputJob& job) {
  switch (format) {
    case InputFormat::kDamat:
      return WriteDamat(job);
    case InputFormat::kJson:
      return WriteApiJson(job);
    default:
      return WriteApiProto(job);
  }
}

// The format asked for by --to, or by the name of the output.
std::optional<InputFormat> OutputFormat(const Flags& flags) {
  const std::string name = flags.Has("to") ? "x." + flags.Text("to") : flags.Text("o");
  if (name.ends_with(".gz") || name.ends_with(".xz")) return std::nullopt;
  const std::optional<InputFormat> format = DetectByExtension(name);
  return format == InputFormat::kGcode ? std::nullopt : format;
}

Outcome RunConvert(const Flags& flags) {
  if (!flags.Has("o")) return UsageFault("-o OUTPUT is missing");
  const std::optional<InputFormat> format = OutputFormat(flags);
  if (!format) return UsageFault("-o writes .damat, .json or .pb; see --to for other names");
  absl::StatusOr<JobFlags> job_flags = ParseJobFlags(flags);
  if (!job_flags.ok()) return UsageFault(job_flags.status());

  absl::StatusOr<InputJob> job = ReadInput(flags.operands()[0], ParseGcodeOptions(flags));
  if (!job.ok()) return InputFault(job.status());
  if (absl::Status status = SelectLayers(*job_flags, *job); !status.ok()) return UsageFault(status);
  const absl::StatusOr<std::string> bytes = WriteAs(*format, *job);
  if (!bytes.ok()) {
    return {kInputFault,
            absl::StrFormat("%s: %s", job->name, std::string(bytes.status().message()))};
  }
  const absl::Status status = WriteWholeFile(flags.Text("o"), *bytes);
  return status.ok() ? Done() : InputFault(status);
}

}  // namespace

Command ConvertCommand() {
  Command command;
  command.name = "convert";
  command.operands = {"INPUT"};
  command.summary = "Writes a job in another format.";
  command.flags = {
      {"o", "OUTPUT", "a .damat, .json or .pb file; - is standard output"},
      {"to", "FORMAT", "damat, json or pb (default: by OUTPUT)", {"damat", "json", "pb"}},
      {"layers", "A-B", "only these, counted from 1"},
      PolicyFlag(),
  };
  command.example = "traverse convert part.damat -o part.json --layers=1-5";
  command.run = RunConvert;
  return command;
}

}  // namespace traverse::cli
