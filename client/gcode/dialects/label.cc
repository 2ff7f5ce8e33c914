#include "client/gcode/dialects/label.h"

#include "client/gcode/dialects/dialect.h"
#include "client/gcode/text/decimal.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

bool EqualsInAnyCase(std::string_view a, std::string_view b) {
  return a.size() == b.size() && StartsWithInAnyCase(a, b);
}

// `@OBJECT part.stl`, `@OBJECT none`; `@EXCLUDEREGION part`, `@ExcludeRegion end part`.
Label HostLabel(std::string_view line) {
  for (const std::string_view command : {"@OBJECT", "@EXCLUDEREGION"}) {
    if (!StartsWithInAnyCase(line, command)) continue;
    const std::string_view rest = line.substr(command.size());
    if (!rest.empty() && rest[0] != ' ' && rest[0] != '\t') continue;
    const std::string_view name = TrimBlanks(rest);
    const std::string_view word = name.substr(0, name.find_first_of(" \t"));
    for (const std::string_view none : {"", "none", "end", "stop", "off", "disable"}) {
      if (EqualsInAnyCase(word, none))
        return {LabelKind::kEnds, command, word.size() < name.size()};
    }
    return {LabelKind::kBegins, command, true};
  }
  return {};
}

// `M486 S3`, `M486 S-1`, `M486 Apart.stl`.
Label MarlinLabel(std::string_view line) {
  constexpr std::string_view kM486 = "M486";
  const std::string_view rest = line.substr(kM486.size());
  if (!rest.empty() && IsDigit(rest[0])) return {};
  const std::string_view words = TrimBlanks(rest);
  if (!StartsWithInAnyCase(words, "S")) return {LabelKind::kSays, kM486, false};
  const bool ends = TrimBlanks(words.substr(1)).starts_with("-");
  return {ends ? LabelKind::kEnds : LabelKind::kBegins, kM486, !ends};
}

}  // namespace

Label LabelOf(std::string_view line) {
  if (line.starts_with("@")) return HostLabel(line);
  if (StartsWithInAnyCase(line, "M486")) return MarlinLabel(line);
  const Mark* mark = MarkOf(line);
  if (mark == nullptr) return {};
  switch (mark->kind) {
    case MarkKind::kObjectBegins:
      return {LabelKind::kBegins, mark->notation, true};
    case MarkKind::kObjectEnds:
      return {LabelKind::kEnds, mark->notation, true};
    case MarkKind::kNoObject:
      return {LabelKind::kEnds, mark->notation, false};
    default:
      return {};
  }
}

}  // namespace traverse::gcode
