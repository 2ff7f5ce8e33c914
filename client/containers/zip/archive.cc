#include "client/containers/zip/archive.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_format.h"
#include "client/containers/bytes.h"
#include "client/containers/deflate.h"
#include "client/containers/zip/zip_format.h"

namespace traverse::containers {
namespace {

using namespace zip_format;  // NOLINT: offsets of one format

absl::Status EntryFault(std::string_view name, const std::string& text) {
  constexpr size_t kMaxShown = 100;
  const std::string shown(name.substr(0, kMaxShown));
  return absl::InvalidArgumentError(absl::StrFormat("entry %s: %s", absl::CHexEscape(shown), text));
}

// Where the record that ends the archive begins: before its comment, which ends the file.
std::optional<size_t> FindEnd(std::string_view file) {
  if (file.size() < kEndBytes) return std::nullopt;
  const size_t last = file.size() - kEndBytes;
  const size_t first = last - std::min(last, size_t{std::numeric_limits<uint16_t>::max()});
  for (size_t at = last + 1; at-- > first;) {
    if (LoadU32(file, at) != kEndSignature) continue;
    if (at + kEndBytes + LoadU16(file, at + kEndCommentBytes) == file.size()) return at;
  }
  return std::nullopt;
}

absl::Status CheckName(std::string_view name) {
  const auto refuse = [&](const char* why) { return EntryFault(name, why); };
  if (name.empty()) return absl::InvalidArgumentError("an entry without a name");
  if (name.find('\0') != std::string_view::npos) return refuse("its name has a zero byte");
  if (name.find('\\') != std::string_view::npos) return refuse("its name has a backslash");
  if (name.size() > 1 && name[1] == ':') return refuse("its name begins with a drive");
  if (name.starts_with("//")) return refuse("its name begins with two slashes");
  for (size_t begin = 0; begin <= name.size();) {
    const size_t end = std::min(name.find('/', begin), name.size());
    if (name.substr(begin, end - begin) == "..") return refuse("its name leads out of its folder");
    begin = end + 1;
  }
  return absl::OkStatus();
}

// Fills `entry` from the record of the directory at `at`.
absl::Status ParseRecord(std::string_view file, size_t at, size_t end, ZipEntry& entry) {
  if (end - at < kRecordBytes || LoadU32(file, at) != kRecordSignature) {
    return absl::InvalidArgumentError(absl::StrFormat("the directory is damaged at offset %d", at));
  }
  const size_t name_bytes = LoadU16(file, at + kRecordNameBytes);
  entry.record = at;
  entry.record_bytes = kRecordBytes + name_bytes + LoadU16(file, at + kRecordExtraBytes) +
                       LoadU16(file, at + kRecordCommentBytes);
  if (entry.record_bytes > end - at) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the directory is cut short at offset %d", at));
  }
  entry.name = file.substr(at + kRecordBytes, name_bytes);
  if (absl::Status status = CheckName(entry.name); !status.ok()) return status;
  entry.flags = LoadU16(file, at + kRecordFlags);
  entry.method = static_cast<ZipMethod>(LoadU16(file, at + kRecordMethod));
  entry.crc = LoadU32(file, at + kRecordCrc);
  entry.compressed_size = LoadU32(file, at + kRecordCompressedSize);
  entry.size = LoadU32(file, at + kRecordSize);
  entry.begin = LoadU32(file, at + kRecordOffset);
  constexpr uint16_t kHidden = kFlagEncrypted | kFlagStrongEncryption | kFlagMaskedHeaders;
  if ((entry.flags & kHidden) != 0) return EntryFault(entry.name, "it is encrypted");
  if (entry.compressed_size == kInZip64 || entry.size == kInZip64 || entry.begin == kInZip64) {
    return EntryFault(entry.name, "it is a zip64 entry, which is not supported");
  }
  if (LoadU16(file, at + kRecordDisk) != 0) {
    return EntryFault(entry.name, "it is in another part of the archive");
  }
  return absl::OkStatus();
}

// The end of the descriptor that may follow the data of `entry`.
absl::StatusOr<size_t> EndOfDescriptor(std::string_view file, size_t limit, const ZipEntry& entry,
                                       size_t data_end) {
  const auto fits = [&](size_t at) {
    return limit - at >= kDescriptorBytes && LoadU32(file, at) == entry.crc &&
           LoadU32(file, at + 4) == entry.compressed_size && LoadU32(file, at + 8) == entry.size;
  };
  if (limit - data_end >= 4 + kDescriptorBytes && LoadU32(file, data_end) == kDescriptorSignature &&
      fits(data_end + 4)) {
    return data_end + 4 + kDescriptorBytes;
  }
  if (fits(data_end)) return data_end + kDescriptorBytes;
  // Writers of zip64 write sizes of 8 bytes here even where 4 are enough.
  const auto fits_wide = [&](size_t at) {
    return limit - at >= kWideDescriptorBytes && LoadU32(file, at) == entry.crc &&
           LoadU32(file, at + 4) == entry.compressed_size && LoadU32(file, at + 8) == 0 &&
           LoadU32(file, at + 12) == entry.size && LoadU32(file, at + 16) == 0;
  };
  if (limit - data_end >= 4 + kWideDescriptorBytes &&
      LoadU32(file, data_end) == kDescriptorSignature && fits_wide(data_end + 4)) {
    return data_end + 4 + kWideDescriptorBytes;
  }
  if (fits_wide(data_end)) return data_end + kWideDescriptorBytes;
  return EntryFault(entry.name, "its data descriptor differs from the directory");
}

// Finds the data and the end of `entry`, which lie before `limit`.
absl::Status LocateEntry(std::string_view file, size_t limit, ZipEntry& entry) {
  if (entry.begin > limit || limit - entry.begin < kLocalBytes) {
    return EntryFault(entry.name, "it begins after the end of the entries");
  }
  const size_t at = entry.begin;
  const size_t name_bytes = LoadU16(file, at + kLocalNameBytes);
  const size_t header = kLocalBytes + name_bytes + LoadU16(file, at + kLocalExtraBytes);
  if (LoadU32(file, at) != kLocalSignature || limit - at < header ||
      file.substr(at + kLocalBytes, name_bytes) != entry.name ||
      LoadU16(file, at + kLocalMethod) != static_cast<uint16_t>(entry.method)) {
    return EntryFault(entry.name, "its local header differs from the directory");
  }
  entry.data = at + header;
  if (limit - entry.data < entry.compressed_size) {
    return EntryFault(entry.name, absl::StrFormat("it states %d bytes, but only %d are left",
                                                  entry.compressed_size, limit - entry.data));
  }
  entry.end = entry.data + entry.compressed_size;
  if ((LoadU16(file, at + kLocalFlags) & kFlagDescriptor) == 0) {
    const uint32_t stated = LoadU32(file, at + kLocalCompressedSize);
    if (stated != entry.compressed_size && stated != kInZip64) {
      return EntryFault(entry.name, "its local header differs from the directory");
    }
    return absl::OkStatus();
  }
  const absl::StatusOr<size_t> end = EndOfDescriptor(file, limit, entry, entry.end);
  if (end.ok()) entry.end = *end;
  return end.status();
}

// Entries in the order of their positions in the file.
std::vector<size_t> ByOffset(const ZipArchive& archive) {
  std::vector<size_t> order(archive.entries.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return archive.entries[a].begin < archive.entries[b].begin;
  });
  return order;
}

