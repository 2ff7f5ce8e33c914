#include "client/files/decompress.h"

#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"

namespace traverse {
namespace {

constexpr size_t kFirstBuffer = size_t{1} << 16;

// For the dictionary and the rest of an xz stream; `xz -9` needs 65 MiB, and `xz` 9.
constexpr uint64_t kMostXzMemory = uint64_t{66} << 20;
constexpr uint64_t kLittleXzMemory = uint64_t{10} << 20;

constexpr size_t kGzipMemory = size_t{64} << 10;

// The output: kept, or passed on.
class Output {
 public:
  using Sink = std::function<void(std::string_view)>;

  // Keeps the output in `kept`; passes it to `sink` if that is null.
  Output(std::string* kept, size_t max_bytes, Sink sink = {})
      : kept_(kept), max_bytes_(max_bytes), sink_(std::move(sink)) {}

  size_t size() const { return size_; }
  bool too_long() const { return size_ > max_bytes_; }

  // Room for the next bytes. Kept output doubles its room, up to one byte beyond the limit, which
  // tells a result of exactly that length from a longer one.
  std::span<char> Room() {
    if (kept_ == nullptr) {
      if (scratch_.empty()) scratch_.resize(kFirstBuffer);
      return scratch_;
    }
    if (size_ == kept_->size()) {
      kept_->resize(std::min(std::max(kept_->size() * 2, kFirstBuffer), max_bytes_ + 1));
    }
    return {kept_->data() + size_, kept_->size() - size_};
  }

  // Adds `bytes` bytes that were written into the room.
  void Add(size_t bytes) {
    if (kept_ == nullptr) sink_(std::string_view(scratch_).substr(0, bytes));
    size_ += bytes;
  }

  void Trim() {
    if (kept_ != nullptr) kept_->resize(size_);
  }

 private:
  std::string* kept_;
  std::string scratch_;
  const size_t max_bytes_;
  const Sink sink_;
  size_t size_ = 0;
};

absl::Status Gunzip(std::string_view bytes, Output& out) {
  z_stream stream{};
  if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) {
    return absl::ResourceExhaustedError("no memory to decompress");
  }
  size_t consumed = 0;
  int code = Z_OK;
  while (!out.too_long()) {
    // zlib counts in unsigned int: input and output go in pieces.
    constexpr size_t kPiece = std::numeric_limits<int>::max();
    const std::span<char> room = out.Room();
    const size_t in = std::min(bytes.size() - consumed, kPiece);
    const size_t space = std::min(room.size(), kPiece);
    // zlib's interface predates const; it does not write here.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + consumed));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(room.data());
    stream.avail_out = static_cast<uInt>(space);
    code = inflate(&stream, Z_NO_FLUSH);
    consumed += in - stream.avail_in;
    out.Add(space - stream.avail_out);
    if (code == Z_STREAM_END) {
      // Another member may follow; anything else after the last member is padding.
      if (DetectCompression(bytes.substr(consumed)) != Compression::kGzip) break;
      inflateReset(&stream);
    } else if (code != Z_OK && !(code == Z_BUF_ERROR && stream.avail_out == 0)) {
      break;
    }
  }
  inflateEnd(&stream);

  if (out.too_long()) return absl::OkStatus();  // the caller sees that it is too long
  if (code == Z_BUF_ERROR) return absl::InvalidArgumentError("gzip data end too early");
  if (code != Z_STREAM_END) return absl::InvalidArgumentError("gzip data are damaged");
  return absl::OkStatus();
}

// What reading takes, as the first block states; 0 if that cannot be read.
uint64_t XzMemory(std::string_view bytes) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, /*memlimit=*/1, 0) != LZMA_OK) return 0;
  uint8_t none = 0;
  stream.next_in = reinterpret_cast<const uint8_t*>(bytes.data());
  stream.avail_in = bytes.size();
  stream.next_out = &none;
  const lzma_ret code = lzma_code(&stream, LZMA_RUN);
  const uint64_t memory = code == LZMA_MEMLIMIT_ERROR ? lzma_memusage(&stream) : 0;
  lzma_end(&stream);
  return memory;
}

absl::Status Unxz(std::string_view bytes, Output& out) {
  lzma_stream stream = LZMA_STREAM_INIT;
  const uint64_t memory = std::clamp(XzMemory(bytes), kLittleXzMemory, kMostXzMemory);
  if (lzma_stream_decoder(&stream, memory, LZMA_CONCATENATED) != LZMA_OK) {
    return absl::ResourceExhaustedError("no memory to decompress");
  }
  stream.next_in = reinterpret_cast<const uint8_t*>(bytes.data());
  stream.avail_in = bytes.size();
  lzma_ret code = LZMA_OK;
  while (code == LZMA_OK && !out.too_long()) {
    const std::span<char> room = out.Room();
    stream.next_out = reinterpret_cast<uint8_t*>(room.data());
    stream.avail_out = room.size();
    code = lzma_code(&stream, LZMA_FINISH);
    out.Add(room.size() - stream.avail_out);
  }
  const uint64_t needed = code == LZMA_MEMLIMIT_ERROR ? lzma_memusage(&stream) : 0;
  lzma_end(&stream);

  if (out.too_long()) return absl::OkStatus();  // the caller sees that it is too long
  if (code == LZMA_MEMLIMIT_ERROR) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("xz data need %d MiB of memory to decompress, but only %d are allowed: "
                        "compress them with a smaller dictionary, as xz -9 does",
                        needed >> 20, memory >> 20));
  }
  if (code == LZMA_MEM_ERROR) return absl::ResourceExhaustedError("no memory to decompress");
  if (code == LZMA_BUF_ERROR) return absl::InvalidArgumentError("xz data end too early");
  if (code != LZMA_STREAM_END) return absl::InvalidArgumentError("xz data are damaged");
  return absl::OkStatus();
}

absl::Status DecompressTo(std::string_view bytes, Compression compression, size_t max_bytes,
                          Output& out) {
  const absl::Status status =
      compression == Compression::kGzip ? Gunzip(bytes, out) : Unxz(bytes, out);
  if (!out.too_long()) return status;
  return absl::ResourceExhaustedError(
      absl::StrFormat("more than %d MiB when decompressed", max_bytes >> 20));
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

size_t DecoderBytes(std::string_view bytes, Compression compression) {
  switch (compression) {
    case Compression::kNone:
      return 0;
    case Compression::kGzip:
      return kGzipMemory;
    case Compression::kXz:
      return std::clamp(XzMemory(bytes), kLittleXzMemory, kMostXzMemory);
  }
  return 0;
}

absl::StatusOr<std::string> Decompress(std::string_view bytes, Compression compression,
                                       size_t max_bytes) {
  if (compression == Compression::kNone) return std::string(bytes);
  std::string kept;
  Output out(&kept, max_bytes);
  const absl::Status status = DecompressTo(bytes, compression, max_bytes, out);
  if (!status.ok()) return status;
  out.Trim();
  return kept;
}

absl::Status DecompressInPieces(std::string_view bytes, Compression compression, size_t max_bytes,
                                const std::function<void(std::string_view)>& sink) {
  if (compression == Compression::kNone) {
    sink(bytes);
    return absl::OkStatus();
  }
  Output out(nullptr, max_bytes, sink);
  return DecompressTo(bytes, compression, max_bytes, out);
}

}  // namespace traverse
