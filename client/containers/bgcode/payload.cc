#include "client/containers/bgcode/payload.h"

#include <algorithm>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/containers/bgcode/heatshrink.h"
#include "client/containers/bgcode/meatpack.h"
#include "client/containers/deflate.h"
#include "client/gcode/parallel.h"

namespace traverse::containers {
namespace {

// Blocks decoded or encoded at the same time: they take little memory beside the text.
constexpr size_t kBatch = 64;

constexpr int kDeflateLevel = 6;

HeatshrinkWindow WindowOf(BlockCompression compression) {
  return {compression == BlockCompression::kHeatshrink11 ? 11 : 12, 4};
}

absl::Status AppendBlockText(const Block& block, size_t max_bytes, std::string& out) {
  const auto encoding = static_cast<GcodeEncoding>(block.parameters[0]);
  if (encoding > GcodeEncoding::kMeatPackComments) {
    return absl::InvalidArgumentError(
        absl::StrFormat("encoding %d of G-code is unknown", block.parameters[0]));
  }
  absl::StatusOr<std::string> bytes = DecompressBlock(block);
  if (!bytes.ok()) return bytes.status();
  if (encoding != GcodeEncoding::kNone) return MeatUnpack(*bytes, max_bytes, out);
  out += *bytes;
  return absl::OkStatus();
}

// Cuts the next lines that make a block off `text`.
std::string_view TakeBlockText(std::string_view& text) {
  size_t end = std::min(text.size(), kMaxBlockText);
  if (end < text.size()) {
    const size_t last = text.rfind('\n', end - 1);
    const size_t next = last == std::string_view::npos ? text.find('\n', end) : last;
    end = next == std::string_view::npos ? text.size() : next + 1;
  }
  const std::string_view block = text.substr(0, end);
  text.remove_prefix(end);
  return block;
}

// MeatPack makes some lines longer: then each half becomes a block.
absl::Status AppendBlockOf(std::string_view text, const GcodeForm& form, std::string& out) {
  const bool packs = form.encoding != GcodeEncoding::kNone && CanMeatPack(text);
  std::string packed;
  if (packs) MeatPack(text, packed);
  const size_t middle = text.rfind('\n', text.size() / 2);
  if (packed.size() > kMaxBlockText && middle != std::string_view::npos) {
    const absl::Status status = AppendBlockOf(text.substr(0, middle + 1), form, out);
    return status.ok() ? AppendBlockOf(text.substr(middle + 1), form, out) : status;
  }
  const std::string_view bytes = packs ? std::string_view(packed) : text;
  if (bytes.size() >= UINT32_MAX) return absl::ResourceExhaustedError("a line of 4 GiB");
  const auto size = static_cast<uint32_t>(bytes.size());
  const auto encoding = static_cast<uint16_t>(packs ? form.encoding : GcodeEncoding::kNone);
  const absl::StatusOr<std::string> data = CompressBytes(bytes, form.compression);
  if (!data.ok()) return data.status();
  AppendBlock(BlockKind::kGcode, form.compression, {encoding}, size, *data, form.checksum, out);
  return absl::OkStatus();
}

absl::Status TooLong(const BgcodeBlocks& file, size_t index, size_t bytes, size_t max_bytes) {
  return absl::ResourceExhaustedError(
      absl::StrFormat("%s: the G-code up to here has %d MiB, but only %d are allowed",
                      BlockPlace(file, index), bytes >> 20, max_bytes >> 20));
}

absl::Status CheckBlockSize(const BgcodeBlocks& file, size_t index) {
  const size_t bytes = file.blocks[index].size;
  if (bytes <= kMaxBlockBytes) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      absl::StrFormat("%s: it states %d bytes of G-code, but a block may have %d at most",
                      BlockPlace(file, index), bytes, kMaxBlockBytes));
}

// Makes pieces 0 to n - 1, a batch at a time, and appends them in order.
template <typename Make>
absl::Status AppendInBatches(size_t n, int threads, std::string& out, Make make) {
  for (size_t first = 0; first < n; first += kBatch) {
    const size_t count = std::min(kBatch, n - first);
    std::vector<std::string> pieces(count);
    std::vector<absl::Status> faults(count);
    gcode::ParallelFor(count, threads, [&](size_t i) { faults[i] = make(first + i, pieces[i]); });
    for (size_t i = 0; i < count; ++i) {
      if (!faults[i].ok()) return faults[i];
      out += pieces[i];
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::string> DecompressBlock(const Block& block) {
  switch (block.compression) {
    case BlockCompression::kNone:
      return std::string(block.data);
    case BlockCompression::kDeflate:
      return Inflate(block.data, DeflateForm::kZlib, block.size);
    case BlockCompression::kHeatshrink11:
    case BlockCompression::kHeatshrink12:
      return HeatshrinkDecompress(block.data, WindowOf(block.compression), block.size);
  }
  return absl::InvalidArgumentError(CompressionName(block.compression) + " is unknown");
}

absl::StatusOr<std::string> CompressBytes(std::string_view bytes, BlockCompression compression) {
  switch (compression) {
    case BlockCompression::kNone:
      return std::string(bytes);
    case BlockCompression::kDeflate:
      return Deflate(bytes, DeflateForm::kZlib, kDeflateLevel, 1);
    case BlockCompression::kHeatshrink11:
    case BlockCompression::kHeatshrink12:
      return HeatshrinkCompress(bytes, WindowOf(compression));
  }
  return absl::InvalidArgumentError(CompressionName(compression) + " is unknown");
}

absl::StatusOr<std::string> GcodeText(const BgcodeBlocks& file, size_t max_bytes, int threads) {
  std::vector<size_t> indices;
  size_t announced = 0;
  for (size_t i = 0; i < file.blocks.size(); ++i) {
    if (!file.blocks[i].is_gcode()) continue;
    if (absl::Status status = CheckBlockSize(file, i); !status.ok()) return status;
    indices.push_back(i);
    announced += file.blocks[i].size;
    if (announced > max_bytes) return TooLong(file, i, announced, max_bytes);
  }
  std::string out;
  constexpr size_t kUnpacked = 2;  // MeatPack halves a text
  out.reserve(std::min(max_bytes, kUnpacked * announced));
  const absl::Status status =
      AppendInBatches(indices.size(), threads, out, [&](size_t i, std::string& piece) {
        const Block& block = file.blocks[indices[i]];
        const absl::Status made = AppendBlockText(block, max_bytes, piece);
        if (made.ok()) return made;
        return absl::Status(made.code(), absl::StrFormat("%s: %s", BlockPlace(file, indices[i]),
                                                         std::string(made.message())));
      });
  if (!status.ok()) return status;
  if (out.size() > max_bytes) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("more than %d MiB of G-code", max_bytes >> 20));
  }
  return out;
}

absl::Status VisitGcode(const BgcodeBlocks& file, size_t max_bytes,
                        const std::function<void(std::string_view)>& sink) {
  size_t sum = 0;
  std::string text;
  for (size_t i = 0; i < file.blocks.size(); ++i) {
    if (!file.blocks[i].is_gcode()) continue;
    if (absl::Status status = CheckBlockSize(file, i); !status.ok()) return status;
    text.clear();
    const absl::Status made = AppendBlockText(file.blocks[i], max_bytes, text);
    if (!made.ok()) {
      return absl::Status(
          made.code(), absl::StrFormat("%s: %s", BlockPlace(file, i), std::string(made.message())));
    }
    sum += text.size();
    if (sum > max_bytes) return TooLong(file, i, sum, max_bytes);
    sink(text);
  }
  return absl::OkStatus();
}

absl::Status AppendGcodeBlocks(std::string_view text, const GcodeForm& form, int threads,
                               std::string& out) {
  std::vector<std::string_view> texts;
  while (!text.empty()) texts.push_back(TakeBlockText(text));
  return AppendInBatches(texts.size(), threads, out, [&](size_t i, std::string& piece) {
    return AppendBlockOf(texts[i], form, piece);
  });
}

}  // namespace traverse::containers
