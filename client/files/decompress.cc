#include "client/files/decompress.h"

#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"

namespace traverse {
namespace {

constexpr size_t kFirstBuffer = size_t{1} << 16;

// Window, dictionary and so on of an xz stream; `xz -9` needs 65 MiB.
constexpr uint64_t kXzMemoryLimit = uint64_t{512} << 20;

absl::Status TooLong(size_t max_bytes) {
  return absl::ResourceExhaustedError(
      absl::StrFormat("more than %d MiB when decompressed", max_bytes >> 20));
}

// Makes room for more output: twice as much, within the limit by one byte, which tells a result of
// exactly `max_bytes` from a longer one.
void Grow(std::string& out, size_t max_bytes) {
  out.resize(std::min(std::max(out.size() * 2, kFirstBuffer), max_bytes + 1));
}

absl::StatusOr<std::string> Gunzip(std::string_view bytes, size_t max_bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) {
    return absl::ResourceExhaustedError("no memory to decompress");
  }
  std::string out;
  size_t used = 0;
  size_t consumed = 0;
  int code = Z_OK;
  while (true) {
    if (used == out.size()) {
      if (used > max_bytes) break;
      Grow(out, max_bytes);
    }
    // zlib counts in unsigned int: both sides go in pieces.
    constexpr size_t kPiece = std::numeric_limits<int>::max();
    const size_t in = std::min(bytes.size() - consumed, kPiece);
    const size_t room = std::min(out.size() - used, kPiece);
    // zlib's interface predates const; it does not write here.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + consumed));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + used);
    stream.avail_out = static_cast<uInt>(room);
    code = inflate(&stream, Z_NO_FLUSH);
    consumed += in - stream.avail_in;
    used += room - stream.avail_out;
    if (code == Z_STREAM_END) {
      // Another member may follow; anything else after the last one is padding.
      if (DetectCompression(bytes.substr(consumed)) != Compression::kGzip) break;
      inflateReset(&stream);
    } else if (code != Z_OK && !(code == Z_BUF_ERROR && used == out.size())) {
      break;
    }
  }
  inflateEnd(&stream);

  if (used > max_bytes) return TooLong(max_bytes);
  if (code == Z_BUF_ERROR) return absl::InvalidArgumentError("gzip data end too early");
  if (code != Z_STREAM_END) return absl::InvalidArgumentError("gzip data are damaged");
  out.resize(used);
  return out;
}

absl::StatusOr<std::string> Unxz(std::string_view bytes, size_t max_bytes) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, kXzMemoryLimit, LZMA_CONCATENATED) != LZMA_OK) {
    return absl::ResourceExhaustedError("no memory to decompress");
  }
  std::string out;
  stream.next_in = reinterpret_cast<const uint8_t*>(bytes.data());
  stream.avail_in = bytes.size();
  size_t used = 0;
  lzma_ret code = LZMA_OK;
  while (code == LZMA_OK) {
    if (used == out.size()) {
      if (used > max_bytes) break;
      Grow(out, max_bytes);
    }
    stream.next_out = reinterpret_cast<uint8_t*>(out.data() + used);
    stream.avail_out = out.size() - used;
    code = lzma_code(&stream, LZMA_FINISH);
    used = out.size() - stream.avail_out;
  }
  lzma_end(&stream);

  if (used > max_bytes) return TooLong(max_bytes);
  if (code == LZMA_MEMLIMIT_ERROR || code == LZMA_MEM_ERROR) {
    return absl::ResourceExhaustedError("xz data need too much memory");
  }
  if (code == LZMA_BUF_ERROR) return absl::InvalidArgumentError("xz data end too early");
  if (code != LZMA_STREAM_END) return absl::InvalidArgumentError("xz data are damaged");
  out.resize(used);
  return out;
}

}  // namespace

Compression DetectCompression(std::string_view bytes) {
  if (bytes.starts_with("\x1f\x8b")) return Compression::kGzip;
  if (bytes.starts_with("\xfd"
                        "7zXZ")) {
    return Compression::kXz;
  }
  return Compression::kNone;
}

absl::StatusOr<std::string> Decompress(std::string_view bytes, Compression compression,
                                       size_t max_bytes) {
  switch (compression) {
    case Compression::kGzip:
      return Gunzip(bytes, max_bytes);
    case Compression::kXz:
      return Unxz(bytes, max_bytes);
    case Compression::kNone:
      break;
  }
  return std::string(bytes);
}

}  // namespace traverse
