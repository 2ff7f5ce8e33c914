#include "client/gcode/verify/same_print.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "absl/strings/str_format.h"

namespace traverse::gcode {
namespace {

// A line of one side that the other side's section lacks, or has fewer times.
struct Odd {
  uint32_t number = 0;
  std::string text;
};

// A side, and which of its sections is meant.
struct Part {
  const Side& side;
  size_t index = 0;
  SectionLines& lines;

  const Section& section() const { return side.cut.sections[index]; }
};

struct BothSides {
  const Side& original;
  const Side& optimised;
  SectionLines lines_was{original.text};
  SectionLines lines_is{optimised.text};

  Part Was(size_t index) { return {original, index, lines_was}; }
  Part Is(size_t index) { return {optimised, index, lines_is}; }
};

std::optional<Odd> FirstOdd(const Part& a, const Part& b, bool deposits) {
  const bool right_digests = a.side.right_digest && b.side.right_digest;
  const auto wanted = [deposits, right_digests](const VerifyLine& line) {
    if (right_digests && line.number == 1) return false;
    return line.role == (deposits ? LineRole::kDeposit : LineRole::kComment);
  };
  const auto for_each_line = [deposits](const Part& part, const auto& visit) {
    const Section& section = part.section();
    part.lines.ForEach(deposits ? section.first_line : section.first_note,
                       deposits ? section.last_line : section.last_note, visit);
  };
  std::map<uint64_t, int64_t> known;
  for_each_line(b, [&](const VerifyLine& line) {
    if (wanted(line)) ++known[line.digest];
  });
  std::optional<Odd> odd;
  for_each_line(a, [&](const VerifyLine& line) {
    if (!wanted(line) || odd || --known[line.digest] >= 0) return;
    if (deposits && a.side.other_gaps.contains(line.digest)) return;
    if (!deposits && line.text.substr(0, kOptimisedMark.size()) == kOptimisedMark) return;
    odd = Odd{line.number, std::string(line.text)};
  });
  return odd;
}

VerifyBreak MultisetDifference(const Part& original, const Part& optimised, bool deposits) {
  const char* what = deposits ? "print" : "have";
  const char* under = deposits ? " under the same conditions" : "";
  const auto differ = [&](const Part& a, const Part& b, const Odd& odd) {
    const Section& section = b.section();
    const uint32_t first = deposits ? section.first_line : section.first_note;
    const bool is = &a == &optimised;
    return VerifyBreak{
        VerifyRule::kSamePrint, is ? first : odd.number, is ? odd.number : first, -1,
        absl::StrFormat("%s:%d: lines %d to %d of %s do not %s `%s`%s", a.side.name, odd.number,
                        first, deposits ? section.last_line : section.last_note, b.side.name, what,
                        odd.text, under)};
  };
  if (const std::optional<Odd> odd = FirstOdd(optimised, original, deposits)) {
    return differ(optimised, original, *odd);
  }
  const std::optional<Odd> odd = FirstOdd(original, optimised, deposits);
  return differ(original, optimised, odd.value_or(Odd{original.section().first_line, ""}));
}

std::optional<VerifyBreak> CompareEnds(const Part& original, const Part& optimised) {
  const Section& was = original.section();
  const Section& is = optimised.section();
  const auto differ = [&](const char* what) {
    return VerifyBreak{VerifyRule::kSamePrint, was.last_line, is.last_line, -1,
                       absl::StrFormat("%s:%d: %s at %s:%d", optimised.side.name, is.last_line,
                                       what, original.side.name, was.last_line)};
  };
  if (was.fence != is.fence || was.fixed != is.fixed)
    return differ("a different line from the one");
  // A label of an object does nothing: what is printed behind it has its own fan.
  if (!was.names && was.fan != is.fan) return differ("the fan differs from that");
  if (was.settings != is.settings) return differ("the settings differ from those");
  if (was.head != is.head) return differ("the head is elsewhere than");
  if (!was.label && was.retracted != is.retracted)
    return differ("the retraction differs from that");
  return std::nullopt;
}

VerifyBreak HeaderDifference(const Part& original, const Part& optimised) {
  const Section& was = original.section();
  const Section& is = optimised.section();
  return {
      VerifyRule::kSamePrint, was.first_line, is.first_line, -1,
      absl::StrFormat("%s:%d: the comments after the mark of the layer differ from those at %s:%d",
                      optimised.side.name, is.first_line, original.side.name, was.first_line)};
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
std::optional<VerifyBreak> DifferenceIn(BothSides& sides, size_t i, size_t end_of_print) {
  const Side& original = sides.original;
  const Side& optimised = sides.optimised;
  const Section& was = original.cut.sections[i];
  const Section& is = optimised.cut.sections[i];
  const Part part_was = sides.Was(i);
  const Part part_is = sides.Is(i);
  const auto differ = [&](std::string_view what) {
    return VerifyBreak{
        VerifyRule::kSamePrint, was.first_line, is.first_line, -1,
        absl::StrFormat("%s:%d: %s lines %d to %d of %s", optimised.name, is.first_line, what,
                        was.first_line, was.last_line, original.name)};
  };
  if (was.deposits != is.deposits) return MultisetDifference(part_was, part_is, true);
  if (was.under != is.under && was.deposits.count > 0) {
    return differ("what is printed stands under other labels than");
  }
  if (auto ends = CompareEnds(part_was, part_is)) return ends;
  if (was.notes != is.notes) return MultisetDifference(part_was, part_is, false);
  if (was.header != is.header) return HeaderDifference(part_was, part_is);
  // Where paths change places, what is said of them does so too.
  if (was.order == is.order && was.said != is.said) {
    return differ("the order of the comments differs from");
  }
  if (was.moves != is.moves && IsScript(original.cut, i, end_of_print)) {
    return differ(absl::StrFormat("lines %d to %d of a script move differently from", is.first_line,
                                  is.last_line));
  }
  if (is.lowest < was.lowest) return differ("travels lower than");
  return std::nullopt;
}

// What a moved layer amounts to, besides what it prints.
struct LayerSums {
  DigestSet notes;
  Micro lowest = INT64_MAX;
  uint32_t label_faults = 0;

  LayerSums(const Sections& cut, size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      const Section& section = cut.sections[i];
      notes += section.notes;
      lowest = std::min(lowest, section.lowest);
    }
    label_faults = cut.sections[end - 1].label_faults;
    if (first > 0) label_faults -= cut.sections[first - 1].label_faults;
  }
};

// Of a layer whose objects have changed places. A section's last line may be the label of the next
// object.
std::optional<VerifyBreak> MovedDifference(BothSides& sides, const MovedLayer& layer) {
  const Side& original = sides.original;
  const Side& optimised = sides.optimised;
  for (size_t i = layer.first; i < layer.end; ++i) {
    const Part was = sides.Was(layer.Of(i));
    const Part is = sides.Is(i);
    if (was.section().deposits != is.section().deposits) {
      return MultisetDifference(was, is, true);
    }
    if (was.index == i && was.section().header != is.section().header) {
      return HeaderDifference(was, is);
    }
    const Part end = sides.Was(layer.ends[i - layer.first]);
    const bool labels = end.section().names && is.section().names;
    if (labels && !layer.goes_on[i - layer.first]) continue;
    if (auto ends = CompareEnds(end, is)) return ends;
  }
  const Section& first_was = original.cut.sections[layer.first];
  const Section& first_is = optimised.cut.sections[layer.first];
  const auto differ = [&](const char* what) {
    return VerifyBreak{
        VerifyRule::kSamePrint, first_was.first_line, first_is.first_line, -1,
        absl::StrFormat("%s:%d: %s as in the layer of %s:%d", optimised.name, first_is.first_line,
                        what, original.name, first_was.first_line)};
  };
  const LayerSums was(original.cut, layer.first, layer.end);
  const LayerSums is(optimised.cut, layer.first, layer.end);
  if (is.label_faults > was.label_faults) return differ("labels of objects do not begin and end");
  if (was.notes != is.notes) return differ("the comments are not");
  if (is.lowest < was.lowest) return differ("travel is not as high");
  return std::nullopt;
}

}  // namespace

std::vector<VerifyBreak> Differences(const Side& original, const Side& optimised, size_t first,
                                     size_t end, bool whole, absl::Span<const MovedLayer> moved,
                                     const WorkLimit& limit) {
  const std::vector<Section>& sections_was = original.cut.sections;
  const std::vector<Section>& sections_is = optimised.cut.sections;
  const size_t common = std::min({sections_was.size(), sections_is.size(), end});
  const size_t end_of_print = whole ? EndOfPrint(original.cut) : SIZE_MAX;
  BothSides sides{original, optimised};
  std::vector<VerifyBreak> found;
  for (size_t i = first; i < common && !limit.Ended(); ++i) {
    if (!moved.empty() && moved.front().first == i && moved.front().end <= common) {
      if (auto difference = MovedDifference(sides, moved.front())) {
        found.push_back(*std::move(difference));
      }
      i = moved.front().end - 1;
      moved.remove_prefix(1);
      continue;
    }
    if (auto difference = DifferenceIn(sides, i, end_of_print)) {
      found.push_back(*std::move(difference));
    }
    // Behind such lines it is not known what belongs together.
    if (sections_was[i].fence != sections_is[i].fence) return found;
  }
  if (!whole || sections_was.size() == sections_is.size()) return found;
  const Side& longer = sections_was.size() > sections_is.size() ? original : optimised;
  const Side& shorter = &longer == &original ? optimised : original;
  const uint32_t line = longer.cut.sections[common].first_line;
  const uint32_t last = common > 0 ? shorter.cut.sections[common - 1].last_line : 0;
  const bool lacks = &longer == &original;
  found.push_back({VerifyRule::kSamePrint, lacks ? line : last, lacks ? last : line, -1,
                   absl::StrFormat("%s:%d: continues where %s ends, with line %d", longer.name,
                                   line, shorter.name, last)});
  return found;
}

}  // namespace traverse::gcode
