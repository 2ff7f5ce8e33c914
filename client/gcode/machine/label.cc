#include "client/gcode/machine/label.h"

#include <algorithm>
#include <cctype>

#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

struct Notation {
  std::string_view begins;
  Label label;
};

bool EqualsInAnyCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::toupper(static_cast<unsigned char>(x)) ==
           std::toupper(static_cast<unsigned char>(y));
  });
}

// `@OBJECT part.stl`, `@OBJECT none`; `@EXCLUDEREGION part`, `@ExcludeRegion end part`.
Label HostLabel(std::string_view line) {
  for (const std::string_view command : {"@OBJECT", "@EXCLUDEREGION"}) {
    if (!EqualsInAnyCase(line.substr(0, command.size()), command)) continue;
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
  const std::string_view words = TrimBlanks(line.substr(kM486.size()));
  if (!StartsWith(words, "S")) return {LabelKind::kSays, kM486, false};
  const bool ends = StartsWith(TrimBlanks(words.substr(1)), "-");
  return {ends ? LabelKind::kEnds : LabelKind::kBegins, kM486, !ends};
}

// `M624` behind which no digit follows.
bool IsCommand(std::string_view line, std::string_view command) {
  return StartsWith(line, command) &&
         (line.size() == command.size() ||
          !std::isdigit(static_cast<unsigned char>(line[command.size()])));
}

}  // namespace

Label LabelOf(std::string_view line) {
  constexpr LabelKind kBegins = LabelKind::kBegins;
  constexpr LabelKind kEnds = LabelKind::kEnds;
  // What ends nothing in particular comes first, where it begins as another one does.
  static constexpr Notation kNotations[] = {
      {"; printing object", {kBegins, "; printing object", true}},
      {"; stop printing object, unique", {kEnds, "; start printing object", true}},
      {"; stop printing object", {kEnds, "; printing object", true}},
      {"; start printing object", {kBegins, "; start printing object", true}},
      {"; OBJECT_ID:", {kBegins, "; OBJECT_ID:", true}},
      {"EXCLUDE_OBJECT_START", {kBegins, "EXCLUDE_OBJECT", true}},
      {"EXCLUDE_OBJECT_END", {kEnds, "EXCLUDE_OBJECT", true}},
      {";MESH:NONMESH", {kEnds, ";MESH:", false}},
      {";MESH:", {kBegins, ";MESH:", true}},
      {";PRINTING: NON-OBJECT", {kEnds, ";PRINTING:", false}},
      {";PRINTING:", {kBegins, ";PRINTING:", true}},
      {";PRINTING_ID: -1", {kEnds, ";PRINTING_ID:", false}},
      {";PRINTING_ID:", {kBegins, ";PRINTING_ID:", true}},
      {"; END_LAYER_OBJECT", {kEnds, "; END_LAYER_OBJECT", false}},
      {"; </layer>", {kEnds, "; </layer>", false}},
  };
  if (line.empty()) return {};
  if (line[0] == '@') return HostLabel(line);
  if (line[0] == 'M' || line[0] == 'm') {
    if (IsCommand(line, "M486")) return MarlinLabel(line);
    if (IsCommand(line, "M624")) return {kBegins, "M624", true};
    return IsCommand(line, "M625") ? Label{kEnds, "M624", false} : Label{};
  }
  for (const Notation& notation : kNotations) {
    if (StartsWith(line, notation.begins)) return notation.label;
  }
  return {};
}

}  // namespace traverse::gcode
