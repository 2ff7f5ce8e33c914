#include "client/cli/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "client/report/compare.h"

namespace traverse::cli {
namespace {

// Whether the user's locale uses UTF-8, by POSIX's rules.
bool SpeaksUtf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string_view locale = value;
    return locale.find("UTF-8") != locale.npos || locale.find("utf8") != locale.npos;
  }
  return false;
}

}  // namespace

bool IsTerminal(std::FILE* file) {
  const char* term = std::getenv("TERM");
  return isatty(fileno(file)) == 1 && (term == nullptr || std::string_view(term) != "dumb");
}

bool MayColor(std::FILE* file) {
  const char* no_color = std::getenv("NO_COLOR");
  return IsTerminal(file) && (no_color == nullptr || *no_color == '\0');
}

int TerminalWidth(std::FILE* file) {
  constexpr int kUnknown = 80;
  winsize size{};
  if (ioctl(fileno(file), TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUnknown;
  return size.ws_col;
}

report::TextStyle StyleFor(std::FILE* file) {
  report::TextStyle style;
  style.width = IsTerminal(file) ? TerminalWidth(file) : report::kPageWidth;
  style.color = MayColor(file);
  style.blocks = SpeaksUtf8();
  return style;
}

void Print(std::FILE* file, const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), file);
}

}  // namespace traverse::cli
