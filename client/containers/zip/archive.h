// Zip archives: reading their directory, and writing them again with some entries replaced.
//
// Everything that is not replaced is copied byte by byte: local headers, data descriptors, what
// stands between entries, the directory's records but for offsets, the comment. Debian's libzip
// (1.7.3) writes local headers anew, without the descriptors that streaming writers leave, and
// minizip replaces no entries; so the archive is ours, and zlib does deflate and CRC-32.
//
// Not read: encrypted entries, archives in several parts, zip64 (beyond 4 GiB or 65,535 entries).

#ifndef TRAVERSE_CLIENT_CONTAINERS_ZIP_ARCHIVE_H_
#define TRAVERSE_CLIENT_CONTAINERS_ZIP_ARCHIVE_H_

#include <cstddef>
#include <cstdint>
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
  size_t record = 0;  // of the directory; offsets in the file
  size_t record_bytes = 0;
  size_t begin = 0;  // of the local header
  size_t data = 0;   // of what is compressed
  size_t end = 0;    // behind data and descriptor
};

struct ZipArchive {
  std::string_view file;
  std::vector<ZipEntry> entries;  // in the directory's order
  size_t directory = 0;
  size_t directory_end = 0;
  size_t tail = 0;  // the record behind the directory, up to the file's end

  // The entry of that name, or null.
  const ZipEntry* Find(std::string_view name) const;
};

// The directory of `file`, each local header checked against it. InvalidArgument, with the entry's
// name, for what is cut short, lies outside the file or over another entry; encrypted or zip64;
// names that occur twice, or that would lead out of a folder (`..`, backslashes, drive letters).
// Names that begin with '/' are for the caller to judge.
absl::StatusOr<ZipArchive> ParseZip(std::string_view file);

// The content of `entry`, checked against its CRC-32. InvalidArgument with its name if it is
// damaged, not what the directory says, or compressed otherwise than by deflate; ResourceExhausted
// if it is longer than `max_bytes`.
absl::StatusOr<std::string> ReadEntry(const ZipArchive& archive, const ZipEntry& entry,
                                      size_t max_bytes);

// The archive with the contents of `replaced` (by index of the entry) in place of those it had,
// compressed by the same method, with the same names and times.
// ResourceExhausted if it would become a zip64.
absl::StatusOr<std::string> WriteZip(const ZipArchive& archive,
                                     const std::map<size_t, std::string>& replaced, int threads);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_ZIP_ARCHIVE_H_
