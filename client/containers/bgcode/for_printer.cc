#include "client/containers/bgcode/for_printer.h"

#include <algorithm>

#include "client/containers/bgcode/meatpack.h"
#include "client/gcode/verify/verifier.h"

namespace traverse::containers {
namespace {

constexpr std::string_view kBlank = " \t\r\n";

std::string_view Trimmed(std::string_view line) {
  const size_t begin = std::min(line.find_first_not_of(kBlank), line.size());
  line.remove_prefix(begin);
  return line.substr(0, line.find_last_not_of(kBlank) + 1);
}

// Calls visit(line) for each line, with its end.
template <typename Visit>
void ForEachLine(std::string_view text, Visit visit) {
  while (!text.empty()) {
    const size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end == text.npos ? end : end + 1);
    visit(line);
    text.remove_prefix(line.size());
  }
}

// The stretch of `text` from the first command to the last one.
std::string_view Commands(std::string_view text) {
  size_t begin = text.size();
  size_t end = 0;
  ForEachLine(text, [&](std::string_view line) {
    const std::string_view content = Trimmed(line);
    if (content.empty() || content[0] == ';') return;
    const auto at = static_cast<size_t>(line.data() - text.data());
    begin = std::min(begin, at);
    end = at + line.size();
  });
  return text.substr(std::min(begin, end), end - std::min(begin, end));
}

bool IsKept(std::string_view comment, bool among_commands, CommentsKept kept) {
  if (comment.starts_with(kOptimisedMark)) return true;
  if (!among_commands || kept == CommentsKept::kNone) return false;
  const bool is_entry = comment.starts_with("; ") && comment.find(" = ") != comment.npos;
  if (is_entry) return false;
  return kept == CommentsKept::kAll || !Trimmed(comment.substr(1)).empty();
}

}  // namespace

std::string ForPrinter(std::string_view text, CommentsKept kept) {
  const std::string_view commands = Commands(text);
  std::string out;
  out.reserve(text.size());
  ForEachLine(text, [&](std::string_view line) {
    const std::string_view content = Trimmed(line);
    const bool among =
        line.data() >= commands.data() && line.data() < commands.data() + commands.size();
    if (content.starts_with(';')) {
      if (IsKept(content, among, kept)) out += content;
    } else if (kept == CommentsKept::kAll) {
      AppendAsUnpacked(content, out);
    } else {
      AppendAsUnpacked(Trimmed(content.substr(0, content.find(';'))), out);
    }
    out += '\n';
  });
  return out;
}

}  // namespace traverse::containers
