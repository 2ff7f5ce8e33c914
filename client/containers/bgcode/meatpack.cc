#include "client/containers/bgcode/meatpack.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <iterator>

#include "absl/strings/str_format.h"

namespace traverse::containers {
namespace {

constexpr char kSignal = '\xff';
constexpr uint8_t kPackingOn = 251;
constexpr uint8_t kPackingOff = 250;
constexpr uint8_t kReset = 249;
constexpr uint8_t kQuery = 248;
constexpr uint8_t kNoSpacesOn = 247;
constexpr uint8_t kNoSpacesOff = 246;

constexpr uint8_t kOwnByte = 15;
constexpr std::string_view kCharacters = "0123456789. \nGX";
constexpr std::string_view kWithoutSpaces = "0123456789.E\nGX";

constexpr std::array<uint8_t, 256> MakeCodes() {
  std::array<uint8_t, 256> codes{};
  for (uint8_t& code : codes) code = kOwnByte;
  for (size_t i = 0; i < kWithoutSpaces.size(); ++i) {
    codes[static_cast<uint8_t>(kWithoutSpaces[i])] = static_cast<uint8_t>(i);
  }
  return codes;
}
constexpr std::array<uint8_t, 256> kCodes = MakeCodes();

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsLetter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

// The part of a line that is written without spaces: the words of a line of G. A line with a
// checksum has no such part, because the checksum counts the spaces.
std::string_view SpacelessPart(std::string_view line) {
  if (line.size() < 2 || line[0] != 'G' || !IsDigit(line[1])) return {};
  const std::string_view part = line.substr(0, line.find(';'));
  if (part.find('*') != std::string_view::npos || part.find('"') != std::string_view::npos) {
    return {};
  }
  return part.substr(0, part.find_last_not_of(" \t\r\n") + 1);
}

void Command(uint8_t command, std::string& out) {
  out.push_back(kSignal);
  out.push_back(kSignal);
  out.push_back(static_cast<char>(command));
}

void AppendPair(char first, char second, std::string& out) {
  const uint8_t low = kCodes[static_cast<uint8_t>(first)];
  const uint8_t high = kCodes[static_cast<uint8_t>(second)];
  out.push_back(static_cast<char>(high << 4 | low));
  if (low == kOwnByte) out.push_back(first);
  if (high == kOwnByte) out.push_back(second);
}

// Packs a whole line with its end.
class LinePacker {
 public:
  explicit LinePacker(std::string& out) : out_(out) {}

  void Put(std::string_view text) {
    for (const char c : text) Put(c);
  }
  void PutWithoutSpaces(std::string_view text) {
    for (const char c : text) {
      if (c != ' ') Put(c);
    }
  }
  // A line end that is alone in its byte is written twice.
  void Finish() {
    if (held_) AppendPair(first_, '\n', out_);
    held_ = false;
  }

 private:
  void Put(char c) {
    if (held_) {
      AppendPair(first_, c, out_);
    } else {
      first_ = c;
    }
    held_ = !held_;
  }

  std::string& out_;
  char first_ = 0;
  bool held_ = false;
};

// Puts spaces before the letters of the line of G that begins at `begin` and ends `text`.
void PutSpacesBack(std::string& text, size_t begin) {
  const std::string_view part = SpacelessPart(std::string_view(text).substr(begin));
  if (part.empty() || part.find(' ') != std::string_view::npos) return;
  const auto letters = static_cast<size_t>(std::count_if(part.begin() + 1, part.end(), IsLetter));
  if (letters == 0) return;
  size_t from = text.size();
  text.resize(text.size() + letters);
  const size_t end = begin + part.size();
  // Works from the end: the text of a comment moves unchanged.
  for (size_t to = text.size(); to > from;) {
    const char c = text[--from];
    text[--to] = c;
    if (from < end && from > begin && IsLetter(c)) text[--to] = ' ';
  }
}

class Unpacker {
 public:
  Unpacker(std::string_view packed, size_t max_bytes, std::string& out)
      : packed_(packed), max_bytes_(max_bytes), out_(out), line_(out.size()) {}

  absl::Status Run() {
    while (next_ < packed_.size()) {
      absl::Status status;
      if (IsCommand()) {
        status = DoCommand();
      } else if (packing_) {
        status = DoPair();
      } else {
        Put(packed_[next_++]);
      }
      if (!status.ok()) return status;
      if (out_.size() > max_bytes_) return absl::ResourceExhaustedError("too much text");
    }
    PutSpacesBack(out_, line_);
    return absl::OkStatus();
  }

