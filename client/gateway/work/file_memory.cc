#include "client/gateway/work/file_memory.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/containers/container.h"
#include "client/containers/limits.h"
#include "client/files/decompress.h"

namespace traverse::gateway {
namespace {

// Measured: the text, its parts, the job, the orders found, the new text and its verification.
constexpr int64_t kPerByte = 12;
constexpr int64_t kLeast = int64_t{16} << 20;

std::string FirstBytes(const SpoolFile& upload) {
  std::string first(16, '\0');
  first.resize(upload.ReadAt(0, first.data(), first.size()).value_or(0));
  return first;
}

// The G-code in `packed`, in bytes; ResourceExhausted if it is more than `max_bytes`.
absl::StatusOr<size_t> TextBytes(std::string packed, size_t max_bytes) {
  const Compression compression = DetectCompression(packed);
  if (compression == Compression::kNone) {
    ContainerOptions options;
    options.ignore_md5 = true;
    options.max_text_bytes = max_bytes;
    const absl::StatusOr<std::unique_ptr<Container>> container =
        OpenContainer(std::move(packed), "the file", options);
    return container.ok() ? (*container)->TextBytes() : container.status();
  }
  const absl::StatusOr<DecompressedSize> size = MeasureDecompressed(packed, compression, max_bytes);
  if (!size.ok()) return size.status();
  // A container inside is measured by its length only.
  const bool text = DetectContainer(size->first) == ContainerKind::kText;
  return text ? size->bytes : containers::MaxTextBytes(size->bytes, max_bytes);
}

}  // namespace

bool IsPacked(const SpoolFile& upload) {
  const std::string first = FirstBytes(upload);
  return DetectCompression(first) != Compression::kNone ||
         DetectContainer(first) != ContainerKind::kText;
}

int64_t MemoryToMeasure(const SpoolFile& upload) {
  return kLeast + static_cast<int64_t>(upload.size());
}

absl::StatusOr<int64_t> MemoryFor(const SpoolFile& upload, uint64_t max_file_bytes) {
  uint64_t bytes = upload.size();
  if (IsPacked(upload)) {
    absl::StatusOr<std::string> packed = upload.ReadAll();
    if (!packed.ok()) return packed.status();
    const absl::StatusOr<size_t> text = TextBytes(*std::move(packed), max_file_bytes);
    if (absl::IsResourceExhausted(text.status())) {
      return absl::OutOfRangeError(text.status().message());
    }
    // Whoever reads a damaged file refuses it with a better message.
    bytes = std::max<uint64_t>(bytes, text.value_or(0));
  }
  return kLeast + kPerByte * static_cast<int64_t>(bytes);
}

}  // namespace traverse::gateway
