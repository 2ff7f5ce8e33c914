#include "client/gateway/work/layer_memory.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "client/files/decompress.h"

namespace traverse::gateway {
namespace {

constexpr int64_t kLeastForLayers = int64_t{16} << 20;
constexpr size_t kJsonPiece = 64 << 10;

// For each byte of the text, each object in it, each key and each value: measured with layers of
// points, of squares, of empty islands and of pairs. An object of three bytes becomes a message and
// a part of the engine's plan with its neighbours; a value of two bytes a number in four places.
// The longest text or number is in a dozen places while it is read and passed on.
constexpr int64_t kPerByte = 2;
constexpr int64_t kPerObject = 1500;
constexpr int64_t kPerKey = 200;
constexpr int64_t kPerValue = 60;
constexpr int64_t kPerByteOfLongest = 12;

// What a text of JSON is made of.
class JsonCount {
 public:
  void Take(std::string_view piece) {
    bytes_ += static_cast<int64_t>(piece.size());
    for (const char c : piece) Take(c);
  }

  int64_t memory() const {
    return kLeastForLayers + kPerByte * bytes_ + kPerObject * objects_ + kPerKey * keys_ +
           kPerValue * values_ + kPerByteOfLongest * longest_;
  }

 private:
  void Take(char c) {
    const bool ends = !in_text_ && (c == '{' || c == ':' || c == ',' || c == '"');
    run_ = ends ? 0 : run_ + 1;
    longest_ = std::max(longest_, run_);
    if (in_text_) {
      in_text_ = escaped_ || c != '"';
      escaped_ = !escaped_ && c == '\\';
      return;
    }
    objects_ += c == '{' ? 1 : 0;
    keys_ += c == ':' ? 1 : 0;
    values_ += c == ',' ? 1 : 0;
    in_text_ = c == '"';
  }

  int64_t bytes_ = 0;
  int64_t objects_ = 0;
  int64_t keys_ = 0;
  int64_t values_ = 0;
  int64_t run_ = 0;  // since the last of these, or of a text
  int64_t longest_ = 0;
  bool in_text_ = false;
  bool escaped_ = false;
};

}  // namespace

absl::StatusOr<int64_t> MemoryForLayers(const SpoolFile& json, uint64_t max_bytes) {
  JsonCount count;
  char first[16];
  const absl::StatusOr<size_t> known = json.ReadAt(0, first, sizeof(first));
  if (!known.ok()) return known.status();
  const Compression compression = DetectCompression({first, *known});
  if (compression != Compression::kNone) {
    const absl::StatusOr<std::string> packed = json.ReadAll();
    if (!packed.ok()) return packed.status();
    const absl::Status status = DecompressInPieces(
        *packed, compression, max_bytes, [&](std::string_view part) { count.Take(part); });
    if (absl::IsResourceExhausted(status)) return absl::OutOfRangeError(status.message());
    // Whoever reads a damaged text refuses it with a better message.
    return count.memory() +
           static_cast<int64_t>(packed->size() + DecoderBytes(*packed, compression));
  }
  const absl::Status status = json.ForEachPiece(kJsonPiece, [&count](std::string_view piece) {
    count.Take(piece);
    return absl::OkStatus();
  });
  if (!status.ok()) return status;
  return count.memory();
}

}  // namespace traverse::gateway
