// The blocks of a binary G-code file (.bgcode, version 1).
//
//   file   "GCDE", u32 version 1, u16 checksum (0 none, 1 CRC32), blocks up to the end
//   block  u16 kind, u16 compression, u32 size, u32 compressed size (only with compression),
//          parameters, data, CRC32 of all that (only with checksums)
//
// Parameters: a thumbnail's u16 format, width and height; of all other known kinds u16 encoding.
// Numbers are little-endian.

#ifndef TRAVERSE_CLIENT_CONTAINERS_BGCODE_BLOCK_H_
#define TRAVERSE_CLIENT_CONTAINERS_BGCODE_BLOCK_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace traverse::containers {

inline constexpr std::string_view kBgcodeMagic = "GCDE";
inline constexpr uint32_t kBgcodeVersion = 1;

enum class BlockKind : uint16_t {
  kFileMetadata = 0,
  kGcode = 1,
  kSlicerMetadata = 2,
  kPrinterMetadata = 3,
  kPrintMetadata = 4,
  kThumbnail = 5,
};

enum class BlockCompression : uint16_t {
  kNone = 0,
  kDeflate = 1,       // with zlib's header and checksum
  kHeatshrink11 = 2,  // window of 11 bits, lookahead of 4
  kHeatshrink12 = 3,
};

enum class BgcodeChecksum : uint16_t { kNone = 0, kCrc32 = 1 };

enum class GcodeEncoding : uint16_t { kNone = 0, kMeatPack = 1, kMeatPackComments = 2 };

// One block; `whole` and `data` point into the parsed file.
struct Block {
  BlockKind kind = BlockKind::kGcode;  // may be none of the names
  BlockCompression compression = BlockCompression::kNone;
  uint32_t size = 0;                     // of the decompressed data
  std::array<uint16_t, 3> parameters{};  // a thumbnail has three, the known others one
  size_t offset = 0;                     // in the file
  std::string_view whole;                // header to checksum
  std::string_view data;

  bool is_gcode() const { return kind == BlockKind::kGcode; }
};

struct BgcodeBlocks {
  BgcodeChecksum checksum = BgcodeChecksum::kNone;
  std::vector<Block> blocks;
};

// "file metadata", "G-code", ...; "kind 9" for unknown kinds.
std::string BlockName(BlockKind kind);
std::string CompressionName(BlockCompression compression);

// "block 3 at offset 1234": blocks are counted from 1.
std::string BlockPlace(const BgcodeBlocks& file, size_t index);

// The blocks of `file`, with each checksum checked. A block of unknown kind is kept as it is: its
// parameters have the length that fits its checksum. InvalidArgument with the block and its offset
// if a header is truncated, states more than there is, or a checksum is wrong. Allocates nothing
// because of what headers state.
absl::StatusOr<BgcodeBlocks> ParseBlocks(std::string_view file);

// The ten bytes before the blocks.
std::string BgcodeHeader(BgcodeChecksum checksum);

// Appends a block. `data` is the compressed form of `size` bytes, or those bytes themselves.
// REQUIRES: `parameters` has as many numbers as the kind has.
void AppendBlock(BlockKind kind, BlockCompression compression,
                 const std::vector<uint16_t>& parameters, uint32_t size, std::string_view data,
                 BgcodeChecksum checksum, std::string& out);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_BGCODE_BLOCK_H_
