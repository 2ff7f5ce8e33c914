#include "client/gcode/verify/line_numbers.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

#include "client/files/md5.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

std::optional<int64_t> NumberOf(std::string_view line, size_t& used) {
  if (!line.starts_with("N")) return std::nullopt;
  int64_t number = -1;
  const auto read = std::from_chars(line.data() + 1, line.data() + line.size(), number);
  if (read.ec != std::errc{} || number < 0 || number > int64_t{1} << 40) return std::nullopt;
  used = static_cast<size_t>(read.ptr - line.data());
  return number;
}

// Reads the lines of a text, and collects what remains of them.
class NumberReader {
 public:
  // False if the line, without its end, is not numbered as the others are.
  bool Take(std::string_view line) {
    const std::string_view code = TrimLine(line.substr(0, line.find(';')));
    if (code.empty()) {
      result_.text += line;
      return true;
    }
    size_t used = 0;
    const std::optional<int64_t> number = NumberOf(line, used);
    if (!number) {
      result_.text += line;
      ++unnumbered_;
      return count_ == 0;
    }
    if (count_ == 1) step_ = *number - last_;
    if (count_ == 0) first_ = *number;
    if (count_ > 1 && *number - last_ != step_) return false;
    last_ = *number;
    ++count_;
    return TakeRest(line, used);
  }

  void Copy(std::string_view text) { result_.text += text; }

  std::optional<Unnumbered> Result() {
    if (count_ == 0) return std::nullopt;
    result_.form = MixAll(0, first_, step_, unnumbered_, summed_);
    return std::move(result_);
  }

 private:
  // The text after the number, with or without a checksum after it or after its comment.
  bool TakeRest(std::string_view line, size_t begin) {
    const size_t star = line.rfind('*');
    int given = -1;
    size_t behind = line.size();
    if (star != std::string_view::npos) {
      const auto read = std::from_chars(line.data() + star + 1, line.data() + line.size(), given);
      behind = static_cast<size_t>(read.ptr - line.data());
    }
    const std::string_view rest = TrimLine(line.substr(behind));
    const bool has_sum = given >= 0 && (rest.empty() || rest[0] == ';');
    if (count_ == 1) summed_ = has_sum;
    if (summed_ && !has_sum) return false;
    if (!summed_) {
      result_.text += line.substr(begin);
      return true;
    }
    int sum = 0;
    for (const char c : line.substr(0, star)) sum ^= static_cast<unsigned char>(c);
    result_.text += line.substr(begin, star - begin);
    result_.text += line.substr(behind);
    return sum == given;
  }

  Unnumbered result_;
  int64_t first_ = 0;
  int64_t last_ = 0;
  int64_t step_ = 1;
  int64_t count_ = 0;
  int unnumbered_ = 0;
  bool summed_ = false;
};

}  // namespace

std::optional<Unnumbered> WithoutNumbers(std::string_view text) {
  if (!text.starts_with("N") && text.find("\nN") == std::string_view::npos) return std::nullopt;
  NumberReader reader;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    const size_t content = text.substr(0, end).find_last_not_of("\r\n") + 1;
    if (!reader.Take(text.substr(0, content))) return std::nullopt;
    reader.Copy(text.substr(content, end - content));
    text.remove_prefix(end);
  }
  return reader.Result();
}

bool HasRightMd5(std::string_view text) {
  constexpr std::string_view kBefore = "; MD5:";
  const size_t end = text.find('\n');
  if (!text.starts_with(kBefore) || end == std::string_view::npos) return false;
  const std::string_view stated = TrimLine(text.substr(kBefore.size(), end - kBefore.size()));
  const std::string is = Md5Hex(text.substr(end + 1));
  return !is.empty() && EqualsInAnyCase(stated, is);
}

}  // namespace traverse::gcode
