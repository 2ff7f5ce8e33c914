// Characters and digests for the verifier, which shares none of this with the reader.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_TEXT_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_TEXT_H_

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace traverse::gcode {

// True if `text` begins with one of `marks`.
template <typename Marks>
bool BeginsWithAny(std::string_view text, const Marks& marks) {
  return std::ranges::any_of(marks,
                             [text](std::string_view mark) { return text.starts_with(mark); });
}

// The byte order mark of UTF-8, with which some editors begin a text.
inline constexpr std::string_view kMarkOfUtf8 = "\xEF\xBB\xBF";

// Without blanks, tabs and carriage returns at both ends.
inline std::string_view TrimLine(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) {
    text.remove_suffix(1);
  }
  return text;
}

// Takes the first line off `text`, and what ends it: `end`.
inline std::string_view TakeLine(std::string_view& text, std::string_view end = "\n") {
  const std::string_view line = text.substr(0, text.find(end));
  text.remove_prefix(std::min(line.size() + end.size(), text.size()));
  return line;
}

inline char UpperCase(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; }

// `with` is in capitals, `text` in any case.
inline bool BeginsInAnyCase(std::string_view text, std::string_view with) {
  return text.size() >= with.size() &&
         std::equal(with.begin(), with.end(), text.begin(),
                    [](char capital, char c) { return capital == UpperCase(c); });
}

inline bool EqualsInAnyCase(std::string_view text, std::string_view capitals) {
  return text.size() == capitals.size() && BeginsInAnyCase(text, capitals);
}

// Mixes `value` into `digest`.
inline uint64_t Mix(uint64_t digest, uint64_t value) {
  uint64_t z = (digest ^ value) + 0x9e3779b97f4a7c15u + (digest << 6) + (digest >> 2);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// Mixes several of them into it, one after the other.
template <typename... Values>
uint64_t MixAll(uint64_t digest, Values... values) {
  ((digest = Mix(digest, static_cast<uint64_t>(values))), ...);
  return digest;
}

inline uint64_t DigestOf(std::string_view text) {
  uint64_t digest = 0xcbf29ce484222325u;
  for (const char c : text) digest = (digest ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return Mix(digest, text.size());
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_TEXT_H_
