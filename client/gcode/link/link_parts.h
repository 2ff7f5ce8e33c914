// The links of a file and its paths as placed, each read once for many links that are composed of
// them.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LINK_PARTS_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LINK_PARTS_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/link/link.h"
#include "client/gcode/link/path_ends.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/placed_path.h"

namespace traverse::gcode {

// Keeps up to some 8 MB of what it was asked for last. Not thread-safe.
class LinkParts {
 public:
  // `file` outlives the parts.
  explicit LinkParts(const GcodeFile& file) : file_(file) {}

  const GcodeFile& file() const { return file_; }

  // ReadLink of the file.
  std::shared_ptr<const Link> LinkTo(uint32_t block);

  // The same as a model for other links, which take neither its bends nor its comments: of these it
  // has none, however many there are in the file.
  std::shared_ptr<const Link> ModelOf(uint32_t block);

  std::shared_ptr<const PlacedPath> PathOf(const Placement& placement);
  std::shared_ptr<const PathEnds> EndsOf(const Placement& placement);

 private:
  // Segments of paths and steps of links, of some 150 bytes each.
  static constexpr size_t kMostKept = 50'000;

  using Key = std::pair<uint32_t, uint32_t>;

  void MakeRoom(size_t more);

  const GcodeFile& file_;
  absl::flat_hash_map<uint32_t, std::shared_ptr<const Link>> links_;
  absl::flat_hash_map<uint32_t, std::shared_ptr<const Link>> models_;
  absl::flat_hash_map<Key, std::shared_ptr<const PlacedPath>> paths_;
  absl::flat_hash_map<Key, std::shared_ptr<const PathEnds>> ends_;
  size_t kept_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LINK_PARTS_H_
