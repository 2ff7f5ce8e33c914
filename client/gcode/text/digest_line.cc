#include "client/gcode/text/digest_line.h"

#include <cassert>
#include <optional>

#include "client/files/md5.h"
#include "client/gcode/text/lexer.h"

namespace traverse::gcode {
namespace {

constexpr std::string_view kMark = "; MD5:";

std::string_view FirstLine(std::string_view text) { return LineAt(text, 0).Raw(text); }

}  // namespace

bool StatesItsDigest(std::string_view text) {
  if (!text.starts_with(kMark)) return false;
  const std::string_view line = FirstLine(text);
  const std::optional<std::string> stated = FindMd5(line);
  return stated && *stated == Md5Hex(text.substr(line.size()));
}

void RenewDigest(std::string& text) {
  const std::string_view line = FirstLine(text);
  assert(line.starts_with(kMark) && FindMd5(line));
  text.replace(0, line.size(), WithMd5(line, Md5Hex(std::string_view(text).substr(line.size()))));
}

}  // namespace traverse::gcode
