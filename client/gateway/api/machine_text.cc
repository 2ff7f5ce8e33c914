#include "client/gateway/api/machine_text.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/gateway/http/target.h"

namespace traverse::gateway {

absl::StatusOr<gcode::MachineLimits> ParseMachine(std::string_view text, const std::string& name) {
  if (text.size() > kMostMachineBytes) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s: longer than %d bytes", name, kMostMachineBytes));
  }
  return gcode::ReadMachineLimits(text, name);
}

absl::StatusOr<std::optional<gcode::MachineLimits>> TakeMachine(Upload& upload) {
  const auto part = std::find_if(upload.files.begin(), upload.files.end(),
                                 [](const Upload::File& file) { return file.field == "machine"; });
  if (part == upload.files.end()) return std::nullopt;
  const Upload::File machine = std::move(*part);
  upload.files.erase(part);
  assert(machine.file->size() <= kMostMachineBytes);  // as the upload's limits say
  std::string text(machine.file->size(), '\0');
  const absl::StatusOr<size_t> got = machine.file->ReadAt(0, text.data(), text.size());
  if (!got.ok()) return got.status();
  absl::StatusOr<gcode::MachineLimits> limits =
      ParseMachine(text, CheckFileName(machine.name).ok() ? machine.name : "machine");
  if (!limits.ok()) return limits.status();
  return *std::move(limits);
}

}  // namespace traverse::gateway