 private:
  bool IsCommand() const {
    return packed_[next_] == kSignal && next_ + 1 < packed_.size() && packed_[next_ + 1] == kSignal;
  }

  absl::Status DoCommand() {
    if (next_ + 2 >= packed_.size()) return EndsEarly();
    const auto command = static_cast<uint8_t>(packed_[next_ + 2]);
    next_ += 3;
    switch (command) {
      case kPackingOn:
        packing_ = true;
        break;
      case kPackingOff:
        packing_ = false;
        break;
      case kReset:
        packing_ = false;
        characters_ = kCharacters;
        break;
      case kNoSpacesOn:
        characters_ = kWithoutSpaces;
        break;
      case kNoSpacesOff:
        characters_ = kCharacters;
        break;
      case kQuery:
        break;
      default:
        return absl::InvalidArgumentError(
            absl::StrFormat("MeatPack command %d is unknown", command));
    }
    return absl::OkStatus();
  }

  absl::Status DoPair() {
    const auto pair = static_cast<uint8_t>(packed_[next_++]);
    const uint8_t low = pair & 15;
    const uint8_t high = pair >> 4;
    if (!PutCode(low)) return EndsEarly();
    if (low != kOwnByte && characters_[low] == '\n') return absl::OkStatus();
    return PutCode(high) ? absl::OkStatus() : EndsEarly();
  }

  bool PutCode(uint8_t code) {
    if (code != kOwnByte) {
      Put(characters_[code]);
      return true;
    }
    if (next_ >= packed_.size()) return false;
    Put(packed_[next_++]);
    return true;
  }

  void Put(char c) {
    if (c == '\n') PutSpacesBack(out_, line_);
    out_.push_back(c);
    if (c == '\n') line_ = out_.size();
  }

  static absl::Status EndsEarly() {
    return absl::InvalidArgumentError("MeatPack data end too early");
  }

  std::string_view packed_;
  size_t max_bytes_;
  std::string& out_;
  size_t line_;  // where the last line of out_ begins
  size_t next_ = 0;
  bool packing_ = false;
  std::string_view characters_ = kCharacters;
};

// The next line of `text`, with its end, which is cut off.
std::string_view TakeLine(std::string_view& text) {
  const size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end == std::string_view::npos ? end : end + 1);
  text.remove_prefix(line.size());
  return line;
}

bool EqualLines(std::string_view a, std::string_view b) {
  if (a == b) return true;
  std::string_view part_a = SpacelessPart(a);
  std::string_view part_b = SpacelessPart(b);
  if (part_a.empty() || a.substr(part_a.size()) != b.substr(part_b.size())) return false;
  size_t j = 0;
  for (const char c : part_a) {
    if (c == ' ') continue;
    while (j < part_b.size() && part_b[j] == ' ') ++j;
    if (j == part_b.size() || part_b[j++] != c) return false;
  }
  while (j < part_b.size() && part_b[j] == ' ') ++j;
  return j == part_b.size();
}

}  // namespace

bool CanMeatPack(std::string_view text) { return text.find(kSignal) == std::string_view::npos; }

void MeatPack(std::string_view text, std::string& out) {
  assert(CanMeatPack(text));
  Command(kPackingOn, out);
  Command(kNoSpacesOn, out);
  bool packing = true;
  LinePacker packer(out);
  while (!text.empty()) {
    const std::string_view line = TakeLine(text);
    const bool as_it_is = line.front() == ';' || line.back() != '\n';
    if (packing == as_it_is) Command(packing ? kPackingOff : kPackingOn, out);
    packing = !as_it_is;
    const std::string_view spaceless = SpacelessPart(line);
    if (as_it_is) {
      out.append(line);
    } else {
      packer.PutWithoutSpaces(spaceless);
      packer.Put(line.substr(spaceless.size()));
      packer.Finish();
    }
  }
}

absl::Status MeatUnpack(std::string_view packed, size_t max_bytes, std::string& out) {
  return Unpacker(packed, max_bytes, out).Run();
}

void AppendAsUnpacked(std::string_view line, std::string& out) {
  const size_t begin = out.size();
  const std::string_view spaceless = SpacelessPart(line);
  std::copy_if(spaceless.begin(), spaceless.end(), std::back_inserter(out),
               [](char c) { return c != ' '; });
  out += line.substr(spaceless.size());
  PutSpacesBack(out, begin);
}

bool EqualToAPrinter(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    const std::string_view line_a = TakeLine(a);
    const std::string_view line_b = TakeLine(b);
    if (!EqualLines(line_a, line_b)) return false;
  }
  return a.empty() && b.empty();
}

}  // namespace traverse::containers
