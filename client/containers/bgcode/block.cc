#include "client/containers/bgcode/block.h"

#include <cassert>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/containers/bytes.h"
#include "client/containers/deflate.h"

namespace traverse::containers {
namespace {

constexpr size_t kFileHeaderBytes = 10;
constexpr size_t kShortHeaderBytes = 8;
constexpr size_t kLongHeaderBytes = 12;
constexpr size_t kChecksumBytes = 4;

// Far more than slicers write: 16 GiB of text in blocks of 64 KiB. A block takes 64 bytes of memory
// here but only 8 bytes of a file made to attack.
constexpr size_t kMaxBlocks = size_t{1} << 18;

bool IsKnown(BlockKind kind) { return kind <= BlockKind::kThumbnail; }

size_t ParameterBytes(BlockKind kind) { return kind == BlockKind::kThumbnail ? 6 : 2; }

// Parses one block after the other.
class Parser {
 public:
  Parser(std::string_view file, BgcodeBlocks& out) : file_(file), out_(out) {}

  absl::Status Run() {
    for (next_ = kFileHeaderBytes; next_ < file_.size();) {
      if (absl::Status status = ParseBlock(); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

 private:
  std::string Place() const {
    return absl::StrFormat("block %d at offset %d", out_.blocks.size() + 1, next_);
  }

  size_t ChecksumBytes() const {
    return out_.checksum == BgcodeChecksum::kCrc32 ? kChecksumBytes : 0;
  }

  absl::Status ParseBlock() {
    const size_t left = file_.size() - next_;
    if (out_.blocks.size() == kMaxBlocks) {
      return absl::InvalidArgumentError(
          absl::StrFormat("%s: more blocks than %d", Place(), kMaxBlocks));
    }
    if (left < kShortHeaderBytes)
      return absl::InvalidArgumentError(Place() + ": the file ends in its header");
    Block block;
    block.offset = next_;
    block.kind = static_cast<BlockKind>(LoadU16(file_, next_));
    block.compression = static_cast<BlockCompression>(LoadU16(file_, next_ + 2));
    block.size = LoadU32(file_, next_ + 4);
    uint32_t stored = block.size;
    size_t header = kShortHeaderBytes;
    if (block.compression != BlockCompression::kNone) {
      header = kLongHeaderBytes;
      if (left < header)
        return absl::InvalidArgumentError(Place() + ": the file ends in its header");
      stored = LoadU32(file_, next_ + 8);
    }
    const size_t parameters = FindParameterBytes(block, header, stored);
    const size_t whole = header + parameters + stored + ChecksumBytes();
    if (whole > left) {
      return absl::InvalidArgumentError(
          absl::StrFormat("%s states %d bytes of %s, but the file has only %d more", Place(),
                          stored, BlockName(block.kind), left - header));
    }
    block.whole = file_.substr(next_, whole);
    block.data = block.whole.substr(header + parameters, stored);
    for (size_t i = 0; i < block.parameters.size() && 2 * i + 2 <= parameters; ++i) {
      block.parameters[i] = LoadU16(block.whole, header + 2 * i);
    }
    if (absl::Status status = CheckChecksum(block); !status.ok()) return status;
    out_.blocks.push_back(block);
    next_ += whole;
    return absl::OkStatus();
  }

  // Nothing states the length of the parameters of future kinds of block: the checksum tells it.
  size_t FindParameterBytes(const Block& block, size_t header, uint32_t stored) const {
    const size_t usual = ParameterBytes(block.kind);
    if (IsKnown(block.kind) || ChecksumBytes() == 0) return usual;
    constexpr size_t kMost = 16;
    for (size_t bytes = 0; bytes <= kMost; bytes += 2) {
      const size_t whole = header + bytes + stored + kChecksumBytes;
      if (whole > file_.size() - next_) break;
      if (HasRightChecksum(file_.substr(next_, whole))) return bytes;
    }
    return usual;
  }

  static bool HasRightChecksum(std::string_view whole) {
    const size_t end = whole.size() - kChecksumBytes;
    return Crc32(whole.substr(0, end)) == LoadU32(whole, end);
  }

  absl::Status CheckChecksum(const Block& block) const {
    if (ChecksumBytes() == 0 || HasRightChecksum(block.whole)) return absl::OkStatus();
    const size_t end = block.whole.size() - kChecksumBytes;
    return absl::InvalidArgumentError(absl::StrFormat(
        "%s (%s): its CRC32 should be %08x, but is %08x", Place(), BlockName(block.kind),
        LoadU32(block.whole, end), Crc32(block.whole.substr(0, end))));
  }

  std::string_view file_;
  BgcodeBlocks& out_;
  size_t next_ = 0;
};

}  // namespace

std::string BlockName(BlockKind kind) {
  switch (kind) {
    case BlockKind::kFileMetadata:
      return "file metadata";
    case BlockKind::kGcode:
      return "G-code";
    case BlockKind::kSlicerMetadata:
      return "slicer metadata";
    case BlockKind::kPrinterMetadata:
      return "printer metadata";
    case BlockKind::kPrintMetadata:
      return "print metadata";
    case BlockKind::kThumbnail:
      return "thumbnail";
  }
  return absl::StrFormat("kind %d", static_cast<int>(kind));
}

std::string CompressionName(BlockCompression compression) {
  switch (compression) {
    case BlockCompression::kNone:
      return "not compressed";
    case BlockCompression::kDeflate:
      return "deflate";
    case BlockCompression::kHeatshrink11:
      return "heatshrink 11/4";
    case BlockCompression::kHeatshrink12:
      return "heatshrink 12/4";
  }
  return absl::StrFormat("compression %d", static_cast<int>(compression));
}

std::string BlockPlace(const BgcodeBlocks& file, size_t index) {
  return absl::StrFormat("block %d at offset %d", index + 1, file.blocks[index].offset);
}

absl::StatusOr<BgcodeBlocks> ParseBlocks(std::string_view file) {
  if (file.size() < kFileHeaderBytes || !file.starts_with(kBgcodeMagic)) {
    return absl::InvalidArgumentError("the header of binary G-code is cut short");
  }
  const uint32_t version = LoadU32(file, 4);
  if (version != kBgcodeVersion) {
    return absl::InvalidArgumentError(
        absl::StrFormat("binary G-code version %d is unknown; only version 1 is", version));
  }
  const uint16_t checksum = LoadU16(file, 8);
  if (checksum > static_cast<uint16_t>(BgcodeChecksum::kCrc32)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "checksum type %d is unknown; only 0 (none) and 1 (CRC32) are known", checksum));
  }
  BgcodeBlocks out;
  out.checksum = static_cast<BgcodeChecksum>(checksum);
  if (absl::Status status = Parser(file, out).Run(); !status.ok()) return status;
  return out;
}

std::string BgcodeHeader(BgcodeChecksum checksum) {
  std::string out(kBgcodeMagic);
  AppendU32(out, kBgcodeVersion);
  AppendU16(out, static_cast<uint16_t>(checksum));
  return out;
}

void AppendBlock(BlockKind kind, BlockCompression compression,
                 const std::vector<uint16_t>& parameters, uint32_t size, std::string_view data,
                 BgcodeChecksum checksum, std::string& out) {
  assert(!IsKnown(kind) || 2 * parameters.size() == ParameterBytes(kind));
  assert(compression != BlockCompression::kNone || size == data.size());
  const size_t begin = out.size();
  AppendU16(out, static_cast<uint16_t>(kind));
  AppendU16(out, static_cast<uint16_t>(compression));
  AppendU32(out, size);
  if (compression != BlockCompression::kNone) AppendU32(out, static_cast<uint32_t>(data.size()));
  for (const uint16_t parameter : parameters) AppendU16(out, parameter);
  out.append(data);
  if (checksum == BgcodeChecksum::kCrc32) {
    AppendU32(out, Crc32(std::string_view(out).substr(begin)));
  }
}

}  // namespace traverse::containers