absl::Status CheckTogether(const ZipArchive& archive) {
  std::set<std::string_view> names;
  for (const ZipEntry& entry : archive.entries) {
    if (!names.insert(entry.name).second) {
      return EntryFault(entry.name, "there are two with that name");
    }
  }
  size_t end = 0;
  for (const size_t i : ByOffset(archive)) {
    const ZipEntry& entry = archive.entries[i];
    if (entry.begin < end) return EntryFault(entry.name, "it overlaps another entry");
    end = entry.end;
  }
  return absl::OkStatus();
}

// The extra fields in `extra` without the zip64 field.
std::string WithoutZip64(std::string_view extra) {
  constexpr size_t kHead = 4;
  std::string out;
  while (extra.size() >= kHead) {
    const size_t bytes = std::min(kHead + LoadU16(extra, 2), extra.size());
    if (LoadU16(extra, 0) != kZip64Extra) out.append(extra.substr(0, bytes));
    extra.remove_prefix(bytes);
  }
  out.append(extra);
  return out;
}

struct NewData {
  std::string bytes;  // compressed
  uint32_t crc = 0;
  uint32_t size = 0;
};

// The level that the flags of `entry` hint at. On G-code zlib's usual level 6 takes three times the
// time of level 4 and saves 7 %; level 5 takes twice the time and saves 6 %.
int LevelOf(const ZipEntry& entry) {
  constexpr int kUsual = 4;
  constexpr int kBest = 9;
  constexpr int kFast = 3;
  switch (entry.flags >> 1 & 3) {
    case 0:
      return kUsual;
    case 1:
      return kBest;
    default:
      return kFast;
  }
}

