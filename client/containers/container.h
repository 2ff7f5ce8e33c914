// Files as G-code is traded in: plain text, and containers that hold one text or several.
//
//   absl::StatusOr<std::unique_ptr<Container>> container = OpenContainer(bytes, "part.bgcode", {});
//   absl::StatusOr<std::string> text = (*container)->Text(0);
//   absl::StatusOr<std::string> written = (*container)->WithParts({{0, {shorter}}});
//
// What is in them besides G-code (thumbnails, metadata, models) comes out byte by byte as it was.

#ifndef TRAVERSE_CLIENT_CONTAINERS_CONTAINER_H_
#define TRAVERSE_CLIENT_CONTAINERS_CONTAINER_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/gcode/stated_times.h"

namespace traverse {

enum class ContainerKind {
  kText,      // G-code itself, in no container
  kBgcode,    // PrusaSlicer's binary G-code
  kGcode3mf,  // Bambu Studio's and OrcaSlicer's plates
  kUfp,       // UltiMaker's format package
};

// "G-code", "binary G-code", ".gcode.3mf", ".ufp".
const char* ContainerName(ContainerKind kind);

// The kind of container that `bytes` begin as. A zip is kGcode3mf until it is opened.
ContainerKind DetectContainer(std::string_view bytes);

// The kind by the extension of `name`: nothing if that is none of a container's or of G-code's.
std::optional<ContainerKind> ContainerByExtension(std::string_view name);

// Which comments a container keeps among its G-code, from the fewest to all.
enum class CommentsKept {
  kNone,
  kLines,  // those that are lines
  kAll,
};

struct ContainerOptions {
  // Takes a plate whose MD5 is not the one stated beside it.
  bool ignore_md5 = false;
  // Of all texts together. Besides, a text that is more than 64 MiB and more than 256 times as long
  // as its container is refused: no slicer writes that, but archives made to fill memory do.
  size_t max_text_bytes = size_t{4} << 30;
};

// One text of a container.
struct GcodePart {
  std::string name;    // in the container, "Metadata/plate_2.gcode"; empty if it has no other
  uint32_t plate = 1;  // from 1
};

// What takes the place of a text.
struct NewPart {
  std::string text;
  // If it restates times: how those in the container's own metadata change.
  std::optional<gcode::TimeScale> times;
};

class Container {
 public:
  virtual ~Container() = default;

  virtual ContainerKind kind() const = 0;

  // At least one, by plate.
  virtual const std::vector<GcodePart>& parts() const = 0;

  // The text of parts()[index], whole. Errors name the container and the place in it.
  virtual absl::StatusOr<std::string> Text(size_t index) const = 0;

  // How long all texts are together, at least as long as Text() lets them be, for who has to know
  // before they are unpacked. ResourceExhausted as of Text().
  virtual absl::StatusOr<size_t> TextBytes() const = 0;

  // The container with other texts, by index; those not named stay. Reading what comes back gives
  // these texts, up to spaces that mean nothing; that is checked.
  virtual absl::StatusOr<std::string> WithParts(const std::map<size_t, NewPart>& parts) const = 0;

  // The comments that the slicer's texts keep in this container.
  virtual CommentsKept comments_kept() const { return CommentsKept::kAll; }

  // What `inspect` says of the container, in this order.
  virtual std::vector<std::pair<std::string, std::string>> Facts() const = 0;
};

// The container that `bytes` are; they are text if they are nothing else. `name` is for messages.
// InvalidArgument `name: ...`, with the block and its offset or the entry, if they are damaged or
// not what they say they are; ResourceExhausted if they hold too much. Nothing is decompressed
// here but small entries.
absl::StatusOr<std::unique_ptr<Container>> OpenContainer(std::string bytes, const std::string& name,
                                                         const ContainerOptions& options);

// `part` in a container of its own of another kind: kText or kBgcode. What is said in comments
// becomes metadata and thumbnails of binary G-code, as PrusaSlicer writes them.
absl::StatusOr<std::string> PackText(const std::string& text, ContainerKind kind);

// The index of plate `plate`; InvalidArgument `name: ...` with the plates that there are if it is
// none of them.
absl::StatusOr<size_t> FindPlate(const Container& container, uint32_t plate,
                                 const std::string& name);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_CONTAINERS_CONTAINER_H_
