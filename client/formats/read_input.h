// From a file to a job, whatever its format.

#ifndef TRAVERSE_CLIENT_FORMATS_READ_INPUT_H_
#define TRAVERSE_CLIENT_FORMATS_READ_INPUT_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/containers/container.h"
#include "client/gcode/gcode_job.h"
#include "client/input/input_job.h"

namespace traverse {

// Which texts of a container are meant, and how it is opened.
struct PlateOptions {
  std::optional<uint32_t> plate;  // unset: all of them
  ContainerOptions container;
};

// A file whose format is recognised, with one job or, where it is a container, several.
struct InputFile {
  std::string name;
  InputFormat format = InputFormat::kDamat;

  // Null for files in no container, whose content is in `bytes`.
  std::shared_ptr<const Container> container;
  std::vector<size_t> parts = {0};  // those of the container that are meant
  std::string bytes;

  ContainerKind kind() const { return container ? container->kind() : ContainerKind::kText; }
};

// Reads the file `name` ("-": standard input), decompresses it if it is gzip or xz, and recognises
// its format by content, then by extension. Errors are one line that begins with the name.
absl::StatusOr<InputFile> OpenInput(const std::string& name, const PlateOptions& plates = {});

// The same from the file's bytes.
absl::StatusOr<InputFile> OpenInputBytes(std::string bytes, const std::string& name,
                                         const PlateOptions& plates = {});

// InvalidArgument if more than one part of `file` is meant.
absl::Status CheckOnePlate(const InputFile& file);

// The job in file.parts[index]; bytes of a file in no container go into it, so that its job is read
// once. Errors are one line that begins with the name and, in archives, the entry, with the line
// number where the format has lines. `gcode` says what G-code is read for.
absl::StatusOr<InputJob> ReadJob(InputFile& file, size_t index, const GcodeOptions& gcode = {});

// OpenInput, and its only job: an error if it has several.
absl::StatusOr<InputJob> ReadInput(const std::string& name, const GcodeOptions& gcode = {},
                                   const PlateOptions& plates = {});

// The same from the file's bytes.
absl::StatusOr<InputJob> ParseInput(std::string bytes, const std::string& name,
                                    const GcodeOptions& gcode = {},
                                    const PlateOptions& plates = {});

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FORMATS_READ_INPUT_H_