absl::StatusOr<NewData> Compress(const ZipEntry& entry, const std::string& content, int threads) {
  NewData out;
  if (content.size() >= kInZip64) return absl::ResourceExhaustedError("more than 4 GiB");
  out.crc = Crc32(content);
  out.size = static_cast<uint32_t>(content.size());
  if (entry.method == ZipMethod::kStored) {
    out.bytes = content;
  } else {
    absl::StatusOr<std::string> bytes =
        Deflate(content, DeflateForm::kRaw, LevelOf(entry), threads);
    if (!bytes.ok()) return bytes.status();
    out.bytes = *std::move(bytes);
  }
  if (out.bytes.size() >= kInZip64) return absl::ResourceExhaustedError("more than 4 GiB");
  return out;
}

// Appends the local header and the data of `entry` with new content; the header has the sizes.
void AppendReplaced(std::string_view file, const ZipEntry& entry, const NewData& data,
                    std::string& out) {
  const size_t extra_begin = entry.begin + kLocalBytes + entry.name.size();
  const std::string extra = WithoutZip64(file.substr(extra_begin, entry.data - extra_begin));
  std::string header(file.substr(entry.begin, kLocalBytes));
  StoreU16(header, kLocalFlags,
           static_cast<uint16_t>(LoadU16(header, kLocalFlags) & ~kFlagDescriptor));
  StoreU32(header, kLocalCrc, data.crc);
  StoreU32(header, kLocalCompressedSize, static_cast<uint32_t>(data.bytes.size()));
  StoreU32(header, kLocalSize, data.size);
  StoreU16(header, kLocalExtraBytes, static_cast<uint16_t>(extra.size()));
  out.append(header).append(entry.name).append(extra).append(data.bytes);
}

// Appends the record of `entry`, which now begins at `offset`.
void AppendRecord(std::string_view file, const ZipEntry& entry, uint32_t offset,
                  const NewData* data, std::string& out) {
  std::string record(file.substr(entry.record, entry.record_bytes));
  StoreU32(record, kRecordOffset, offset);
  if (data != nullptr) {
    StoreU16(record, kRecordFlags, static_cast<uint16_t>(entry.flags & ~kFlagDescriptor));
    StoreU32(record, kRecordCrc, data->crc);
    StoreU32(record, kRecordCompressedSize, static_cast<uint32_t>(data->bytes.size()));
    StoreU32(record, kRecordSize, data->size);
    const size_t extra_begin = kRecordBytes + entry.name.size();
    const size_t extra_bytes = LoadU16(record, kRecordExtraBytes);
    const std::string extra =
        WithoutZip64(std::string_view(record).substr(extra_begin, extra_bytes));
    record.replace(extra_begin, extra_bytes, extra);
    StoreU16(record, kRecordExtraBytes, static_cast<uint16_t>(extra.size()));
  }
  out += record;
}

}  // namespace

