// A file of binary G-code with all kinds of blocks.

#ifndef TRAVERSE_TESTS_CLIENT_CONTAINERS_BGCODE_MADE_FILE_H_
#define TRAVERSE_TESTS_CLIENT_CONTAINERS_BGCODE_MADE_FILE_H_

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "client/containers/bgcode/block.h"
#include "client/containers/bgcode/metadata.h"
#include "client/containers/bgcode/payload.h"
#include "client/containers/container.h"
#include "tests/support/status_matchers.h"

namespace traverse::containers {

inline constexpr const char* kBgcodeName = "part.bgcode";

inline const std::string kMadePrinter =
    "printer_model=MK4S\nestimated printing time (normal mode)=3m 41s\n";
inline const std::string kMadePrint =
    "filament used [mm]=252.22\nestimated printing time (normal mode)=3m 41s\n"
    "estimated first layer printing time (normal mode)=20s\n";
inline const std::string kMadeSlicer = "arc_fitting=emit_center\nend_gcode=G4 ; wait\\nM107\n";
inline const std::string kMadeGcode =
    "M73 P0 R3\n;LAYER_CHANGE\nG28\nG1 X1 Y2 E.5\nG1 X3 Y-2 F1200\nM117 a message\n";

struct Shape {
  BgcodeChecksum checksum = BgcodeChecksum::kCrc32;
  BlockCompression metadata = BlockCompression::kDeflate;
  BlockCompression gcode = BlockCompression::kHeatshrink12;
  GcodeEncoding encoding = GcodeEncoding::kMeatPackComments;
};

inline void Append(BlockKind kind, BlockCompression compression,
                   const std::vector<uint16_t>& parameters, const std::string& content,
                   BgcodeChecksum checksum, std::string& out) {
  const auto data = CompressBytes(content, compression);
  ASSERT_OK(data);
  AppendBlock(kind, compression, parameters, static_cast<uint32_t>(content.size()), *data, checksum,
              out);
}

inline std::string MakeFile(const Shape& shape, const std::string& gcode = kMadeGcode) {
  std::string out = BgcodeHeader(shape.checksum);
  const auto none = BlockCompression::kNone;
  Append(BlockKind::kFileMetadata, none, {0},
         "Producer=PrusaSlicer 2.8.1\nProduced on=2024-10-21 at 06:38:01 UTC\n", shape.checksum,
         out);
  Append(BlockKind::kPrinterMetadata, none, {0}, kMadePrinter, shape.checksum, out);
  Append(BlockKind::kThumbnail, none, {2, 16, 16}, "qoif-picture", shape.checksum, out);
  Append(BlockKind::kPrintMetadata, shape.metadata, {0}, kMadePrint, shape.checksum, out);
  Append(BlockKind::kSlicerMetadata, shape.metadata, {0}, kMadeSlicer, shape.checksum, out);
  EXPECT_OK(AppendGcodeBlocks(gcode, {shape.gcode, shape.encoding, shape.checksum}, 1, out));
  return out;
}

inline absl::StatusOr<std::string> TextOf(const std::string& bytes) {
  auto container = OpenContainer(bytes, kBgcodeName, {});
  if (!container.ok()) return container.status();
  return (*container)->Text(0);
}

}  // namespace traverse::containers

#endif  // TRAVERSE_TESTS_CLIENT_CONTAINERS_BGCODE_MADE_FILE_H_
