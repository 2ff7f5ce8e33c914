// Zip archives: reads their directory, and writes them again with some entries replaced.
//
// Everything else is copied byte by byte: local headers, data descriptors, padding between entries,
// the directory's records except offsets, the comment. The code is our own, because Debian's libzip
// (1.7.3) drops descriptors of streaming writers and minizip cannot replace entries; zlib does
// deflate and CRC-32.
//
// Not supported: encrypted entries, archives in several parts, zip64 (beyond 4 GiB or 65,535
// entries).

#ifndef TRAVERSE_CLIENT_CONTAINERS_ZIP_ARCHIVE_H_
#define TRAVERSE_CLIENT_CONTAINERS_ZIP_ARCHIVE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace traverse::containers {

enum class ZipMethod : uint16_t { kStored = 0, kDeflated = 8 };

struct ZipEntry {
  std::string_view name;                  // as in the directory
  ZipMethod method = ZipMethod::kStored;  // may be none of the names
  uint16_t flags = 0;
  uint32_t crc = 0;
  uint32_t compressed_size = 0;
  uint32_t size = 0;
  size_t record = 0;  // in the directory; offsets are relative to the file
  size_t record_bytes = 0;
  size_t begin = 0;  // of the local header
  size_t data = 0;   // of the compressed data
  size_t end = 0;    // after data and descriptor
};

struct ZipArchive {
  std::string_view file;
  std::vector<ZipEntry> entries;  // in the directory's order
  size_t directory = 0;
  size_t directory_end = 0;
  size_t tail = 0;  // the record after the directory, up to the file's end

  // The entry with that name, or null.
  const ZipEntry* Find(std::string_view name) const;
};

// The directory of `file`, with each local header checked against it. InvalidArgument, with the
// entry's name, if anything is truncated, lies outside the file or overlaps another entry; is
// encrypted or zip64; or if names occur twice or would lead out of a folder (`..`, backslashes,
// drive letters). The caller judges names that begin with '/'.
absl::StatusOr<ZipArchive> ParseZip(std::string_view file);

// The content of `entry`, checked against its CRC-32. InvalidArgument with its name if it is
// damaged, differs from the directory, or is not compressed by deflate; ResourceExhausted if it is
// longer than `max_bytes`.
absl::StatusOr<std::string> ReadEntry(const ZipArchive& archive, const ZipEntry& entry,
                                      size_t max_bytes);

// The same without keeping it, in pieces; their checksum is not looked at.
absl::Status VisitEntry(const ZipArchive& archive, const ZipEntry& entry,
                        const std::function<void(std::string_view piece)>& sink);

// The archive with the contents of `replaced` (by index of the entry) instead of the old ones,
// compressed by the same method, with the same names and times. ResourceExhausted if it would
// become a zip64.
absl::StatusOr<std::string> WriteZip(const ZipArchive& archive,
                                     const std::map<size_t, std::string>& replaced, int threads);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_ZIP_ARCHIVE_H_
