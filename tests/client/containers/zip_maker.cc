#include "tests/client/containers/zip_maker.h"

#include <zlib.h>

#include "client/containers/bytes.h"

namespace traverse::testing {
namespace {

using containers::AppendU16;
using containers::AppendU32;

constexpr uint16_t kDescriptorFlag = 8;
constexpr uint16_t kTime = 0x6a21;
constexpr uint16_t kDate = 0x5b79;

std::string RawDeflated(const std::string& content) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

uint32_t Crc(const std::string& content) {
  return static_cast<uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())));
}

// What local header and record have in common: from the version needed to the sizes.
void AppendCommon(const MadeEntry& entry, const std::string& data, bool sizes, std::string& out) {
  AppendU16(out, 20);
  AppendU16(out, static_cast<uint16_t>(entry.flags | (entry.descriptor ? kDescriptorFlag : 0)));
  AppendU16(out, entry.method != UINT16_MAX ? entry.method : entry.deflated ? 8 : 0);
  AppendU16(out, kTime);
  AppendU16(out, kDate);
  AppendU32(out, sizes ? Crc(entry.content) : 0);
  AppendU32(out, sizes ? static_cast<uint32_t>(data.size()) : 0);
  AppendU32(out, sizes ? static_cast<uint32_t>(entry.content.size()) : 0);
  AppendU16(out, static_cast<uint16_t>(entry.name.size()));
}

}  // namespace

MadeZip MakeZip(const std::vector<MadeEntry>& entries, const std::string& comment) {
  MadeZip zip;
  std::string& out = zip.bytes;
  std::vector<std::string> data;
  for (const MadeEntry& entry : entries) {
    data.push_back(entry.deflated ? RawDeflated(entry.content) : entry.content);
    out += entry.gap;
    zip.local.push_back(out.size());
    AppendU32(out, 0x04034b50);
    AppendCommon(entry, data.back(), !entry.descriptor, out);
    AppendU16(out, static_cast<uint16_t>(entry.local_extra.size()));
    out += entry.name + entry.local_extra + data.back();
    if (!entry.descriptor) continue;
    AppendU32(out, 0x08074b50);
    AppendU32(out, Crc(entry.content));
    AppendU32(out, static_cast<uint32_t>(data.back().size()));
    AppendU32(out, static_cast<uint32_t>(entry.content.size()));
  }
  const size_t directory = out.size();
  for (size_t i = 0; i < entries.size(); ++i) {
    zip.record.push_back(out.size());
    AppendU32(out, 0x02014b50);
    AppendU16(out, 0x033f);
    AppendCommon(entries[i], data[i], true, out);
    AppendU16(out, static_cast<uint16_t>(entries[i].extra.size()));
    AppendU16(out, 0);
    AppendU16(out, 0);
    AppendU16(out, 1);
    AppendU32(out, 0x81a40000);
    AppendU32(out, static_cast<uint32_t>(zip.local[i]));
    out += entries[i].name + entries[i].extra;
  }
  zip.end = out.size();
  AppendU32(out, 0x06054b50);
  AppendU32(out, 0);
  AppendU16(out, static_cast<uint16_t>(entries.size()));
  AppendU16(out, static_cast<uint16_t>(entries.size()));
  AppendU32(out, static_cast<uint32_t>(zip.end - directory));
  AppendU32(out, static_cast<uint32_t>(directory));
  AppendU16(out, static_cast<uint16_t>(comment.size()));
  out += comment;
  return zip;
}

}  // namespace traverse::testing
