#include "client/gcode/verify/verifier.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/gcode/parallel.h"
#include "client/gcode/verify/sections.h"

namespace traverse {
namespace gcode {
namespace {

struct Side {
  std::string_view text;
  const std::string& name;
  Sections cut;
};

absl::Status Difference(const std::string& text) { return absl::FailedPreconditionError(text); }

// A line of one side that the other side's section lacks, or has fewer times.
struct Odd {
  size_t number = 0;
  std::string text;
};

std::optional<Odd> FirstOdd(const Side& a, const Side& b, size_t index, bool deposits) {
  const auto wanted = [deposits](const VerifyLine& line) {
    const bool note = line.role == LineRole::kComment || line.role == LineRole::kProgress;
    return deposits ? line.role == LineRole::kDeposit : note;
  };
  const auto for_each_line = [index, deposits](const Side& side, const auto& visit) {
    const Section& section = side.cut.sections[index];
    ForEachLine(side.text, deposits ? section.first_line : section.first_note,
                deposits ? section.last_line : section.last_note, visit);
  };
  std::map<uint64_t, int64_t> known;
  for_each_line(b, [&](const VerifyLine& line) {
    if (wanted(line)) ++known[line.digest];
  });
  std::optional<Odd> odd;
  for_each_line(a, [&](const VerifyLine& line) {
    if (!wanted(line) || odd || --known[line.digest] >= 0) return;
    if (!deposits && line.text.substr(0, kOptimisedMark.size()) == kOptimisedMark) return;
    odd = Odd{line.number, std::string(line.text)};
  });
  return odd;
}

absl::Status MultisetDifference(const Side& original, const Side& optimised, size_t index,
                                bool deposits) {
  const char* what = deposits ? "prints" : "has";
  const char* under = deposits ? " under the same conditions" : "";
  const auto differ = [&](const Side& a, const Side& b, const Odd& odd) {
    const Section& section = b.cut.sections[index];
    return Difference(
        absl::StrFormat("%s:%d: `%s` %s what lines %d to %d of %s do not%s", a.name, odd.number,
                        odd.text, what, deposits ? section.first_line : section.first_note,
                        deposits ? section.last_line : section.last_note, b.name, under));
  };
  if (const std::optional<Odd> odd = FirstOdd(optimised, original, index, deposits)) {
    return differ(optimised, original, *odd);
  }
  const std::optional<Odd> odd = FirstOdd(original, optimised, index, deposits);
  return differ(original, optimised,
                odd.value_or(Odd{original.cut.sections[index].first_line, ""}));
}

absl::Status CompareEnds(const Side& original, const Side& optimised, size_t index) {
  const Section& was = original.cut.sections[index];
  const Section& is = optimised.cut.sections[index];
  const auto differ = [&](const char* what) {
    return Difference(absl::StrFormat("%s:%d: %s at %s:%d", optimised.name, is.last_line, what,
                                      original.name, was.last_line));
  };
  if (was.fence != is.fence || was.fixed != is.fixed) return differ("not the line that stands");
  if (was.fan != is.fan) return differ("the fan is not as");
  if (was.x != is.x || was.y != is.y || was.z != is.z) return differ("the head is not where it is");
  if (was.retracted != is.retracted) return differ("filament is not pulled back as");
  return absl::OkStatus();
}

absl::Status Compare(const Side& original, const Side& optimised) {
  const size_t common = std::min(original.cut.sections.size(), optimised.cut.sections.size());
  for (size_t i = 0; i < common; ++i) {
    const Section& was = original.cut.sections[i];
    const Section& is = optimised.cut.sections[i];
    if (was.deposits != is.deposits) return MultisetDifference(original, optimised, i, true);
    if (absl::Status ends = CompareEnds(original, optimised, i); !ends.ok()) return ends;
    if (was.notes != is.notes) return MultisetDifference(original, optimised, i, false);
    if (is.lowest < was.lowest) {
      return Difference(absl::StrFormat("%s:%d: travels lower than lines %d to %d of %s",
                                        optimised.name, is.first_line, was.first_line,
                                        was.last_line, original.name));
    }
  }
  if (original.cut.sections.size() != optimised.cut.sections.size()) {
    const Side& longer =
        original.cut.sections.size() > optimised.cut.sections.size() ? original : optimised;
    const Side& shorter = &longer == &original ? optimised : original;
    return Difference(absl::StrFormat("%s:%d: goes on where %s ends", longer.name,
                                      longer.cut.sections[common].first_line, shorter.name));
  }
  return absl::OkStatus();
}

absl::Status ComparePrimes(const Side& original, const Side& optimised) {
  const std::set<Micro>& known = original.cut.surpluses;
  for (const Micro surplus : optimised.cut.surpluses) {
    if (known.contains(surplus)) continue;
    VerifyMachine machine(optimised.text);
    const Micro slack = VerifyMachine::kSlack;
    for (VerifyLine line; machine.Next(line);) {
      if (!line.primes || (line.surplus + slack / 2) / slack * slack != surplus) continue;
      return Difference(absl::StrFormat(
          "%s:%d: `%s` pushes %.4f mm more than was pulled back; no line of %s does",
          optimised.name, line.number, std::string(line.text), static_cast<double>(surplus) * 1e-6,
          original.name));
    }
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace gcode

absl::Status VerifyGcode(std::string_view original, const std::string& original_name,
                         std::string_view optimised, const std::string& optimised_name) {
  gcode::Side was{original, original_name, {}};
  gcode::Side is{optimised, optimised_name, {}};
  gcode::ParallelFor(2, gcode::ThreadsFor(original.size()), [&](size_t i) {
    gcode::Side& side = i == 0 ? was : is;
    side.cut = gcode::CutIntoSections(side.text, kOptimisedMark);
  });
  if (absl::Status status = gcode::Compare(was, is); !status.ok()) return status;
  return gcode::ComparePrimes(was, is);
}

}  // namespace traverse
