#include "client/gcode/text/line_numbers.h"

#include <algorithm>
#include <charconv>

#include "absl/strings/str_cat.h"
#include "client/gcode/text/decimal.h"

namespace traverse::gcode {
namespace {

// Larger numbers are invalid, so sums of them stay far below overflow.
constexpr int64_t kMaxNumber = 1'000'000'000;

// A line taken apart: number, blanks, command, blanks, checksum, rest.
struct NumberedLine {
  std::optional<int64_t> number;
  std::string_view blanks;
  std::string_view command;
  std::string_view blanks_behind;
  bool checksum = false;
  std::string_view rest;  // after the checksum: blanks and a comment
};

bool IsCommand(std::string_view line) {
  const size_t first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] != ';';
}

// Where the blanks and the comment at the end of `line` begin.
size_t EndOfCode(std::string_view line) {
  return line.substr(0, line.find(';')).find_last_not_of(" \t") + 1;
}

// The position of the checksum that ends at `end`; npos if there is none.
size_t ChecksumBefore(std::string_view line, size_t end) {
  const size_t last = line.substr(0, end).find_last_not_of("0123456789");
  const bool found = last != std::string_view::npos && line[last] == '*' && last + 1 < end;
  return found ? last : std::string_view::npos;
}

NumberedLine TakeApart(std::string_view line) {
  NumberedLine parts;
  if (line.size() > 1 && line[0] == 'N' && IsDigit(line[1])) {
    int64_t number = 0;
    const auto read = std::from_chars(line.data() + 1, line.data() + line.size(), number);
    if (read.ec == std::errc{} && number <= kMaxNumber) {
      parts.number = number;
      line.remove_prefix(static_cast<size_t>(read.ptr - line.data()));
      parts.blanks = line.substr(0, line.find_first_not_of(' '));
      line.remove_prefix(parts.blanks.size());
    }
  }
  parts.command = line;
  for (const size_t end : {EndOfCode(line), line.size()}) {
    const size_t at = ChecksumBefore(line, end);
    if (at == std::string_view::npos) continue;
    parts.checksum = true;
    const size_t command_end = line.substr(0, at).find_last_not_of(" \t") + 1;
    parts.command = line.substr(0, command_end);
    parts.blanks_behind = line.substr(command_end, at - command_end);
    parts.rest = line.substr(end);
    break;
  }
  return parts;
}

// Appends `text` to `out`, but for its commands that are to be numbered: of each of these
// append(line without its end) what is to stand there.
template <typename Append>
void AppendLines(std::string_view text, const LineNumbers& numbers, std::string& out,
                 Append append) {
  size_t commands = 0;
  for (Offset next = 0; next < text.size();) {
    const Line line = LineAt(text, next);
    next = line.next;
    const std::string_view content = line.Text(text);
    if (IsCommand(content) && commands++ >= numbers.commands_before) {
      append(content);
      out.append(text.substr(line.end, line.next - line.end));
    } else {
      out.append(line.Raw(text));
    }
  }
}

// Whether the line shows on which side of a comment checksums stand.
bool TakesComment(const NumberedLine& parts, LineNumbers& numbers) {
  if (!parts.checksum) return false;
  if (parts.command.find(';') != std::string_view::npos) numbers.behind_comments = true;
  return numbers.behind_comments || !parts.rest.empty();
}

}  // namespace

std::optional<LineNumbers> LearnLineNumbers(std::string_view text) {
  // Most files have none: this test is quick, while the next step looks at each line.
  if ((text.empty() || text[0] != 'N') && text.find("\nN") == std::string_view::npos) {
    return std::nullopt;
  }
  LineNumbers numbers;
  bool any = false;
  bool stepped = false;
  for (Offset next = 0; next < text.size();) {
    const Line line = LineAt(text, next);
    next = line.next;
    const std::string_view content = line.Text(text);
    if (!IsCommand(content)) continue;
    const NumberedLine parts = TakeApart(content);
    if (any) {
      if (!stepped && parts.number) numbers.step = *parts.number - numbers.first;
      stepped = true;
      if (!numbers.checksums || TakesComment(parts, numbers)) break;
      continue;
    }
    if (!parts.number) {
      ++numbers.commands_before;
      continue;
    }
    any = true;
    numbers.first = *parts.number;
    numbers.blanks = std::string(parts.blanks);
    numbers.blanks_behind = std::string(parts.blanks_behind);
    numbers.checksums = parts.checksum;
    TakesComment(parts, numbers);
  }
  if (!any) return std::nullopt;
  return numbers;
}

std::string WithoutLineNumbers(std::string_view text, const LineNumbers& numbers) {
  std::string out;
  out.reserve(text.size());
  AppendLines(text, numbers, out, [&](std::string_view content) {
    const NumberedLine parts = TakeApart(content);
    if (numbers.checksums && parts.checksum) {
      out.append(parts.command);
      out.append(parts.rest);
    } else {  // what looks like a checksum is part of the command
      out.append(content.substr(static_cast<size_t>(parts.command.data() - content.data())));
    }
  });
  return out;
}

std::string WithLineNumbers(std::string_view text, const LineNumbers& numbers) {
  constexpr size_t kBytesPerLine = 12;
  std::string out;
  out.reserve(text.size() + text.size() / 3 + kBytesPerLine);
  int64_t number = numbers.first;
  AppendLines(text, numbers, out, [&](std::string_view content) {
    const size_t begin = out.size();
    const size_t end = numbers.behind_comments ? content.size() : EndOfCode(content);
    absl::StrAppend(&out, "N", number, numbers.blanks);
    out.append(content.substr(0, end));
    number += numbers.step;
    if (numbers.checksums) {
      out += numbers.blanks_behind;
      unsigned char sum = 0;
      for (size_t i = begin; i < out.size(); ++i) sum ^= static_cast<unsigned char>(out[i]);
      absl::StrAppend(&out, "*", static_cast<int>(sum));
    }
    out.append(content.substr(end));
  });
  return out;
}

std::optional<Offset> FirstOtherLine(std::string_view text, std::string_view other) {
  const auto [at, other_at] = std::mismatch(text.begin(), text.end(), other.begin(), other.end());
  if (at == text.end() && other_at == other.end()) return std::nullopt;
  // The last line shows what follows the end of `text`.
  size_t place = static_cast<size_t>(at - text.begin());
  if (place == text.size() && place > 0) --place;
  return static_cast<Offset>(text.substr(0, place).rfind('\n') + 1);
}

}  // namespace traverse::gcode
