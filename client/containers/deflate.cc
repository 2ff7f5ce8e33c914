#include "client/containers/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/gcode/parallel.h"

namespace traverse::containers {
namespace {

constexpr size_t kPieceBytes = size_t{1} << 20;
constexpr size_t kWindowBytes = size_t{32} << 10;
constexpr int kMemoryLevel = 8;

// zlib's interface predates const; it does not write to its input.
Bytef* Input(std::string_view bytes) {
  return reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
}

// Deflates the piece that begins at `begin` as a continuation of the same stream, up to a byte
// boundary; the last piece ends the stream. Empty if memory runs out.
std::string DeflatePiece(std::string_view bytes, size_t begin, int level) {
  const std::string_view piece = bytes.substr(begin, kPieceBytes);
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, -MAX_WBITS, kMemoryLevel, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    return {};
  }
  const size_t known = std::min(begin, kWindowBytes);
  if (known > 0) {
    deflateSetDictionary(&stream, Input(bytes.substr(begin - known)), static_cast<uInt>(known));
  }
  // A flush adds a few bytes to the bound of the piece itself.
  constexpr size_t kFlushBytes = 16;
  std::string out(deflateBound(&stream, static_cast<uLong>(piece.size())) + kFlushBytes, '\0');
  stream.next_in = Input(piece);
  stream.avail_in = static_cast<uInt>(piece.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, begin + piece.size() == bytes.size() ? Z_FINISH : Z_SYNC_FLUSH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

uint32_t Adler32(std::string_view bytes) {
  return static_cast<uint32_t>(adler32_z(adler32_z(0, nullptr, 0), Input(bytes), bytes.size()));
}

}  // namespace

absl::StatusOr<std::string> Inflate(std::string_view bytes, DeflateForm form, size_t size) {
  if (size > bytes.size() * kMaxDeflateRatio || bytes.size() > std::numeric_limits<uInt>::max() ||
      size >= std::numeric_limits<uInt>::max()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%d deflated bytes cannot be %d bytes", bytes.size(), size));
  }
  z_stream stream{};
  if (inflateInit2(&stream, form == DeflateForm::kRaw ? -MAX_WBITS : MAX_WBITS) != Z_OK) {
    return absl::ResourceExhaustedError("no memory to inflate");
  }
  // One byte more than expected, to notice data that goes on.
  std::string out(size + 1, '\0');
  stream.next_in = Input(bytes);
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int code = inflate(&stream, Z_FINISH);
  const size_t made = stream.total_out;
  const size_t unused = stream.avail_in;
  inflateEnd(&stream);
  if (made > size) {
    return absl::InvalidArgumentError(
        absl::StrFormat("deflated data have more than the %d bytes stated", size));
  }
  if (code == Z_BUF_ERROR) return absl::InvalidArgumentError("deflated data end too early");
  if (code != Z_STREAM_END) return absl::InvalidArgumentError("deflated data are damaged");
  if (made < size) {
    return absl::InvalidArgumentError(
        absl::StrFormat("deflated data have %d bytes, but the file states %d", made, size));
  }
  if (unused > 0) return absl::InvalidArgumentError("deflated data continue after their end");
  out.resize(size);
  return out;
}

absl::Status InflateInPieces(std::string_view bytes, DeflateForm form, size_t size,
                             const std::function<void(std::string_view)>& sink) {
  if (bytes.size() > std::numeric_limits<uInt>::max()) {
    return absl::InvalidArgumentError("more than 4 GiB of deflated data");
  }
  z_stream stream{};
  if (inflateInit2(&stream, form == DeflateForm::kRaw ? -MAX_WBITS : MAX_WBITS) != Z_OK) {
    return absl::ResourceExhaustedError("no memory to inflate");
  }
  std::string piece(kWindowBytes, '\0');
  stream.next_in = Input(bytes);
  stream.avail_in = static_cast<uInt>(bytes.size());
  int code = Z_OK;
  while (code == Z_OK && stream.total_out <= size) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    code = inflate(&stream, Z_NO_FLUSH);
    sink(std::string_view(piece).substr(0, piece.size() - stream.avail_out));
  }
  const size_t made = stream.total_out;
  inflateEnd(&stream);
  if (code == Z_STREAM_END && made == size) return absl::OkStatus();
  return absl::InvalidArgumentError("deflated data are damaged, or not as long as stated");
}

absl::StatusOr<std::string> Deflate(std::string_view bytes, DeflateForm form, int level,
                                    int threads) {
  const size_t count = std::max<size_t>(1, (bytes.size() + kPieceBytes - 1) / kPieceBytes);
  std::vector<std::string> pieces(count);
  gcode::ParallelFor(count, threads,
                     [&](size_t i) { pieces[i] = DeflatePiece(bytes, i * kPieceBytes, level); });
  std::string out;
  if (form == DeflateForm::kZlib) out = "\x78\x9c";
  for (std::string& piece : pieces) {
    if (piece.empty()) return absl::ResourceExhaustedError("no memory to deflate");
    out += piece;
    piece = {};
  }
  if (form == DeflateForm::kZlib) {
    const uint32_t check = Adler32(bytes);
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(check >> shift));
  }
  return out;
}

uint32_t Crc32(std::string_view bytes) {
  return static_cast<uint32_t>(crc32_z(crc32_z(0, nullptr, 0), Input(bytes), bytes.size()));
}

}  // namespace traverse::containers
