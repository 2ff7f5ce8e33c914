// Zip archives with G-code: .gcode.3mf and .ufp.

#ifndef TRAVERSE_CLIENT_CONTAINERS_ZIP_GCODE_ZIP_H_
#define TRAVERSE_CLIENT_CONTAINERS_ZIP_GCODE_ZIP_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/containers/container.h"

namespace traverse::containers {

// See OpenContainer. The texts of a .gcode.3mf are Metadata/plate_N.gcode; that of a .ufp is
// /3D/model.gcode (with or without the slash).
absl::StatusOr<std::unique_ptr<Container>> OpenGcodeZip(std::string bytes, const std::string& name,
                                                        const ContainerOptions& options);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_ZIP_GCODE_ZIP_H_
