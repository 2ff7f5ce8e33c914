#include "client/formats/read_input.h"

#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/damat/reader.h"
#include "client/files/read_file.h"
#include "client/formats/api_format.h"
#include "client/formats/detect.h"

namespace traverse {
namespace {

absl::StatusOr<InputJob> ReadAs(InputFormat format, std::string bytes, const std::string& name,
                                const GcodeOptions& gcode) {
  switch (format) {
    case InputFormat::kDamat:
      return ReadDamat(bytes, name);
    case InputFormat::kJson:
      return ReadApiJson(bytes, name);
    case InputFormat::kProto:
      return ReadApiProto(bytes, name);
    case InputFormat::kGcode:
      break;
  }
  return ReadGcodeJob(std::move(bytes), name, gcode);
}

}  // namespace

absl::StatusOr<InputJob> ParseInput(std::string bytes, const std::string& name,
                                    const GcodeOptions& gcode) {
  if (bytes.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return absl::InvalidArgumentError(absl::StrFormat("%s: the file is empty", DisplayName(name)));
  }
  const std::optional<InputFormat> by_content = DetectByContent(bytes);
  const std::optional<InputFormat> by_extension = DetectByExtension(name);
  // Of binary data only the first byte speaks: against an extension that is not enough.
  const bool weak = by_content == InputFormat::kProto && by_extension;
  const std::optional<InputFormat> format = weak || !by_content ? by_extension : by_content;
  if (!format) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s: neither its content nor its name is DAMAT, G-code, JSON or protobuf",
                        DisplayName(name)));
  }
  return ReadAs(*format, std::move(bytes), name, gcode);
}

absl::StatusOr<InputJob> ReadInput(const std::string& name, const GcodeOptions& gcode) {
  absl::StatusOr<std::string> bytes = ReadWholeFile(name);
  if (!bytes.ok()) return bytes.status();
  return ParseInput(*std::move(bytes), name, gcode);
}

}  // namespace traverse
