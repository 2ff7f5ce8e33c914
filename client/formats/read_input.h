// From a file to a job, whatever the format.

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
#include "client/gcode/gcode_options.h"
#include "client/input/input_format.h"

namespace traverse {

struct InputJob;  // client/input/input_job.h

// Which texts of a container to read, and how to open it.
struct PlateOptions {
  std::optional<uint32_t> plate;  // unset: all of them
  ContainerOptions container;
};

// A file of known format, with one job, or several if it is a container.
struct InputFile {
  std::string name;
  InputFormat format = InputFormat::kDamat;

  // Null for files without a container, whose content is in `bytes`.
  std::shared_ptr<const Container> container;
  std::vector<size_t> parts = {0};  // selected texts of the container
  std::string bytes;

  ContainerKind kind() const { return container ? container->kind() : ContainerKind::kText; }
};

// Reads the file `name` ("-": standard input), decompresses it if it is gzip or xz, and recognises
// its format by content, then by extension. Errors are one line that begins with the name.
absl::StatusOr<InputFile> OpenInput(const std::string& name, const PlateOptions& plates = {});

// The same from the file's bytes.
absl::StatusOr<InputFile> OpenInputBytes(std::string bytes, const std::string& name,
                                         const PlateOptions& plates = {});

// InvalidArgument if more than one part of `file` is selected.
absl::Status CheckOnePlate(const InputFile& file);

// The job in file.parts[index]. The bytes of a file without a container move into it, so its job
// can be read only once. Errors are one line that begins with the name and, for archives, the
// entry, with the line number if the format has lines. `gcode` says how to read G-code.
absl::StatusOr<InputJob> ReadJob(InputFile& file, size_t index, const GcodeOptions& gcode = {});

// OpenInput, and its only job; an error if there are several.
absl::StatusOr<InputJob> ReadInput(const std::string& name, const GcodeOptions& gcode = {},
                                   const PlateOptions& plates = {});

// The same from the file's bytes.
absl::StatusOr<InputJob> ParseInput(std::string bytes, const std::string& name,
                                    const GcodeOptions& gcode = {},
                                    const PlateOptions& plates = {});

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FORMATS_READ_INPUT_H_
