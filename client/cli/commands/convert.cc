#include <optional>

#include "absl/strings/str_format.h"
#include "client/cli/command.h"
#include "client/cli/flags/job_flags.h"
#include "client/cli/gcode_output.h"
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

// The format that --to or the output's name asks for and, for G-code, the container.
struct Output {
  std::optional<InputFormat> format;
  ContainerKind kind = ContainerKind::kText;
};

Output OutputOf(const Flags& flags) {
  const std::string name = flags.Has("to") ? "x." + flags.Text("to") : flags.Text("o");
  if (name.ends_with(".gz") || name.ends_with(".xz")) return {};
  const ContainerKind kind = ContainerByExtension(name).value_or(ContainerKind::kText);
  if (kind == ContainerKind::kGcode3mf || kind == ContainerKind::kUfp) return {};
  const std::optional<InputFormat> format = DetectByExtension(name);
  if (format == InputFormat::kGtsp) return {};
  return {format, kind};
}

// The G-code of `input` unchanged, in another container or in none.
absl::StatusOr<std::string> Repacked(InputFile& input, ContainerKind kind) {
  if (absl::Status status = CheckOnePlate(input); !status.ok()) return status;
  absl::StatusOr<std::string> text = std::move(input.bytes);
  if (input.container) text = input.container->Text(input.parts[0]);
  return text.ok() ? PackText(*text, kind) : text;
}

absl::StatusOr<std::string> Converted(InputFile& input, InputFormat format, const Flags& flags,
                                      const JobFlags& job_flags) {
  if (absl::Status status = CheckOnePlate(input); !status.ok()) return status;
  const absl::StatusOr<GcodeOptions> gcode = ParseGcodeOptions(flags);
  if (!gcode.ok()) return gcode.status();
  absl::StatusOr<InputJob> job = ReadJob(input, 0, *gcode);
  if (!job.ok()) return job.status();
  if (absl::Status status = SelectJobLayers(job_flags, *job); !status.ok()) {
    return absl::OutOfRangeError(status.message());
  }
  absl::StatusOr<std::string> bytes = WriteAs(format, *job);
  if (bytes.ok()) return bytes;
  return absl::Status(bytes.status().code(),
                      absl::StrFormat("%s: %s", job->name, std::string(bytes.status().message())));
}

Outcome RunConvert(const Flags& flags) {
  constexpr const char* kNoFormat = "-o writes .damat, .json or .pb; see --to for other names";
  if (!flags.Has("o")) return UsageFault("-o OUTPUT is missing");
  const Output output = OutputOf(flags);
  if (!output.format) return UsageFault(kNoFormat);
  absl::StatusOr<JobFlags> job_flags = ParseJobFlags(flags);
  if (!job_flags.ok()) return UsageFault(job_flags.status());
  const absl::StatusOr<PlateOptions> plates = ParsePlateOptions(flags);
  if (!plates.ok()) return UsageFault(plates.status());

  absl::StatusOr<InputFile> input = OpenInput(flags.operands()[0], *plates);
  if (!input.ok()) return InputFault(input.status());
  const bool repacked = output.format == InputFormat::kGcode;
  if (repacked && input->format != InputFormat::kGcode) return UsageFault(kNoFormat);
  const absl::StatusOr<std::string> bytes =
      repacked ? Repacked(*input, output.kind)
               : Converted(*input, *output.format, flags, *job_flags);
  if (absl::IsOutOfRange(bytes.status())) return UsageFault(bytes.status());
  if (!bytes.ok()) return InputFault(bytes.status());
  const absl::Status status = WriteWholeFile(flags.Text("o"), *bytes);
  return status.ok() ? Done() : InputFault(status);
}

}  // namespace

Command ConvertCommand() {
  return {.name = "convert",
          .operands = {"INPUT"},
          .summary = "Writes a job in another format.",
          .flags = Joined(
              {
                  {"o", "OUTPUT", ".damat, .json, .pb; from G-code .gcode, .bgcode"},
                  {"to",
                   "FORMAT",
                   "damat, json, pb, gcode or bgcode",
                   {"damat", "json", "pb", "gcode", "bgcode"}},
                  {"layers", "A-B", "only these layers, counted from 1"},
                  PolicyFlag(),
                  AllowFlag(),
              },
              PlateFlagTable()),
          .example = "traverse convert part.damat -o part.json --layers=1-5",
          .run = RunConvert};
}

}  // namespace traverse::cli
