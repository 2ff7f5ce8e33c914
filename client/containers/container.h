// The files in which G-code is exchanged: plain text, and containers with one text or several.
//
//   absl::StatusOr<std::unique_ptr<Container>> container = OpenContainer(bytes, "part.bgcode", {});
//   absl::StatusOr<std::string> text = (*container)->Text(0);
//   absl::StatusOr<std::string> written = (*container)->WithParts({{0, {shorter}}});
//
// Everything else in them (thumbnails, metadata, models) comes out unchanged, byte by byte.

#ifndef TRAVERSE_CLIENT_CONTAINERS_CONTAINER_H_
#define TRAVERSE_CLIENT_CONTAINERS_CONTAINER_H_

#include <cstddef>
#include <cstdint>
#include <functional>
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
  kText,      // plain G-code, in no container
  kBgcode,    // PrusaSlicer's binary G-code
  kGcode3mf,  // Bambu Studio's and OrcaSlicer's plates
  kUfp,       // UltiMaker's format package
};

// "G-code", "binary G-code", ".gcode.3mf", ".ufp".
const char* ContainerName(ContainerKind kind);

// The kind of container, judged by its first bytes. A zip is kGcode3mf until it is opened.
ContainerKind DetectContainer(std::string_view bytes);

// The kind by the extension of `name`; unset if that is neither a container's nor G-code's.
std::optional<ContainerKind> ContainerByExtension(std::string_view name);

// Which comments a container keeps among its G-code, from the fewest to all.
enum class CommentsKept {
  kNone,
  kLines,  // whole lines of comment
  kAll,
};

struct ContainerOptions {
  // Accepts a plate whose MD5 differs from the one stated beside it.
  bool ignore_md5 = false;
  // Of all texts together. A text of more than 64 MiB is also refused if it is more than 256 times
  // as long as its container: no slicer writes that, but archives made to fill memory do.
  size_t max_text_bytes = size_t{4} << 30;
};

// One text of a container.
struct GcodePart {
  std::string name;    // in the container, "Metadata/plate_2.gcode"; empty if it has none
  uint32_t plate = 1;  // from 1
};

// What replaces a text.
struct NewPart {
  std::string text;
  // If the text restates times: how the times in the container's own metadata change.
  std::optional<gcode::TimeScale> times;
};

class Container {
 public:
  virtual ~Container() = default;

  virtual ContainerKind kind() const = 0;

  // At least one, by plate.
  virtual const std::vector<GcodePart>& parts() const = 0;

  // The whole text of parts()[index]. Errors name the container and the position in it.
  virtual absl::StatusOr<std::string> Text(size_t index) const = 0;

  // The length of all texts together, as the container's headers state it.
  virtual size_t StatedBytes() const = 0;

  // Passes all texts on, one after the other, each in pieces that may end anywhere and of which it
  // holds a few megabytes at most: for callers that must know what they will unpack. Errors: as
  // Text().
  using TextSink = std::function<void(size_t index, std::string_view piece)>;
  virtual absl::Status VisitTexts(const TextSink& sink) const = 0;

  // The container with other texts, by index; the others stay. Reading the result gives back these
  // texts, apart from spaces that mean nothing; this is checked.
  virtual absl::StatusOr<std::string> WithParts(const std::map<size_t, NewPart>& parts) const = 0;

  // The comments that the slicer's texts keep in this container.
  virtual CommentsKept comments_kept() const { return CommentsKept::kAll; }

  // What `inspect` prints about the container, in this order.
  virtual std::vector<std::pair<std::string, std::string>> Facts() const = 0;
};

// Opens `bytes` as a container; they are text if they are nothing else. `name` is for messages.
// InvalidArgument `name: ...`, with the block and its offset or the entry, if they are damaged or
// contradict what they state; ResourceExhausted if they hold too much. Decompresses only small
// entries.
absl::StatusOr<std::unique_ptr<Container>> OpenContainer(std::string bytes, const std::string& name,
                                                         const ContainerOptions& options);

// `part` in a new container of kind kText or kBgcode. Comments become metadata and thumbnails of
// binary G-code, as PrusaSlicer writes them.
absl::StatusOr<std::string> PackText(const std::string& text, ContainerKind kind);

// The index of plate `plate`; InvalidArgument `name: ...`, with the existing plates, if it is none
// of them.
absl::StatusOr<size_t> FindPlate(const Container& container, uint32_t plate,
                                 const std::string& name);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_CONTAINERS_CONTAINER_H_