const ZipEntry* ZipArchive::Find(std::string_view name) const {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const ZipEntry& entry) { return entry.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

absl::StatusOr<ZipArchive> ParseZip(std::string_view file) {
  const std::optional<size_t> end = FindEnd(file);
  if (!end) return absl::InvalidArgumentError("the zip archive is cut short: it has no directory");
  if (*end >= kZip64LocatorBytes &&
      LoadU32(file, *end - kZip64LocatorBytes) == kZip64LocatorSignature) {
    return absl::InvalidArgumentError("it is a zip64 archive, which is not supported");
  }
  ZipArchive out;
  out.file = file;
  out.tail = *end;
  out.directory = LoadU32(file, *end + kEndDirectory);
  const size_t bytes = LoadU32(file, *end + kEndDirectoryBytes);
  const size_t count = LoadU16(file, *end + kEndEntries);
  if (LoadU16(file, *end + kEndDisk) != 0 || LoadU16(file, *end + kEndEntriesHere) != count) {
    return absl::InvalidArgumentError("it is one of several parts of an archive");
  }
  if (out.directory > *end || bytes > *end - out.directory) {
    return absl::InvalidArgumentError("the zip archive's directory is not at its stated position");
  }
  out.directory_end = out.directory + bytes;
  size_t at = out.directory;
  for (size_t i = 0; i < count; ++i) {
    ZipEntry entry;
    absl::Status status = ParseRecord(file, at, out.directory_end, entry);
    if (status.ok()) status = LocateEntry(file, out.directory, entry);
    if (!status.ok()) return status;
    at += entry.record_bytes;
    out.entries.push_back(entry);
  }
  if (at != out.directory_end)
    return absl::InvalidArgumentError("the directory has more entries than it states");
  if (absl::Status status = CheckTogether(out); !status.ok()) return status;
  return out;
}

absl::StatusOr<std::string> ReadEntry(const ZipArchive& archive, const ZipEntry& entry,
                                      size_t max_bytes) {
  if (entry.size > max_bytes) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("entry %s: it states %d MiB, but only %d are allowed",
                        std::string(entry.name), entry.size >> 20, max_bytes >> 20));
  }
  const std::string_view data = archive.file.substr(entry.data, entry.compressed_size);
  std::string content;
  if (entry.method == ZipMethod::kStored) {
    if (entry.compressed_size != entry.size) {
      return EntryFault(entry.name, "it is stored uncompressed, but its two sizes differ");
    }
    content = std::string(data);
  } else if (entry.method == ZipMethod::kDeflated) {
    absl::StatusOr<std::string> inflated = Inflate(data, DeflateForm::kRaw, entry.size);
    if (!inflated.ok()) return EntryFault(entry.name, std::string(inflated.status().message()));
    content = *std::move(inflated);
  } else {
    return EntryFault(entry.name,
                      absl::StrFormat("compression %d is unknown", static_cast<int>(entry.method)));
  }
  if (const uint32_t crc = Crc32(content); crc != entry.crc) {
    return EntryFault(entry.name,
                      absl::StrFormat("its CRC32 should be %08x, but is %08x", entry.crc, crc));
  }
  return content;
}

absl::Status VisitEntry(const ZipArchive& archive, const ZipEntry& entry,
                        const std::function<void(std::string_view)>& sink) {
  const std::string_view data = archive.file.substr(entry.data, entry.compressed_size);
  if (entry.method == ZipMethod::kStored) {
    sink(data);
    return absl::OkStatus();
  }
  if (entry.method != ZipMethod::kDeflated) {
    return EntryFault(entry.name,
                      absl::StrFormat("compression %d is unknown", static_cast<int>(entry.method)));
  }
  const absl::Status status = InflateInPieces(data, DeflateForm::kRaw, entry.size, sink);
  return status.ok() ? status : EntryFault(entry.name, std::string(status.message()));
}

absl::StatusOr<std::string> WriteZip(const ZipArchive& archive,
                                     const std::map<size_t, std::string>& replaced, int threads) {
  std::string out;
  std::vector<NewData> data(archive.entries.size());
  std::vector<uint32_t> offsets(archive.entries.size());
  size_t copied = 0;  // bytes of the old file copied so far
  for (const size_t i : ByOffset(archive)) {
    const ZipEntry& entry = archive.entries[i];
    out.append(archive.file.substr(copied, entry.begin - copied));
    copied = entry.begin;
    if (out.size() >= kInZip64) return absl::ResourceExhaustedError("more than 4 GiB");
    offsets[i] = static_cast<uint32_t>(out.size());
    const auto content = replaced.find(i);
    if (content == replaced.end()) continue;
    absl::StatusOr<NewData> compressed = Compress(entry, content->second, threads);
    if (!compressed.ok()) return compressed.status();
    data[i] = *std::move(compressed);
    AppendReplaced(archive.file, entry, data[i], out);
    copied = entry.end;
  }
  out.append(archive.file.substr(copied, archive.directory - copied));
  if (out.size() >= kInZip64) return absl::ResourceExhaustedError("more than 4 GiB");
  const size_t directory = out.size();
  for (size_t i = 0; i < archive.entries.size(); ++i) {
    AppendRecord(archive.file, archive.entries[i], offsets[i],
                 replaced.contains(i) ? &data[i] : nullptr, out);
  }
  const size_t directory_bytes = out.size() - directory;
  out.append(archive.file.substr(archive.directory_end, archive.tail - archive.directory_end));
  std::string tail(archive.file.substr(archive.tail));
  StoreU32(tail, kEndDirectory, static_cast<uint32_t>(directory));
  StoreU32(tail, kEndDirectoryBytes, static_cast<uint32_t>(directory_bytes));
  out += tail;
  return out;
}

}  // namespace traverse::containers
