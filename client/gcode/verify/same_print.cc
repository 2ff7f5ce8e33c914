#include "client/gcode/verify/same_print.h"

#include <algorithm>
#include <map>
#include <optional>

#include "absl/strings/str_format.h"

namespace traverse::gcode {
namespace {

// A line of one side that the other side's section lacks, or has fewer times.
struct Odd {
  size_t number = 0;
  std::string text;
};

std::optional<Odd> FirstOdd(const Side& a, const Side& b, size_t index, bool deposits) {
  const bool right_digests = a.right_digest && b.right_digest;
  const auto wanted = [deposits, right_digests](const VerifyLine& line) {
    if (right_digests && line.number == 1) return false;
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
    if (deposits && a.other_gaps.contains(line.digest)) return;
    if (!deposits && line.text.substr(0, kOptimisedMark.size()) == kOptimisedMark) return;
    odd = Odd{line.number, std::string(line.text)};
  });
  return odd;
}

VerifyBreak MultisetDifference(const Side& original, const Side& optimised, size_t index,
                               bool deposits) {
  const char* what = deposits ? "print" : "have";
  const char* under = deposits ? " under the same conditions" : "";
  const auto differ = [&](const Side& a, const Side& b, const Odd& odd) {
    const Section& section = b.cut.sections[index];
    const size_t first = deposits ? section.first_line : section.first_note;
    const bool is = &a == &optimised;
    return VerifyBreak{
        VerifyRule::kSamePrint, is ? first : odd.number, is ? odd.number : first, -1,
        absl::StrFormat("%s:%d: lines %d to %d of %s do not %s `%s`%s", a.name, odd.number, first,
                        deposits ? section.last_line : section.last_note, b.name, what, odd.text,
                        under)};
  };
  if (const std::optional<Odd> odd = FirstOdd(optimised, original, index, deposits)) {
    return differ(optimised, original, *odd);
  }
  const std::optional<Odd> odd = FirstOdd(original, optimised, index, deposits);
  return differ(original, optimised,
                odd.value_or(Odd{original.cut.sections[index].first_line, ""}));
}

std::optional<VerifyBreak> CompareEnds(const Side& original, const Side& optimised, size_t index) {
  const Section& was = original.cut.sections[index];
  const Section& is = optimised.cut.sections[index];
  const auto differ = [&](const char* what) {
    return VerifyBreak{VerifyRule::kSamePrint, was.last_line, is.last_line, -1,
                       absl::StrFormat("%s:%d: %s at %s:%d", optimised.name, is.last_line, what,
                                       original.name, was.last_line)};
  };
  if (was.fence != is.fence || was.fixed != is.fixed)
    return differ("a different line from the one");
  if (was.fan != is.fan) return differ("the fan differs from that");
  if (was.settings != is.settings) return differ("the settings differ from those");
  if (was.x != is.x || was.y != is.y || was.z != is.z) return differ("the head is elsewhere than");
  if (!was.label && was.retracted != is.retracted)
    return differ("the retraction differs from that");
  return std::nullopt;
}

// True if all that is done in section `index` is as a script has it: before the first layer,
// between two lines that are not known, or behind the print.
bool IsScript(const Sections& cut, size_t index, size_t end_of_print) {
  if (index < cut.of_script) return true;
  const Section& section = cut.sections[index];
  if (section.deposits.count > 0 || index == 0) return false;
  return (section.fixed && cut.sections[index - 1].fixed) || index > end_of_print;
}

// The section that ends with the first command behind the last deposit.
size_t EndOfPrint(const Sections& cut) {
  size_t end = cut.sections.size();
  while (end > 0 && cut.sections[end - 1].deposits.count == 0) --end;
  if (end > 0) --end;
  while (end < cut.sections.size() && !cut.sections[end].command) ++end;
  return end;
}

// The first difference in section `i`.
std::optional<VerifyBreak> DifferenceIn(const Side& original, const Side& optimised, size_t i,
                                        size_t end_of_print) {
  const Section& was = original.cut.sections[i];
  const Section& is = optimised.cut.sections[i];
  if (was.deposits != is.deposits) return MultisetDifference(original, optimised, i, true);
  if (auto ends = CompareEnds(original, optimised, i)) return ends;
  if (was.notes != is.notes) return MultisetDifference(original, optimised, i, false);
  if (was.header != is.header) {
    return VerifyBreak{
        VerifyRule::kSamePrint, was.first_line, is.first_line, -1,
        absl::StrFormat(
            "%s:%d: the comments after the mark of the layer differ from those at %s:%d",
            optimised.name, is.first_line, original.name, was.first_line)};
  }
  // Where paths change places, what is said of them does so too.
  if (was.order == is.order && was.said != is.said) {
    return VerifyBreak{
        VerifyRule::kSamePrint, was.first_line, is.first_line, -1,
        absl::StrFormat("%s:%d: the order of the comments differs from lines %d to %d of %s",
                        optimised.name, is.first_line, was.first_line, was.last_line,
                        original.name)};
  }
  if (was.moves != is.moves && IsScript(original.cut, i, end_of_print)) {
    return VerifyBreak{
        VerifyRule::kSamePrint, was.first_line, is.first_line, -1,
        absl::StrFormat(
            "%s:%d: lines %d to %d of a script move differently from lines %d to %d of %s",
            optimised.name, is.first_line, is.first_line, is.last_line, was.first_line,
            was.last_line, original.name)};
  }
  if (is.lowest < was.lowest) {
    return VerifyBreak{
        VerifyRule::kSamePrint, was.first_line, is.first_line, -1,
        absl::StrFormat("%s:%d: travels lower than lines %d to %d of %s", optimised.name,
                        is.first_line, was.first_line, was.last_line, original.name)};
  }
  return std::nullopt;
}

}  // namespace

std::vector<VerifyBreak> Differences(const Side& original, const Side& optimised, size_t first,
                                     size_t end, bool whole) {
  const std::vector<Section>& sections_was = original.cut.sections;
  const std::vector<Section>& sections_is = optimised.cut.sections;
  const size_t common = std::min({sections_was.size(), sections_is.size(), end});
  const size_t end_of_print = whole ? EndOfPrint(original.cut) : SIZE_MAX;
  std::vector<VerifyBreak> found;
  for (size_t i = first; i < common; ++i) {
    if (auto difference = DifferenceIn(original, optimised, i, end_of_print)) {
      found.push_back(*std::move(difference));
    }
    // Behind such lines it is not known what belongs together.
    if (sections_was[i].fence != sections_is[i].fence) return found;
  }
  if (!whole || sections_was.size() == sections_is.size()) return found;
  const Side& longer = sections_was.size() > sections_is.size() ? original : optimised;
  const Side& shorter = &longer == &original ? optimised : original;
  const size_t line = longer.cut.sections[common].first_line;
  const size_t last = common > 0 ? shorter.cut.sections[common - 1].last_line : 0;
  const bool lacks = &longer == &original;
  found.push_back({VerifyRule::kSamePrint, lacks ? line : last, lacks ? last : line, -1,
                   absl::StrFormat("%s:%d: continues where %s ends, with line %d", longer.name,
                                   line, shorter.name, last)});
  return found;
}

}  // namespace traverse::gcode
