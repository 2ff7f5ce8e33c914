#include "client/gcode/text/lexer.h"

#include <cstring>
#include <optional>

#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

constexpr int kMaxCommandNumber = 99999;

bool IsBlank(char c) { return c == ' ' || c == '\t'; }
bool IsLetter(char c) { return c >= 'A' && c <= 'Z'; }

bool IsNumberPart(char c) { return IsDigit(c) || c == '.' || c == '-' || c == '+'; }

const char* SkipBlanks(const char* p, const char* end) {
  while (p < end && IsBlank(*p)) ++p;
  return p;
}

// Reads words up to `end` or a semicolon. Returns where it stopped; null if a word is unreadable.
const char* ScanWords(const char* p, const char* end, Command& command) {
  command.words = 0;
  for (;;) {
    p = SkipBlanks(p, end);
    if (p == end || *p == ';') return p;
    const char letter = Capital(*p++);
    if (!IsLetter(letter) || command.Has(letter)) return nullptr;
    p = SkipBlanks(p, end);
    Decimal value = 0;
    if (p < end && IsNumberPart(*p)) {
      const std::optional<Decimal> number = ParseDecimal(&p, end);
      if (!number) return nullptr;
      value = *number;
    }
    command.words |= Command::Bit(letter);
    command.values[letter - 'A'] = value;
  }
}

bool HasCoordinates(const Command& command) {
  return command.letter == 'G' && (command.number <= 3 || command.number == 92);
}

}  // namespace

void LexLine(std::string_view text, Command& command) {
  const char* const end = text.data() + text.size();
  const char* p = SkipBlanks(text.data(), end);
  command.words = 0;
  command.rest = {};
  command.comment = {};
  if (p == end) {
    command.kind = LineKind::kBlank;
    return;
  }
  if (*p == ';') {
    command.kind = LineKind::kComment;
    command.comment = std::string_view(p, static_cast<size_t>(end - p));
    return;
  }
  command.kind = LineKind::kText;
  command.letter = Capital(*p++);
  if (command.letter != 'G' && command.letter != 'M' && command.letter != 'T') return;
  if (p == end || !IsDigit(*p)) return;
  command.number = 0;
  for (; p < end && IsDigit(*p); ++p) {
    command.number = command.number * 10 + (*p - '0');
    if (command.number > kMaxCommandNumber) return;
  }
  if (p < end && (*p == '.' || *p == '_')) return;  // G92.1, M862.3: commands of their own

  const char* const rest = p;
  const char* stop;
  if (HasCoordinates(command)) {
    stop = ScanWords(p, end, command);
    if (stop == nullptr) return;
  } else {
    const void* const semicolon = std::memchr(p, ';', static_cast<size_t>(end - p));
    stop = semicolon == nullptr ? end : static_cast<const char*>(semicolon);
  }
  command.kind = LineKind::kCommand;
  command.rest = std::string_view(rest, static_cast<size_t>(stop - rest));
  command.comment = std::string_view(stop, static_cast<size_t>(end - stop));
}

bool ReadWords(Command& command) {
  const char* const begin = command.rest.data();
  const char* const end = begin + command.rest.size();
  if (ScanWords(begin, end, command) == end) return true;
  command.words = 0;
  return false;
}

bool WordCursor::Next() {
  const char* const end = line_.data() + line_.size();
  const char* p = SkipBlanks(line_.data() + value_end_, end);
  if (p == end || *p == ';') return false;
  letter_ = Capital(*p++);
  p = SkipBlanks(p, end);
  value_begin_ = static_cast<size_t>(p - line_.data());
  while (p < end && IsNumberPart(*p)) ++p;
  value_end_ = static_cast<size_t>(p - line_.data());
  return true;
}

}  // namespace traverse::gcode
