// Binary G-code as a container of one text.

#ifndef TRAVERSE_CLIENT_CONTAINERS_BGCODE_BGCODE_CONTAINER_H_
#define TRAVERSE_CLIENT_CONTAINERS_BGCODE_BGCODE_CONTAINER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/containers/container.h"

namespace traverse::containers {

// See OpenContainer. Checks all checksums and reads the metadata.
absl::StatusOr<std::unique_ptr<Container>> OpenBgcode(std::string bytes, const std::string& name,
                                                      const ContainerOptions& options);

// `text` as binary G-code: CRC32, deflated metadata, G-code in heatshrink 12/4 and MeatPack with
// comments, as PrusaSlicer writes it. Comments of head and foot with a known meaning become
// metadata and thumbnails; the others stay in the G-code.
absl::StatusOr<std::string> MakeBgcode(const std::string& text);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_BGCODE_BGCODE_CONTAINER_H_
