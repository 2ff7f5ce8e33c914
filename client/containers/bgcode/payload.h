// The contents of blocks: compresses and decompresses them, and handles the texts of G-code blocks.

#ifndef TRAVERSE_CLIENT_CONTAINERS_BGCODE_PAYLOAD_H_
#define TRAVERSE_CLIENT_CONTAINERS_BGCODE_PAYLOAD_H_

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "client/containers/bgcode/block.h"

namespace traverse::containers {

// How to write G-code blocks.
struct GcodeForm {
  BlockCompression compression = BlockCompression::kHeatshrink12;
  GcodeEncoding encoding = GcodeEncoding::kMeatPackComments;
  BgcodeChecksum checksum = BgcodeChecksum::kCrc32;
};

// Most text in one G-code block, before and after MeatPack; a longer line is a block by itself.
inline constexpr size_t kMaxBlockText = 65536;

// Most bytes that a G-code block may state. Known writers stay below 64 KiB, and a block is in
// memory as a whole, unpacked, before its text is counted.
inline constexpr size_t kMaxBlockBytes = size_t{2} << 20;

// The data of `block`, decompressed. InvalidArgument if they are damaged or the compression is
// unknown. Allocates nothing for an impossible size.
absl::StatusOr<std::string> DecompressBlock(const Block& block);

absl::StatusOr<std::string> CompressBytes(std::string_view bytes, BlockCompression compression);

// The text of all G-code blocks of `file`, on up to `threads` threads. Errors name the block;
// ResourceExhausted if the text is longer than `max_bytes`.
absl::StatusOr<std::string> GcodeText(const BgcodeBlocks& file, size_t max_bytes, int threads);

// Passes that text on block by block, without keeping it. Errors: the same.
absl::Status VisitGcode(const BgcodeBlocks& file, size_t max_bytes,
                        const std::function<void(std::string_view piece)>& sink);

// Appends `text` as G-code blocks of whole lines, built on up to `threads` threads. A block with a
// byte that MeatPack cannot express is not encoded.
absl::Status AppendGcodeBlocks(std::string_view text, const GcodeForm& form, int threads,
                               std::string& out);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_BGCODE_PAYLOAD_H_
