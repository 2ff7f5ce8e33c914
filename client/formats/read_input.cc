#include "client/formats/read_input.h"

#include <numeric>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/damat/reader.h"
#include "client/files/read_file.h"
#include "client/formats/api_format.h"
#include "client/formats/detect.h"
#include "client/gcode/gcode_job.h"
#include "client/gtsp/reader.h"

namespace traverse {
namespace {

absl::Status Fault(const std::string& name, const std::string& text) {
  return absl::InvalidArgumentError(absl::StrFormat("%s: %s", DisplayName(name), text));
}

absl::StatusOr<InputJob> ReadAs(InputFormat format, std::string bytes, const std::string& name,
                                const GcodeOptions& gcode) {
  switch (format) {
    case InputFormat::kDamat:
      return ReadDamat(bytes, name);
    case InputFormat::kJson:
      return ReadApiJson(bytes, name);
    case InputFormat::kProto:
      return ReadApiProto(bytes, name);
    case InputFormat::kGtsp:
      return ReadGtsp(bytes, name);
    case InputFormat::kGcode:
      break;
  }
  return ReadGcodeJob(std::move(bytes), name, gcode);
}

// A name that promises a container must hold one, unless the content is another known format.
absl::Status CheckPromise(const std::string& name) {
  switch (ContainerByExtension(name).value_or(ContainerKind::kText)) {
    case ContainerKind::kText:
      return absl::OkStatus();
    case ContainerKind::kBgcode:
      return Fault(name, "it does not begin with GCDE, as binary G-code does");
    default:
      return Fault(name, "it does not begin as a zip archive does");
  }
}

absl::StatusOr<InputFormat> FormatOf(const std::string& bytes, const std::string& name) {
  if (bytes.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return Fault(name, "the file is empty");
  }
  const std::optional<InputFormat> by_content = DetectByContent(bytes);
  const std::optional<InputFormat> by_extension = DetectByExtension(name);
  // Binary data show only by their first byte: that is too little against an extension.
  const bool weak = by_content == InputFormat::kProto && by_extension;
  const std::optional<InputFormat> format = weak || !by_content ? by_extension : by_content;
  if (!format) {
    return Fault(name,
                 "neither its content nor its name says DAMAT, G-code, JSON, protobuf or GTSPLIB");
  }
  if (weak || !by_content) {
    if (absl::Status status = CheckPromise(name); !status.ok()) return status;
  }
  return *format;
}

absl::Status OpenParts(const PlateOptions& plates, InputFile& file) {
  absl::StatusOr<std::unique_ptr<Container>> container =
      OpenContainer(std::move(file.bytes), file.name, plates.container);
  if (!container.ok()) return container.status();
  file.container = *std::move(container);
  file.bytes.clear();
  if (plates.plate) {
    const absl::StatusOr<size_t> part = FindPlate(*file.container, *plates.plate, file.name);
    if (!part.ok()) return part.status();
    file.parts = {*part};
    return absl::OkStatus();
  }
  file.parts.resize(file.container->parts().size());
  std::iota(file.parts.begin(), file.parts.end(), size_t{0});
  return absl::OkStatus();
}

absl::StatusOr<InputJob> OnlyJob(absl::StatusOr<InputFile> file, const GcodeOptions& gcode) {
  if (!file.ok()) return file.status();
  if (absl::Status status = CheckOnePlate(*file); !status.ok()) return status;
  return ReadJob(*file, 0, gcode);
}

}  // namespace

absl::StatusOr<InputFile> OpenInputBytes(std::string bytes, const std::string& name,
                                         const PlateOptions& plates) {
  const absl::StatusOr<InputFormat> format = FormatOf(bytes, name);
  if (!format.ok()) return format.status();
  InputFile file;
  file.name = name;
  file.format = *format;
  file.bytes = std::move(bytes);
  if (DetectContainer(file.bytes) != ContainerKind::kText) {
    if (absl::Status status = OpenParts(plates, file); !status.ok()) return status;
  } else if (plates.plate.value_or(1) != 1) {
    return Fault(name, absl::StrFormat("it has no plate %d, only 1", *plates.plate));
  }
  return file;
}

absl::StatusOr<InputFile> OpenInput(const std::string& name, const PlateOptions& plates) {
  absl::StatusOr<std::string> bytes = ReadWholeFile(name);
  if (!bytes.ok()) return bytes.status();
  return OpenInputBytes(*std::move(bytes), name, plates);
}

absl::Status CheckOnePlate(const InputFile& file) {
  if (file.parts.size() == 1) return absl::OkStatus();
  return Fault(file.name,
               absl::StrFormat("it has %d plates: choose one with --plate", file.parts.size()));
}

absl::StatusOr<InputJob> ReadJob(InputFile& file, size_t index, const GcodeOptions& gcode) {
  if (!file.container) return ReadAs(file.format, std::move(file.bytes), file.name, gcode);
  const size_t part = file.parts[index];
  absl::StatusOr<std::string> text = file.container->Text(part);
  if (!text.ok()) return text.status();
  const std::string& entry = file.container->parts()[part].name;
  const std::string named =
      entry.empty() ? file.name : absl::StrFormat("%s: %s", DisplayName(file.name), entry);
  absl::StatusOr<InputJob> job = ReadGcodeJob(*std::move(text), named, gcode);
  if (!job.ok()) return job;
  job->name = file.name;
  // Those of the container once: they grow with its plates.
  if (index > 0) return job;
  std::vector<std::pair<std::string, std::string>> facts = file.container->Facts();
  job->facts.insert(job->facts.begin(), facts.begin(), facts.end());
  return job;
}

absl::StatusOr<InputJob> ParseInput(std::string bytes, const std::string& name,
                                    const GcodeOptions& gcode, const PlateOptions& plates) {
  return OnlyJob(OpenInputBytes(std::move(bytes), name, plates), gcode);
}

absl::StatusOr<InputJob> ReadInput(const std::string& name, const GcodeOptions& gcode,
                                   const PlateOptions& plates) {
  return OnlyJob(OpenInput(name, plates), gcode);
}

}  // namespace traverse
