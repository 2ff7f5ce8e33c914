#include "client/gcode/write/progress_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/gcode/model/outline.h"
#include "client/gcode/model/part_links.h"

namespace traverse::gcode {

ProgressLines::ProgressLines(const GcodeFile& file, const Layer& layer, bool moved) : file_(file) {
  const Offset begin = file.blocks[layer.first_block].begin;
  const Offset end = file.blocks[layer.end_block - 1].end;
  const auto first = std::lower_bound(file.progress.begin(), file.progress.end(), begin);
  if (first == file.progress.end() || *first >= end) return;
  FindParts(layer, moved);
  if (!lines_.empty()) LearnShares(layer);
}

void ProgressLines::FindParts(const Layer& layer, bool moved) {
  const auto splits = [this, moved](uint32_t block) {
    return !moved && IsBoundary(file_.blocks[block]);
  };
  auto next = file_.progress.begin();
  for (uint32_t begin = layer.first_block; begin < layer.end_block;) {
    uint32_t end = begin + 1;
    while (end < layer.end_block && !splits(end)) ++end;
    Part part{begin - layer.first_block, end - layer.first_block, lines_.size(), 0};
    next = std::lower_bound(next, file_.progress.end(), file_.blocks[begin].begin);
    for (; next != file_.progress.end() && *next < file_.blocks[end - 1].end; ++next) {
      lines_.push_back(*next);
    }
    part.end_line = lines_.size();
    if (part.end_line > part.first_line) parts_.push_back(part);
    begin = end;
  }
}

void ProgressLines::LearnShares(const Layer& layer) {
  const Block& first = file_.blocks[layer.first_block];
  TextMoments moments;
  for (const Part& part : parts_) {
    moments.offsets.push_back(file_.blocks[layer.first_block + part.first_place].begin);
    for (size_t i = part.first_line; i < part.end_line; ++i) moments.offsets.push_back(lines_[i]);
    moments.offsets.push_back(file_.blocks[layer.first_block + part.end_place - 1].end);
  }
  for (size_t& offset : moments.offsets) offset -= first.begin;
  MeasureMoments(file_, file_.PathsText(layer), {StateAt(file_, first), {}}, &moments);
  auto at = moments.seconds.begin();
  for (const Part& part : parts_) {
    const double begun = *at++;
    const auto end = at + static_cast<std::ptrdiff_t>(part.end_line - part.first_line);
    const double seconds = *end - begun;
    for (; at != end; ++at) shares_.push_back(seconds > 0 ? (*at - begun) / seconds : 0);
    ++at;
  }
}

std::vector<ProgressLines::Gap> ProgressLines::GapsOf(std::string_view bare, const PartStart& start,
                                                      const std::vector<size_t>& marks,
                                                      TextMoments& moments) const {
  std::vector<Gap> gaps;
  moments.offsets = marks;
  size_t mark = 0;
  MeasureMoments(file_, bare, start, &moments, [&](const Step& step, double seconds) {
    const size_t offset = step.line.begin;
    bool begins = false;
    for (; mark < marks.size() && marks[mark] <= offset; ++mark) begins = mark % 2 == 0;
    const bool within = mark % 2 == 1 && step.kind == StepKind::kExtrude;
    if ((begins && mark % 2 == 1) || within) gaps.push_back({offset, seconds});
  });
  return gaps;
}

void ProgressLines::Insert(std::string_view bare, const PartStart& start,
                           std::vector<size_t>& marks, std::string& out) const {
  const size_t before = out.size();
  TextMoments moments;
  std::vector<Gap> gaps;
  if (!parts_.empty()) gaps = GapsOf(bare, start, marks, moments);
  std::vector<std::pair<size_t, size_t>> inserted;  // where in `bare`, and how much
  size_t copied = 0;
  for (const Part& part : parts_) {
    const double begun = moments.seconds[2 * part.first_place];
    const double ended = moments.seconds[2 * part.end_place - 1];
    const size_t end_offset = marks[2 * part.end_place - 1];
    auto gap = std::lower_bound(gaps.begin(), gaps.end(), marks[2 * part.first_place],
                                [](const Gap& a, size_t offset) { return a.offset < offset; });
    for (size_t i = part.first_line; i < part.end_line; ++i) {
      const double wanted = begun + shares_[i] * (ended - begun);
      // Lines that take no time are passed.
      const auto is_as_near = [&](const Gap& other) {
        return other.offset < end_offset &&
               std::abs(other.seconds - wanted) <= std::abs(gap->seconds - wanted);
      };
      while (std::next(gap) != gaps.end() && is_as_near(*std::next(gap))) ++gap;
      out.append(bare.substr(copied, gap->offset - copied));
      copied = gap->offset;
      const std::string_view line = LineAt(file_.text, lines_[i]).Raw(file_.text);
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
