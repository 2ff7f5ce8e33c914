#include "tests/client/gcode/support/mutation.h"

#include <functional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "engine/base/rng.h"

namespace traverse::gcode::testing {
namespace {

using Lines = std::vector<std::string>;

bool Has(const std::string& line, const char* part) { return line.find(part) != std::string::npos; }
bool Begins(const std::string& line, const std::string& with) { return line.rfind(with, 0) == 0; }

bool Extrudes(const std::string& line) {
  return Begins(line, "G1 X") && Has(line, " E") && !Has(line, " E-") && !Has(line, " E0");
}
bool Retracts(const std::string& line) { return Begins(line, "G1 E-"); }
bool Primes(const std::string& line) { return Begins(line, "G1 E") && !Retracts(line); }

// Adds one to the first digit (9 becomes 8) behind `word`: another number of about the same size.
std::string WithOtherNumber(std::string line, const std::string& word) {
  for (size_t at = line.find(word) + word.size(); at < line.size(); ++at) {
    if (line[at] < '1' || line[at] > '9') continue;
    line[at] = static_cast<char>(line[at] == '9' ? '8' : line[at] + 1);
    return line;
  }
  return line + "1";
}

// A setter is in force, with another value than before, for some line that extrudes.
bool Matters(const Lines& lines, size_t at, const std::string& prefix) {
  for (size_t before = at; before-- > 0;) {
    if (!Begins(lines[before], prefix)) continue;
    if (lines[before] == lines[at]) return false;
    break;
  }
  for (size_t behind = at + 1; behind < lines.size(); ++behind) {
    if (Begins(lines[behind], prefix)) return false;
    if (Extrudes(lines[behind])) return true;
  }
  return false;
}

bool NextExtrudes(const Lines& lines, size_t at) {
  return at + 1 < lines.size() && Extrudes(lines[at + 1]);
}

struct Kind {
  std::string name;
  std::function<bool(const Lines&, size_t)> fits;
  std::function<void(Lines&, size_t)> change;
};

Kind Drop(const std::string& name, bool (*fits)(const std::string&)) {
  return {name, [fits](const Lines& lines, size_t i) { return fits(lines[i]); },
          [](Lines& lines, size_t i) { lines[i].clear(); }};
}

Kind DropSetter(const std::string& prefix) {
  return {"dropped",
          [prefix](const Lines& lines, size_t i) {
            return Begins(lines[i], prefix) && Matters(lines, i, prefix);
          },
          [](Lines& lines, size_t i) { lines[i].clear(); }};
}

Kind Change(const std::string& word, std::function<bool(const Lines&, size_t)> fits) {
  return {absl::StrCat("changed", word), std::move(fits),
          [word](Lines& lines, size_t i) { lines[i] = WithOtherNumber(lines[i], word); }};
}

std::vector<Kind> Kinds() {
  const auto extrudes = [](const Lines& lines, size_t i) { return Extrudes(lines[i]); };
  const auto feeds = [](const Lines& lines, size_t i) {
    return Begins(lines[i], "G1 F") && NextExtrudes(lines, i);
  };
  const auto lowers = [](const Lines& lines, size_t i) {
    return Begins(lines[i], "G1 Z") && Matters(lines, i, "G1 Z");
  };
  const auto retracts = [](const Lines& lines, size_t i) { return Retracts(lines[i]); };
  const auto primes = [](const Lines& lines, size_t i) { return Primes(lines[i]); };
  const auto blows = [](const Lines& lines, size_t i) {
    return Begins(lines[i], "M106 S") && Matters(lines, i, "M106 S");
  };
  return {
      Drop("dropped", Extrudes),
      Drop("dropped", Retracts),
      Drop("dropped", Primes),
      DropSetter("M204 "),
      DropSetter(";TYPE:"),
      DropSetter(";WIDTH:"),
      DropSetter("M106 S"),
      {"duplicated", extrudes,
       [](Lines& lines, size_t i) { lines[i] = absl::StrCat(lines[i], "\n", lines[i]); }},
      {"duplicated", retracts,
       [](Lines& lines, size_t i) { lines[i] = absl::StrCat(lines[i], "\n", lines[i]); }},
      {"swapped with the next",
       [](const Lines& lines, size_t i) { return Extrudes(lines[i]) && NextExtrudes(lines, i); },
       [](Lines& lines, size_t i) { std::swap(lines[i], lines[i + 1]); }},
      Change(" E", extrudes),
      Change(" X", extrudes),
      Change(" E-", retracts),
      Change(" E", primes),
      Change(" F", feeds),
      Change(" Z", lowers),
      Change(" S", blows),
      {"given another tool", extrudes,
       [](Lines& lines, size_t i) { lines[i] = absl::StrCat("T1\n", lines[i]); }},
      {"given an unknown command", extrudes,
       [](Lines& lines, size_t i) { lines[i] = absl::StrCat("M600\n", lines[i]); }},
  };
}

}  // namespace

Mutation Mutate(const std::string& text, uint64_t seed) {
  Lines lines = absl::StrSplit(text, '\n');
  const std::vector<Kind> kinds = Kinds();
  Rng rng(seed);
  size_t first = 0;
  while (!Begins(lines[first], "M83")) ++first;
  // A kind that this file has no line for gives travel to the next one.
  for (uint64_t k = seed;; ++k) {
    const Kind& kind = kinds[k % kinds.size()];
    std::vector<size_t> candidates;
    // Before M83 extrusion is absolute: to repeat a line there changes nothing.
    for (size_t i = first; i < lines.size(); ++i) {
      if (kind.fits(lines, i)) candidates.push_back(i);
    }
    if (candidates.empty()) continue;
    const size_t at = candidates[rng.Below(static_cast<uint32_t>(candidates.size()))];
    Mutation mutation;
    mutation.what = absl::StrCat("line ", at + 1, " `", lines[at], "` ", kind.name);
    kind.change(lines, at);
    mutation.text = absl::StrJoin(lines, "\n");
    return mutation;
  }
}

}  // namespace traverse::gcode::testing
