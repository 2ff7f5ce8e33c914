#include "client/gcode/write/progress_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/gcode/model/outline.h"
#include "client/gcode/model/part_links.h"

namespace traverse::gcode {

namespace {

// A run of places between which nothing is that nothing crosses.
struct Part {
  size_t first_place = 0;
  size_t end_place = 0;
  std::vector<Offset> lines;
  std::vector<double> shares = {};  // [line] of the time of the part that is over
};

// Those with lines, without their shares.
std::vector<Part> PartsOf(const GcodeFile& file, const Layer& layer, bool moved) {
  std::vector<Part> parts;
  for (uint32_t begin = layer.first_block; begin < layer.end_block;) {
    uint32_t end = begin + 1;
    while (end < layer.end_block && (moved || !IsBoundary(file.blocks[end]))) ++end;
    const auto first =
        std::lower_bound(file.progress.begin(), file.progress.end(), file.blocks[begin].begin);
    const auto last = std::lower_bound(first, file.progress.end(), file.blocks[end - 1].end);
    if (first != last) {
      parts.push_back({begin - layer.first_block, end - layer.first_block, {first, last}});
    }
    begin = end;
  }
  return parts;
}

void LearnShares(const GcodeFile& file, const Layer& layer, std::vector<Part>& parts) {
  const Block& first_block = file.blocks[layer.first_block];
  TextMoments moments;
  const auto note = [&](Offset at) { moments.offsets.push_back(at - first_block.begin); };
  for (const Part& part : parts) {
    note(file.blocks[layer.first_block + part.first_place].begin);
    for (const Offset line : part.lines) note(line);
    note(file.blocks[layer.first_block + part.end_place - 1].end);
  }
  MeasureMoments(file, file.PathsText(layer), {StateAt(file, first_block), {}}, &moments);
  auto at = moments.seconds.begin();
  for (Part& part : parts) {
    const double begun = *at++;
    const auto end = at + static_cast<std::ptrdiff_t>(part.lines.size());
    const double seconds = *end - begun;
    for (; at != end; ++at) part.shares.push_back(seconds > 0 ? (*at - begun) / seconds : 0);
    ++at;
  }
}

// A place where a line may stand, and when that is.
struct Gap {
  size_t offset = 0;
  double seconds = 0;
};

// In `bare`, ascending: before each path and before each segment of it.
std::vector<Gap> GapsOf(const GcodeFile& file, std::string_view bare, const PartStart& start,
                        const std::vector<size_t>& marks, TextMoments& moments) {
  std::vector<Gap> gaps;
  moments.offsets = marks;
  size_t mark = 0;
  MeasureMoments(file, bare, start, &moments, [&](const Step& step, double seconds) {
    const size_t offset = step.line.begin;
    bool begins = false;
    for (; mark < marks.size() && marks[mark] <= offset; ++mark) begins = mark % 2 == 0;
    const bool within = mark % 2 == 1 && step.kind == StepKind::kExtrude;
    if ((begins && mark % 2 == 1) || within) gaps.push_back({offset, seconds});
  });
  return gaps;
}

}  // namespace

void InsertProgressLines(const GcodeFile& file, const Layer& layer, bool moved,
                         std::string_view bare, const PartStart& start, std::vector<size_t>& marks,
                         std::string& out) {
  std::vector<Part> parts = PartsOf(file, layer, moved);
  const size_t before = out.size();
  TextMoments moments;
  std::vector<Gap> gaps;
  if (!parts.empty()) {
    LearnShares(file, layer, parts);
    gaps = GapsOf(file, bare, start, marks, moments);
  }
  std::vector<std::pair<size_t, size_t>> inserted;  // where in `bare`, and how much
  size_t copied = 0;
  for (const Part& part : parts) {
    const double begun = moments.seconds[2 * part.first_place];
    const double ended = moments.seconds[2 * part.end_place - 1];
    const size_t end_offset = marks[2 * part.end_place - 1];
    auto gap = std::lower_bound(gaps.begin(), gaps.end(), marks[2 * part.first_place],
                                [](const Gap& a, size_t offset) { return a.offset < offset; });
    for (size_t i = 0; i < part.lines.size(); ++i) {
      const double wanted = begun + part.shares[i] * (ended - begun);
      // Lines that take no time are passed.
      const auto is_as_near = [&](const Gap& other) {
        return other.offset < end_offset &&
               std::abs(other.seconds - wanted) <= std::abs(gap->seconds - wanted);
      };
      while (std::next(gap) != gaps.end() && is_as_near(*std::next(gap))) ++gap;
      out.append(bare.substr(copied, gap->offset - copied));
      copied = gap->offset;
      const std::string_view line = LineAt(file.text, part.lines[i]).Raw(file.text);
      out.append(line);
      inserted.emplace_back(gap->offset, line.size());
    }
  }
  out.append(bare.substr(copied));
  auto next = inserted.begin();
  size_t shift = before;
  for (size_t i = 0; i < marks.size(); ++i) {
    // What stands where a path begins stands before it.
    const size_t end = marks[i] + (i % 2 == 0 ? 1 : 0);
    for (; next != inserted.end() && next->first < end; ++next) shift += next->second;
    marks[i] += shift;
  }
}

}  // namespace traverse::gcode
