// Bytes as binary G-code, through its reader and writer.
//
// Rules: a refusal is the file's fault and names it; what is read is written, and read again it is
// the same. Nothing takes more memory than the bytes can be worth.

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "client/containers/bgcode/block.h"
#include "client/containers/bgcode/meatpack.h"
#include "client/containers/bgcode/payload.h"
#include "client/containers/bytes.h"
#include "client/containers/container.h"
#include "client/containers/deflate.h"
#include "tests/fuzz/support/byte_changes.h"
#include "tests/fuzz/support/check.h"

namespace traverse::fuzz {
namespace {

using namespace containers;  // NOLINT

constexpr size_t kFileHeader = 10;

void CheckRefusal(const absl::Status& status) {
  Check(absl::IsInvalidArgument(status) || absl::IsResourceExhausted(status), status.ToString());
  Check(absl::StartsWith(status.message(), "in.bgcode: "), status.ToString());
}

std::string SomeText(std::mt19937& random) {
  static const char* const kLines[] = {"G1 X10.5 Y-2 E.0123\n",
                                       "G28 XY\n",
                                       ";TYPE:Perimeter\n",
                                       "M73 P0 R3\n",
                                       "M117 \"Hello; you\"\n",
                                       "G92 E0 ; c\n",
                                       "T1\n",
                                       "\n",
                                       "N5 G1 X1*33\n",
                                       "; \n",
                                       "G1 X1 F1200 ;a comment\n",
                                       "END_PRINT\n"};
  std::string out;
  for (size_t lines = random() % 60; lines > 0; --lines)
    out += kLines[random() % std::size(kLines)];
  return out;
}

// A good file of a random shape.
std::string FreshFile(std::mt19937& random) {
  const auto checksum = static_cast<BgcodeChecksum>(random() % 2);
  const auto compression = [&] { return static_cast<BlockCompression>(random() % 4); };
  std::string out = BgcodeHeader(checksum);
  const auto add = [&](BlockKind kind, BlockCompression packed, std::vector<uint16_t> parameters,
                       const std::string& content) {
    const auto data = CompressBytes(content, packed);
    Check(data.ok(), data.status().ToString());
    AppendBlock(kind, packed, parameters, static_cast<uint32_t>(content.size()), *data, checksum,
                out);
  };
  if (random() % 2 == 0) add(BlockKind::kFileMetadata, compression(), {0}, "Producer=me\n");
  add(BlockKind::kPrinterMetadata, compression(), {0}, "printer_model=MK4\nx=\n");
  if (random() % 2 == 0) add(BlockKind::kThumbnail, BlockCompression::kNone, {0, 2, 2}, "png");
  add(BlockKind::kPrintMetadata, compression(), {0},
      "estimated printing time (normal mode)=3m 41s\n");
  if (random() % 4 == 0) add(static_cast<BlockKind>(9), compression(), {1, 2}, "unknown");
  add(BlockKind::kSlicerMetadata, compression(), {0}, "a=1\nb=2\n");
  const GcodeForm form = {compression(), static_cast<GcodeEncoding>(random() % 3), checksum};
  for (size_t blocks = 1 + random() % 2; blocks > 0; --blocks) {
    Check(AppendGcodeBlocks(SomeText(random), form, 1, out).ok(), "text is packed");
  }
  return out;
}

// Makes the checksums of all blocks right that can still be told apart.
void RepairChecksums(std::string& bytes) {
  constexpr uint16_t kCrc = 1;
  if (bytes.size() < kFileHeader || LoadU16(bytes, 8) != kCrc) return;
  for (size_t at = kFileHeader; at + 12 <= bytes.size();) {
    const uint16_t compression = LoadU16(bytes, at + 2);
    const size_t header = compression == 0 ? 8 : 12;
    const size_t parameters = LoadU16(bytes, at) == 5 ? 6 : 2;
    const size_t stored = LoadU32(bytes, at + (compression == 0 ? 4 : 8));
    const size_t end = at + header + parameters + stored;
    if (end + 4 > bytes.size()) return;
    StoreU32(bytes, end, Crc32(std::string_view(bytes).substr(at, end - at)));
    at = end + 4;
  }
}

}  // namespace
}  // namespace traverse::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace traverse;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (DetectContainer(bytes) != ContainerKind::kBgcode) return 0;
  ContainerOptions options;
  options.max_text_bytes = size_t{8} << 20;
  const auto container = OpenContainer(bytes, "in.bgcode", options);
  if (!container.ok()) {
    fuzz::CheckRefusal(container.status());
    return 0;
  }
  (*container)->Facts();
  const auto text = (*container)->Text(0);
  if (!text.ok()) {
    fuzz::CheckRefusal(text.status());
    return 0;
  }
  const auto written = (*container)->WithParts({{0, {*text, {}}}});
  fuzz::Check(written.ok(), written.status().ToString());
  const auto again = OpenContainer(*written, "in.bgcode", options);
  fuzz::Check(again.ok(), again.status().ToString());
  const auto same = (*again)->Text(0);
  fuzz::Check(same.ok(), same.status().ToString());
  fuzz::Check(containers::EqualToAPrinter(*same, *text), "what is written is what was read");
  const auto packed = PackText(*text, ContainerKind::kBgcode);
  fuzz::Check(packed.ok(), packed.status().ToString());
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  std::mt19937 random(seed);
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size < traverse::fuzz::kFileHeader || random() % 8 == 0) {
    bytes = traverse::fuzz::FreshFile(random);
  } else {
    traverse::fuzz::ChangeBytes(bytes, random() % 64 == 0 ? 0 : 8, random);
    if (random() % 8 != 0) traverse::fuzz::RepairChecksums(bytes);
  }
  const size_t out = std::min(bytes.size(), max_size);
  std::memcpy(data, bytes.data(), out);
  return out;
}
