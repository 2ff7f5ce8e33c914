#include "client/gateway/work/file_memory.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/containers/container.h"
#include "client/containers/limits.h"
#include "client/files/decompress.h"
#include "client/gateway/work/layer_memory.h"
#include "client/gateway/work/text_count.h"
#include "client/gcode/parallel.h"

namespace traverse::gateway {
namespace {

constexpr int64_t kLeast = int64_t{16} << 20;
constexpr uint64_t kShort = 256 << 10;
constexpr size_t kPiece = 64 << 10;

// Bytes for each byte of the text, and for what it is made of; the last ones of the layers, or the
// links, that are under way at a time: measured (weigh.py). Rewriting holds the text twice, the
// plans of all layers, the search's own copy of them, and the grids of some layers; verifying holds
// both files as far as they are compared.
struct Prices {
  double byte;
  double segment;
  double path;
  double move;
  double setting;
  double fence;
  double layer;
  double move_under_way;
  double cell_under_way;
  double path_under_way;
  double path_in_search;  // of kMostInSearch at most in a layer: larger ones are searched less
};
constexpr int64_t kMostInSearch = 8000;

constexpr Prices PricesOf(FileUse use) {
  switch (use) {
    case FileUse::kRewrite:
      return {.byte = 4,
              .segment = 230,
              .path = 1700,
              .move = 140,
              .setting = 2000,
              .fence = 720,
              .layer = 34'000,
              .move_under_way = 850,
              .cell_under_way = 112,
              .path_under_way = 3000,
              .path_in_search = 5000};
    case FileUse::kInspect:
      return {.byte = 1.1,
              .segment = 140,
              .path = 440,
              .move = 85,
              .setting = 40,
              .fence = 40,
              .layer = 500,
              .move_under_way = 0,
              .cell_under_way = 92,
              .path_under_way = 200,
              .path_in_search = 0};
    case FileUse::kOptimize:  // counted by MemoryForLayers
      break;
    case FileUse::kVerify:
      return {.byte = 4.6,
              .segment = 175,
              .path = 0,
              .move = 600,
              .setting = 10,
              .fence = 360,
              .layer = 0,
              .move_under_way = 0,
              .cell_under_way = 45,
              .path_under_way = 250,
              .path_in_search = 0};
  }
  return {};
}

// What is kept of the places where something stands, in maps of all that lines lead across.
double BytesForFarLines(const TextCount& count, FileUse use) {
  constexpr double kOfMm = 64;
  constexpr double kMost = 100 << 20;
  if (use == FileUse::kInspect) return 0;
  const double bytes = kOfMm * count.far_mm();
  return bytes < kMost ? bytes : kMost;
}

// Of the travel moves that a layer under way was asked about, and of those that all layers
// remember.
double BytesForKnownTravels(const TextCount& count, FileUse use, int64_t layers) {
  constexpr double kOfPath = 10'000;
  constexpr double kMost = 32 << 20;
  if (use != FileUse::kRewrite) return 0;
  const auto known = [kMost](int64_t paths) {
    return std::min(kOfPath * static_cast<double>(paths), kMost);
  };
  return known(count.paths()) + static_cast<double>(layers) * known(count.most_paths());
}

double BytesFor(const TextCount& count, FileUse use) {
  const Prices prices = PricesOf(use);
  const int64_t layers = gcode::DefaultThreads();
  const auto of = [](double price, int64_t number) { return price * static_cast<double>(number); };
  return of(prices.byte, count.bytes()) + of(prices.segment, count.segments()) +
         of(prices.path, count.paths()) + of(prices.move, count.moves()) +
         of(prices.setting, count.settings()) + of(prices.fence, count.fences()) +
         of(prices.layer, count.layers()) +
         of(prices.move_under_way, std::min(count.moves(), layers * count.most_moves())) +
         of(prices.cell_under_way, std::min(count.cells(), layers * count.most_cells())) +
         of(prices.path_under_way, std::min(count.paths(), layers * count.most_paths())) +
         of(prices.path_in_search,
            std::min(count.paths(), layers * std::min(count.most_paths(), kMostInSearch))) +
         BytesForFarLines(count, use) + BytesForKnownTravels(count, use, layers);
}

std::string FirstBytes(const SpoolFile& upload, size_t most = 16) {
  std::string first(most, '\0');
  first.resize(upload.ReadAt(0, first.data(), first.size()).value_or(0));
  return first;
}

bool IsPacked(const SpoolFile& upload) {
  const std::string first = FirstBytes(upload);
  return DetectCompression(first) != Compression::kNone ||
         DetectContainer(first) != ContainerKind::kText;
}

// Reads a plain text piece by piece.
absl::StatusOr<TextCount> CountOf(const SpoolFile& upload) {
  TextCount count;
  const absl::Status status = upload.ForEachPiece(kPiece, [&count](std::string_view piece) {
    count.Take(piece);
    return absl::OkStatus();
  });
  if (!status.ok()) return status;
  count.Finish();
  return count;
}

// What the texts of a container need: they are worked on one after the other, but their texts, old
// and new, are kept.
absl::StatusOr<double> BytesForContainer(std::string packed, FileUse use, size_t max_bytes) {
  ContainerOptions options;
  options.ignore_md5 = true;
  options.max_text_bytes = max_bytes;
  const size_t size = packed.size();
  const absl::StatusOr<std::unique_ptr<Container>> container =
      OpenContainer(std::move(packed), "the file", options);
  if (!container.ok()) return container.status();
  std::vector<TextCount> counts((*container)->parts().size());
  const absl::Status status =
      (*container)->VisitTexts([&counts](size_t index, std::string_view piece) {
        counts[index].Take(piece);
      });
  if (absl::IsResourceExhausted(status)) return status;
  double texts = 0;
  double largest = 0;
  for (TextCount& count : counts) {
    count.Finish();
    texts += static_cast<double>(count.bytes());
    largest = std::max(largest, BytesFor(count, use));
  }
  if (!status.ok()) texts = std::max(texts, static_cast<double>((*container)->StatedBytes()));
  return 2 * static_cast<double>(size) + texts + largest;
}

absl::StatusOr<double> BytesForPacked(std::string packed, FileUse use, size_t max_bytes) {
  const Compression compression = DetectCompression(packed);
  if (compression == Compression::kNone) {
    return BytesForContainer(std::move(packed), use, max_bytes);
  }
  TextCount count;
  std::string first;
  const absl::Status status =
      DecompressInPieces(packed, compression, max_bytes, [&](std::string_view piece) {
        if (first.empty()) first = std::string(piece.substr(0, 16));
        count.Take(piece);
      });
  if (absl::IsResourceExhausted(status)) return status;
  count.Finish();
  const auto decoder = static_cast<double>(DecoderBytes(packed, compression) + packed.size());
  if (DetectContainer(first) == ContainerKind::kText) return decoder + BytesFor(count, use);
  // A container inside is counted by its length, as if it held as much as it may.
  const auto texts = containers::MaxTextBytes(static_cast<size_t>(count.bytes()), max_bytes);
  return decoder + PricesOf(use).byte * 4 * static_cast<double>(texts);
}

}  // namespace

bool IsMeasuredAtOnce(const SpoolFile& upload) {
  return upload.size() <= kShort && !IsPacked(upload);
}

int64_t MemoryToMeasure(const SpoolFile& upload) {
  if (!IsPacked(upload)) return kLeast;
  // With the header of the first block of xz, which states the dictionary.
  const std::string first = FirstBytes(upload, 2048);
  return kLeast + 2 * static_cast<int64_t>(upload.size()) +
         static_cast<int64_t>(DecoderBytes(first, DetectCompression(first)));
}

absl::StatusOr<int64_t> MemoryFor(const SpoolFile& upload, FileUse use, uint64_t max_file_bytes) {
  if (use == FileUse::kOptimize) return MemoryForLayers(upload, max_file_bytes);
  if (!IsPacked(upload)) {
    const absl::StatusOr<TextCount> count = CountOf(upload);
    if (!count.ok()) return count.status();
    return kLeast + static_cast<int64_t>(BytesFor(*count, use));
  }
  absl::StatusOr<std::string> packed = upload.ReadAll();
  if (!packed.ok()) return packed.status();
  const absl::StatusOr<double> bytes = BytesForPacked(*std::move(packed), use, max_file_bytes);
  if (absl::IsResourceExhausted(bytes.status())) {
    return absl::OutOfRangeError(bytes.status().message());
  }
  // Whoever reads a damaged file refuses it with a better message.
  return kLeast + static_cast<int64_t>(bytes.value_or(2 * static_cast<double>(upload.size())));
}

}  // namespace traverse::gateway
