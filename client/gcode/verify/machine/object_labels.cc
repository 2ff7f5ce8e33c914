#include "client/gcode/verify/machine/object_labels.h"

#include <algorithm>
#include <optional>

#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Commands of hosts.
constexpr std::string_view kObject = "@OBJECT";
constexpr std::string_view kExcludeRegion = "@EXCLUDEREGION";

// The value of NAME= among the parameters of a macro, perhaps quoted; else all of them.
std::string_view NameIn(std::string_view parameters) {
  const size_t at = parameters.find("NAME=");
  if (at == std::string_view::npos) return parameters;
  const std::string_view name = parameters.substr(at + 5);
  const bool quoted = !name.empty() && (name[0] == '\'' || name[0] == '"');
  if (quoted) return name.substr(0, name.find(name[0], 1));
  return name.substr(0, name.find_first_of(" \t;"));
}

// In any case. A command's number does not go on.
bool IsCommand(std::string_view line, std::string_view command, std::string_view& rest) {
  if (!BeginsInAnyCase(line, command)) return false;
  rest = line.substr(command.size());
  if (!rest.empty() && rest[0] >= '0' && rest[0] <= '9') return false;
  rest = TrimLine(rest);
  return true;
}

// What follows `command` of a host, in any case; nothing if it is another one.
std::optional<std::string_view> BehindHostCommand(std::string_view line, std::string_view command) {
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  if (!EqualsInAnyCase(word, command)) return std::nullopt;
  return TrimLine(line.substr(command.size()));
}

// The object is left: the first word says so.
bool IsNothing(std::string_view name) {
  const std::string_view word = name.substr(0, name.find_first_of(" \t"));
  for (const std::string_view none : {"", "NONE", "END", "STOP", "OFF", "DISABLE"}) {
    if (EqualsInAnyCase(word, none)) return true;
  }
  return false;
}

}  // namespace

bool ObjectLabels::IsOfHost(std::string_view line) {
  return BehindHostCommand(line, kObject) || BehindHostCommand(line, kExcludeRegion);
}

void ObjectLabels::Switch(Notation notation, std::string_view name) {
  open_[notation] = name.empty() ? 0 : DigestOf(name) | 1;
}

void ObjectLabels::Begin(Notation notation, std::string_view name) {
  if (open_[notation] != 0) ++faults_;
  open_[notation] = DigestOf(name) | 1;
}

void ObjectLabels::End(Notation notation, std::string_view name) {
  const bool wrong =
      open_[notation] == 0 || (!name.empty() && open_[notation] != (DigestOf(name) | 1));
  if (wrong) ++faults_;
  open_[notation] = 0;
}

// The comment begins with `prefix`, followed by the name of the object, or by `none`.
struct ObjectLabels::Mark {
  std::string_view prefix;
  void (ObjectLabels::*take)(Notation notation, std::string_view name);
  Notation notation;
  std::string_view none = {};
};

bool ObjectLabels::Take(std::string_view line) {
  static constexpr Mark kMarks[] = {
      {"; stop printing object, unique label id:", &ObjectLabels::End, kUnique},
      {"; start printing object, unique label id:", &ObjectLabels::Begin, kUnique},
      {"; stop printing object", &ObjectLabels::End, kPrinting},
      {"; printing object", &ObjectLabels::Begin, kPrinting},
      {"; OBJECT_ID:", &ObjectLabels::Switch, kObjectId},
      {";MESH:", &ObjectLabels::Switch, kMesh, "NONMESH"},
      {";PRINTING_ID:", &ObjectLabels::Switch, kPrintingId, "-1"},
      {";PRINTING:", &ObjectLabels::Switch, kPrintingOf, "NON-OBJECT"},
  };
  std::string_view rest;
  if (line.empty()) return false;
  if (line[0] == ';') {
    for (const Mark& mark : kMarks) {
      if (!line.starts_with(mark.prefix)) continue;
      rest = TrimLine(line.substr(mark.prefix.size()));
      (this->*mark.take)(mark.notation, rest == mark.none ? std::string_view() : rest);
      return true;
    }
    return false;
  }
  if (line[0] == '@') {
    for (const Notation notation : {kHost, kRegion}) {
      const auto name = BehindHostCommand(line, notation == kHost ? kObject : kExcludeRegion);
      if (!name) continue;
      Switch(notation, IsNothing(*name) ? std::string_view() : *name);
      return true;
    }
    return false;
  }
  if (IsCommand(line, "EXCLUDE_OBJECT_START", rest)) {
    Begin(kExclude, NameIn(rest));
  } else if (IsCommand(line, "EXCLUDE_OBJECT_END", rest)) {
    End(kExclude, NameIn(rest));
  } else if (IsCommand(line, "M624", rest)) {
    Begin(kM624, rest);
  } else if (IsCommand(line, "M625", rest)) {
    End(kM624, {});
  } else if (IsCommand(line, "M486", rest)) {
    if (!BeginsInAnyCase(rest, "S")) return true;
    const std::string_view number = TrimLine(rest.substr(1));
    Switch(kM486, number.starts_with("-") ? std::string_view() : number);
  } else {
    return false;
  }
  return true;
}

uint64_t ObjectLabels::digest() const {
  const bool any = std::ranges::any_of(open_, [](uint64_t name) { return name != 0; });
  uint64_t digest = 0;
  for (const uint64_t name : open_) digest = Mix(digest, name);
  return any ? digest | 1 : 0;
}

}  // namespace traverse::gcode
