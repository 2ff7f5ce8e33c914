#include "client/containers/bgcode/heatshrink.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"

namespace traverse::containers {
namespace {

constexpr size_t kLiteralBits = 9;

class BitWriter {
 public:
  explicit BitWriter(std::string& out) : out_(out) {}

  void Put(uint32_t value, int bits) {
    held_ = held_ << bits | value;
    count_ += bits;
    while (count_ >= 8) {
      count_ -= 8;
      out_.push_back(static_cast<char>(held_ >> count_ & 0xff));
    }
  }

  void Finish() {
    if (count_ > 0) Put(0, 8 - count_);
  }

 private:
  std::string& out_;
  uint64_t held_ = 0;
  int count_ = 0;
};

class BitReader {
 public:
  explicit BitReader(std::string_view bytes) : bytes_(bytes) {}

  size_t Left() const { return static_cast<size_t>(count_) + 8 * (bytes_.size() - next_); }
  size_t BytesUsed() const { return next_ - static_cast<size_t>(count_) / 8; }

  // REQUIRES: bits <= Left(), bits <= 32.
  uint32_t Take(int bits) {
    while (count_ < bits) {
      held_ = held_ << 8 | static_cast<uint8_t>(bytes_[next_++]);
      count_ += 8;
    }
    count_ -= bits;
    return static_cast<uint32_t>(held_ >> count_ & ((uint64_t{1} << bits) - 1));
  }

 private:
  std::string_view bytes_;
  size_t next_ = 0;
  uint64_t held_ = 0;
  int count_ = 0;
};

struct Match {
  size_t length = 0;
  size_t distance = 0;
};

// Finds earlier occurrences by hash chains of three bytes.
class Matcher {
 public:
  Matcher(std::string_view bytes, HeatshrinkWindow window)
      : bytes_(bytes),
        reach_(size_t{1} << window.window_bits),
        longest_(size_t{1} << window.lookahead_bits),
        heads_(kHeads, kNone),
        before_(reach_, kNone) {}

  // The longest earlier occurrence of the text at `at` that a few tries find.
  Match Find(size_t at) const {
    Match best;
    if (at + kHashed > bytes_.size()) return best;
    const size_t longest = std::min(longest_, bytes_.size() - at);
    constexpr int kTries = 12;
    uint32_t from = heads_[Hash(at)];
    for (int tries = 0; tries < kTries && from != kNone && at - from <= reach_; ++tries) {
      const size_t length = Common(from, at, longest);
      if (length > best.length) best = {length, at - from};
      if (length == longest) break;
      const uint32_t older = before_[from % reach_];
      if (older >= from) break;  // the ring has overwritten it
      from = older;
    }
    return best;
  }

  void Add(size_t at) {
    if (at + kHashed > bytes_.size()) return;
    uint32_t& head = heads_[Hash(at)];
    before_[at % reach_] = head;
    head = static_cast<uint32_t>(at);
  }

 private:
  static constexpr size_t kHashed = 3;
  static constexpr size_t kHeads = size_t{1} << 13;
  static constexpr uint32_t kNone = UINT32_MAX;

  size_t Hash(size_t at) const {
    const auto byte = [&](size_t i) { return uint32_t{static_cast<uint8_t>(bytes_[at + i])}; };
    return (byte(0) << 16 | byte(1) << 8 | byte(2)) * 2654435761u >> (32 - 13);
  }

  size_t Common(size_t a, size_t b, size_t longest) const {
    size_t length = 0;
    while (length < longest && bytes_[a + length] == bytes_[b + length]) ++length;
    return length;
  }

  std::string_view bytes_;
  size_t reach_;
  size_t longest_;
  std::vector<uint32_t> heads_;
  std::vector<uint32_t> before_;  // before_[i % reach_]: the position of the same hash before i
};

// Appends `length` bytes from `distance` back; zeros for positions before the beginning.
void Repeat(std::string& out, size_t& used, size_t distance, size_t length) {
  char* to = out.data() + used;
  used += length;
  if (const size_t written = static_cast<size_t>(to - out.data()); distance > written) {
    const size_t zeros = std::min(length, distance - written);
    std::memset(to, 0, zeros);
    to += zeros;
    length -= zeros;
  }
  // Byte by byte: the repeat may overlap itself.
  for (const char* from = to - distance; length > 0; --length) *to++ = *from++;
}

}  // namespace

std::string HeatshrinkCompress(std::string_view bytes, HeatshrinkWindow window) {
  assert(window.window_bits >= 4 && window.window_bits <= 15);
  assert(window.lookahead_bits >= 3 && window.lookahead_bits < window.window_bits);
  assert(bytes.size() < UINT32_MAX);
  const size_t repeat_bits = static_cast<size_t>(1 + window.window_bits + window.lookahead_bits);
  std::string out;
  out.reserve(bytes.size() / 2);
  BitWriter bits(out);
  Matcher matcher(bytes, window);
  for (size_t at = 0; at < bytes.size();) {
    const Match match = matcher.Find(at);
    const bool repeats = match.length * kLiteralBits > repeat_bits;
    if (repeats) {
      bits.Put(0, 1);
      bits.Put(static_cast<uint32_t>(match.distance - 1), window.window_bits);
      bits.Put(static_cast<uint32_t>(match.length - 1), window.lookahead_bits);
    } else {
      bits.Put(0x100u | static_cast<uint8_t>(bytes[at]), kLiteralBits);
    }
    for (const size_t end = at + (repeats ? match.length : 1); at < end; ++at) matcher.Add(at);
  }
  bits.Finish();
  return out;
}

absl::StatusOr<std::string> HeatshrinkDecompress(std::string_view bytes, HeatshrinkWindow window,
                                                 size_t size) {
  const size_t repeat_bits = static_cast<size_t>(1 + window.window_bits + window.lookahead_bits);
  const size_t longest = size_t{1} << window.lookahead_bits;
  // Checks before memory is allocated: so few bytes cannot expand to so many.
  if (size > (bytes.size() * 8 / repeat_bits + 1) * longest) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%d bytes of heatshrink cannot be %d bytes", bytes.size(), size));
  }
  std::string out(size, '\0');
  BitReader bits(bytes);
  const auto ends = [] { return absl::InvalidArgumentError("heatshrink data end too early"); };
  for (size_t used = 0; used < size;) {
    if (bits.Left() < kLiteralBits) return ends();
    if (bits.Take(1) == 1) {
      out[used++] = static_cast<char>(bits.Take(8));
      continue;
    }
    if (bits.Left() + 1 < repeat_bits) return ends();
    const size_t distance = bits.Take(window.window_bits) + 1;
    const size_t length = bits.Take(window.lookahead_bits) + 1;
    if (length > size - used) {
      return absl::InvalidArgumentError("heatshrink data continue after their end");
    }
    Repeat(out, used, distance, length);
  }
  if (bits.BytesUsed() != bytes.size() && bits.BytesUsed() + 1 != bytes.size()) {
    return absl::InvalidArgumentError("heatshrink data continue after their end");
  }
  return out;
}

}  // namespace traverse::containers
