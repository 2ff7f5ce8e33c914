// Signatures and offsets of the records of a zip archive (PKWARE's APPNOTE 6.3, sections 4.3, 4.4).

#ifndef TRAVERSE_CLIENT_CONTAINERS_ZIP_ZIP_FORMAT_H_
#define TRAVERSE_CLIENT_CONTAINERS_ZIP_ZIP_FORMAT_H_

#include <cstddef>
#include <cstdint>

namespace traverse::containers::zip_format {

// Before each entry's data: the local header, then name and extra fields.
inline constexpr uint32_t kLocalSignature = 0x04034b50;
inline constexpr size_t kLocalFlags = 6;
inline constexpr size_t kLocalMethod = 8;
inline constexpr size_t kLocalCrc = 14;
inline constexpr size_t kLocalCompressedSize = 18;
inline constexpr size_t kLocalSize = 22;
inline constexpr size_t kLocalNameBytes = 26;
inline constexpr size_t kLocalExtraBytes = 28;
inline constexpr size_t kLocalBytes = 30;

// Behind the data, with kFlagDescriptor: often this signature, then CRC and both sizes.
inline constexpr uint32_t kDescriptorSignature = 0x08074b50;
inline constexpr size_t kDescriptorBytes = 12;
inline constexpr size_t kWideDescriptorBytes = 20;  // of zip64

// The directory: a record an entry, then name, extra fields and comment.
inline constexpr uint32_t kRecordSignature = 0x02014b50;
inline constexpr size_t kRecordFlags = 8;
inline constexpr size_t kRecordMethod = 10;
inline constexpr size_t kRecordCrc = 16;
inline constexpr size_t kRecordCompressedSize = 20;
inline constexpr size_t kRecordSize = 24;
inline constexpr size_t kRecordNameBytes = 28;
inline constexpr size_t kRecordExtraBytes = 30;
inline constexpr size_t kRecordCommentBytes = 32;
inline constexpr size_t kRecordDisk = 34;
inline constexpr size_t kRecordOffset = 42;
inline constexpr size_t kRecordBytes = 46;

// What ends the archive, then its comment.
inline constexpr uint32_t kEndSignature = 0x06054b50;
inline constexpr size_t kEndDisk = 4;
inline constexpr size_t kEndEntriesHere = 8;
inline constexpr size_t kEndEntries = 10;
inline constexpr size_t kEndDirectoryBytes = 12;
inline constexpr size_t kEndDirectory = 16;
inline constexpr size_t kEndCommentBytes = 20;
inline constexpr size_t kEndBytes = 22;

inline constexpr uint32_t kZip64LocatorSignature = 0x07064b50;
inline constexpr size_t kZip64LocatorBytes = 20;
inline constexpr uint16_t kZip64Extra = 1;
inline constexpr uint32_t kInZip64 = 0xffffffff;  // a size or offset that the extra field has

inline constexpr uint16_t kFlagEncrypted = 1 << 0;
inline constexpr uint16_t kFlagDescriptor = 1 << 3;
inline constexpr uint16_t kFlagStrongEncryption = 1 << 6;
inline constexpr uint16_t kFlagMaskedHeaders = 1 << 13;

}  // namespace traverse::containers::zip_format

#endif  // TRAVERSE_CLIENT_CONTAINERS_ZIP_ZIP_FORMAT_H_
